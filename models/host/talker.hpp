// SPDX-License-Identifier: Apache-2.0
// A source of frames without protocol: periodic, random, in bursts or from a table of times.
#pragma once

#include <algorithm>
#include <optional>

#include "models/clock/local_clock.hpp"
#include "models/host/cpu.hpp"
#include "models/host/host_output.hpp"
#include "models/host/os_latency.hpp"
#include "models/host/talker_schedule.hpp"

namespace takt::models {

class alignas(64) Talker final : public sim::Component, public CpuUser {
 public:
  /// Times are those of `clock`. `path` names the talker in the random streams. All references outlive the talker.
  Talker(sim::Simulation& simulation, Traffic& traffic, HostOutput& output, const LocalClock& clock,
         const OsLatency& latency, std::string_view path, StreamIndex stream, Octets payload, TalkerSchedule schedule);

  /// Each frame bears the launch time at which it was due, plus this (IEEE 802.1Q 8.6.8.5 does it for ATS, the ETF
  /// queueing discipline for hosts): the network interface keeps it until then, and drops it if it comes later.
  void set_launch(sim::Duration after_due) {
    launch_ = after_due;
    marks_ = true;
  }
  /// The host's own interfaces queue its frames by this priority, which they do not bear.
  void set_host_priority(Priority priority) {
    host_priority_ = priority;
    marks_ = true;
  }
  /// A second talker of its stream, which speaks first where both do at one instant; it is made before the other one.
  void set_babbling() { phase_ = sim::Phase::arrival; }
  /// Its frames take the way through the operating system that those of `other` take, so that they do not overtake each
  /// other.
  void share_latency(Talker& other) {
    transmit_ = other.transmit_;
    shares_latency_ = other.shares_latency_ = true;
  }
  /// The thread of the host's processor on which each frame that is sent is a job of the protocol stack.
  void send_on(Cpu& cpu, std::uint32_t thread) {
    cpu_ = &cpu;
    stack_thread_ = thread;
    transmits_at_once_ = false;
  }
  /// Only frames that are due before then are produced.
  void set_until(sim::LocalTime until) { until_ = until; }
  StreamIndex stream() const { return stream_; }
  sim::ComponentId id() const { return source_.id(); }

  /// Schedules the first frame.
  void start(sim::Simulation& simulation);
  void handle(sim::Simulation& simulation, const sim::Event& event) override;
  /// The clock has changed its rate or was stepped: the next frame comes earlier or later.
  void clock_changed(sim::Simulation& simulation);
  void prefetch(const sim::Event& event, Ahead ahead) const override;
  void job_ended(sim::Simulation& simulation, std::uint64_t job, Ending ending) override;

 private:
  static constexpr sim::EventKind produce_now = 0;
  /// One more frame has been due.
  void go_on(sim::Simulation& simulation);
  void schedule_next(sim::Simulation& simulation);
  void schedule_at(sim::Simulation& simulation, sim::TrueTime due) {
    simulation.schedule(source_, std::max(due, simulation.now()), order_, produce_now, generation_);
  }
  /// Where the clock does not run as it did when the frame before was due, if there was one.
  [[gnu::noinline]] sim::TrueTime ask_clock();
  void hand_over(sim::Simulation& simulation, FrameIndex frame);
  [[gnu::noinline]] void mark(Frame& frame) const;
  [[gnu::noinline]] void send_with_processing(sim::Simulation& simulation, FrameIndex frame, bool is_last);
  /// The local time of frame number `count_`, or never.
  sim::LocalTime time_of_next();

  // What a frame touches that comes at an equal distance: two cache lines.
  Traffic* traffic_;
  HostOutput* output_;
  [[no_unique_address]] sim::EventSource source_;
  StreamIndex stream_;
  std::uint64_t generation_ = 0;  // of the event that produces the next frame
  std::uint64_t order_ = 0;       // of such events (sim::Event)
  Octets payload_;
  sim::Phase phase_ = sim::Phase::timer;
  bool transmits_at_once_;
  bool is_over_ : 1 = false;    // there is no next frame
  bool marks_ : 1 = false;      // launch_ or host_priority_
  bool has_begun_ : 1 = false;  // last_ is the time of a frame
  bool has_table_ : 1;          // TraceSchedule
  bool shares_latency_ : 1 = false;
  EqualSteps steps_;          // of the clock, from the frame that is next on; set while fixed_step_ is
  sim::Duration fixed_step_;  // from one frame to the next; 0 if they do not come at equal distances
  sim::LocalTime last_;
  sim::LocalTime until_ = sim::LocalTime::never();
  // The rest.
  const LocalClock* clock_;
  std::uint64_t count_ = 0;  // of frames that were due; not kept while steps_ is set
  std::optional<sim::Duration> launch_;
  std::optional<Priority> host_priority_;
  TalkerSchedule schedule_;
  LatencyLine own_transmit_;
  LatencyLine* transmit_ = &own_transmit_;
  sim::RandomStream chance_;
  Cpu* cpu_ = nullptr;  // null: what is sent takes no time of a processor
  std::uint32_t stack_thread_ = 0;
};

}  // namespace takt::models
