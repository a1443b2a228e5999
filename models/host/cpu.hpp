// SPDX-License-Identifier: Apache-2.0
// The cores of a host and the threads that share them: preemptive scheduling by deadlines, fixed priorities and fair
// shares.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string_view>
#include <vector>

#include "models/ethernet/frame.hpp"
#include "models/host/cpu_plan.hpp"
#include "sim/random.hpp"
#include "sim/timer.hpp"

namespace takt::models {

/// Whose jobs run on a processor. A job's effect comes at its end, all at once.
class CpuUser {
 public:
  virtual ~CpuUser() = default;
  enum class Ending : std::uint8_t { done, refused, crashed };  ///< refused: too many waited
  virtual void job_ended(sim::Simulation& simulation, std::uint64_t job, Ending ending) = 0;
};

/// Who counts.
class CpuObserver {
 public:
  virtual ~CpuObserver() = default;
  /// Of a job that was released at that instant: its response time, and whether that was within the thread's deadline.
  virtual void job_done(std::uint32_t thread, sim::TrueTime released, sim::Duration response, bool in_time) = 0;
  virtual void job_refused(std::uint32_t thread, sim::TrueTime released) = 0;
  /// A core has spent that time on the thread, up to now.
  virtual void ran(std::uint32_t thread, sim::Duration time) = 0;
};

/// All that is released at an instant is seen before anything is decided, so the order of what happens in it does not
/// count.
class Cpu final : public sim::Component {
 public:
  /// `path` names the host in the random streams. `plan` outlives the processor.
  Cpu(sim::Simulation& simulation, const CpuPlan& plan, NodeIndex node, std::string_view path);

  /// A job for the thread. `job` is what the user gets back; `user_id` and `rank` put the jobs of an instant in order.
  /// Released at `released` (not after now), from when its response time counts. It lasts `work`, or what the thread's
  /// execution time is drawn to be, and `besides` more.
  void submit(std::uint32_t thread, CpuUser& user, std::uint32_t user_id, std::uint32_t rank, std::uint64_t job,
              sim::TrueTime released, std::optional<sim::Duration> work = {}, sim::Duration besides = {});
  /// All jobs end.
  void crash();
  void set_observer(CpuObserver* observer) { observer_ = observer; }

  sim::ComponentId id() const { return source_.id(); }
  const CpuPlan& plan() const { return *plan_; }
  sim::TrueTime now() const { return simulation_->now(); }

  void handle(sim::Simulation& simulation, const sim::Event& event) override;
  void decide(sim::Simulation& simulation) override;

 private:
  struct Job {
    CpuUser* user = nullptr;
    std::uint64_t number = 0;
    sim::TrueTime released;
    std::optional<sim::Duration> work;
    sim::Duration besides;
  };
  struct Arrived {
    std::uint32_t thread = 0;
    std::uint32_t user_id = 0;
    std::uint32_t rank = 0;
    Job job;
  };
  struct Thread {
    const CpuThreadPlan* plan = nullptr;
    sim::RandomStream chance;
    std::deque<Job> jobs = {};     // the first is being worked at
    sim::Duration remaining = {};  // of the first
    bool is_begun = false;         // the first has been worked at
    sim::TrueTime ready_since = {};
    sim::Duration slice_used = {};           // without switching
    std::uint64_t virtual_time = 0;          // of fair: what it worked, over its weight
    std::optional<std::uint16_t> core = {};  // on which it runs
    std::optional<std::uint16_t> last_core = {};
  };
  struct Core {
    explicit Core(sim::Timer t) : timer(t) {}
    std::optional<std::uint32_t> thread = {};  // that runs
    std::optional<std::uint32_t> last = {};    // that was on it last, for some time
    sim::Duration switching;                   // that is left
    sim::TrueTime since;
    sim::Timer timer;  // end of the job, or of a slice
  };
  void decide_later();
  void charge(Core& core);
  void keep_fair_time();
  void accept_pending();
  void begin(Thread& thread);
  void end_jobs();
  void end_job(std::uint32_t thread);
  bool is_held(const Thread& thread) const;
  bool is_more_urgent(std::uint32_t a, std::uint32_t b) const;
  void choose();
  std::optional<std::uint16_t> core_for(const Thread& thread) const;
  void dispatch(std::uint16_t core, std::optional<std::uint32_t> thread);
  void arm();

  sim::Simulation* simulation_;
  const CpuPlan* plan_;
  NodeIndex node_;
  sim::EventSource source_;
  std::vector<Thread> threads_;
  std::vector<Core> cores_;
  std::vector<Arrived> arrived_;  // at this instant
  std::vector<Arrived> taken_in_;
  std::uint64_t fair_time_ = 0;       // the least virtual time of fair threads with jobs; never goes back
  std::vector<std::uint32_t> ready_;  // the most urgent first
  std::vector<std::optional<std::uint32_t>> placed_;  // by core
  CpuObserver* observer_ = nullptr;
  bool asked_ = false;
  bool is_deciding_ = false;
};

}  // namespace takt::models
