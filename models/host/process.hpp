// SPDX-License-Identifier: Apache-2.0
// An application on a simulated host: its alarms, its way to the network interface.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "models/clock/local_clock.hpp"
#include "models/host/application.hpp"
#include "models/host/cpu.hpp"
#include "models/host/host_output.hpp"
#include "models/host/os_latency.hpp"
#include "sim/timer.hpp"

namespace takt::models {

class Process final : public sim::Component, public HostServices, public CpuUser {
 public:
  /// `path` names the process in the random streams, e.g. "robot/trajectory". All references outlive the process.
  Process(sim::Simulation& simulation, Traffic& traffic, HostOutput& output, const LocalClock& clock,
          const OsLatency& latency, std::string_view path, std::unique_ptr<Application> application);

  /// What the process does takes time of a processor, which outlives it. `turns`: the thread on which each of its
  /// alarms and messages is a job; `threads`: those of the application's own threads (HostServices::begin_job);
  /// `transmit`: that of the protocol stack for each frame that it sends.
  struct CpuThreads {
    std::optional<std::uint32_t> turns = {};
    std::vector<std::optional<std::uint32_t>> threads = {};
    std::optional<std::uint32_t> transmit = {};
  };
  void run_on(Cpu& cpu, CpuThreads threads);
  /// Its messages are secured, which takes time: of each that is sent before anything else, of each that has come
  /// before the application hears of it. On the thread of its turns sealing is a job of its own, behind those that
  /// wait, and opening a part of the job of the message; without one they pass beside everything else.
  void secure(sim::Duration seal, sim::Duration open);

  /// Whether a frame passes nothing but a latency on its way to the network interface: neither a processor nor a choice
  /// among interfaces.
  bool sends_plainly() const { return cpu_ == nullptr && output_->is_plain(); }
  /// Nobody else hands frames to the host's interface, and they wait for nothing but each other: what is sent goes
  /// there. Precondition: sends_plainly().
  void send_by(SingleTalkerPort& sender) { single_talker_port_ = &sender; }

  /// Starts the application at the present instant.
  void start() { application_->start(*this); }
  Application& application() { return *application_; }

  void receive(StreamIndex stream, std::span<const std::byte> payload) {
    if (threads_.turns) [[unlikely]]
      keep_message(stream, payload);
    else if (open_ > sim::Duration()) [[unlikely]]
      open_message(stream, payload);
    else
      application_->receive(*this, stream, payload);
  }
  /// Runs `action(application, services)` as the script's hand on the program; nobody hears it on a host that is down.
  template <class Action>
  void call(Action&& action) {
    if (output_->is_up()) action(*application_, *this);
  }
  /// The clock has changed its rate or was stepped: alarms come earlier or later.
  void clock_changed();
  /// The host crashes: alarms are forgotten. Its processor has crashed before.
  void crash() {
    ++crashes_;
    for (Alarm& alarm : alarms_) {
      alarm.timer.cancel();
      alarm.has_latency = false;
      alarm.job = 0;
    }
  }
  void restart() { application_->restart(*this); }

  void handle(sim::Simulation& simulation, const sim::Event& event) override;
  void job_ended(sim::Simulation& simulation, std::uint64_t job, Ending ending) override;

  sim::LocalTime now() const override { return clock_->local_at(simulation_->now()); }
  void set_alarm(AlarmId alarm, sim::LocalTime time) override;
  void set_exact_alarm(AlarmId alarm, sim::LocalTime time) override;
  void cancel_alarm(AlarmId alarm) override {
    alarms_[alarm].timer.cancel();
    alarms_[alarm].job = 0;
  }
  bool begin_job(std::uint32_t thread, AlarmId alarm) override;
  void work(AlarmId alarm, sim::Duration duration) override;
  void send(StreamIndex stream, std::span<const std::byte> payload) override;

  sim::ComponentId id() const { return source_.id(); }

  /// Two applications of one host that act on each other: alarms of both that are due at one instant expire in the
  /// order of their times.
  static void join(Process& a, Process& b) {
    a.partner_ = &b;
    b.partner_ = &a;
  }

 private:
  std::size_t due_alarms() const;
  void expire(AlarmId alarm);
  std::uint32_t stored(StreamIndex stream, std::span<const std::byte> payload);
  void open_message(StreamIndex stream, std::span<const std::byte> payload);
  void keep_message(StreamIndex stream, std::span<const std::byte> payload);
  void read_message(std::uint32_t slot, Ending ending);
  std::uint64_t job_of(AlarmId alarm);
  void expire_in_order();
  void hand_over(FrameIndex frame, bool last);
  void lose(FrameIndex frame, Ending ending);

  sim::Simulation* simulation_;
  Traffic* traffic_;
  HostOutput* output_;
  const LocalClock* clock_;
  sim::EventSource source_;
  LatencyLine transmit_;
  LatencyLine wake_up_;
  sim::Duration seal_;
  sim::Duration open_;
  SingleTalkerPort* single_talker_port_ = nullptr;  // see send_by()
  std::uint32_t crashes_ = 0;                       // what was being opened is lost
  bool transmits_at_once_;
  bool wakes_at_once_;
  struct Alarm {
    explicit Alarm(sim::Timer t) : timer(t) {}
    sim::Timer timer;
    sim::Duration latency;  // of its next wake-up; drawn once, however often the alarm is moved before
    bool has_latency = false;
    sim::LocalTime time = sim::LocalTime::never();  // when it is to expire
    bool is_exact = false;                          // wakes at once, whatever runs on the processor
    std::uint32_t job = 0;                          // on the processor, that wakes the application at its end; 0: none
  };
  struct Message {
    StreamIndex stream;
    std::vector<std::byte> octets;
  };
  std::vector<Alarm> alarms_;
  Process* partner_ = nullptr;
  struct Due {
    sim::LocalTime time;
    Process* process;
    AlarmId alarm;
  };
  std::vector<Due> due_;  // of one instant; kept for its room
  std::unique_ptr<Application> application_;
  Cpu* cpu_ = nullptr;
  CpuThreads threads_;
  std::uint32_t jobs_ = 0;         // of alarms
  std::vector<Message> messages_;  // that are opened or wait for the processor, by slot
  std::vector<std::uint32_t> free_messages_;
};

}  // namespace takt::models
