// SPDX-License-Identifier: Apache-2.0
#include "models/host/process.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

namespace takt::models {
namespace {
// Kinds 0 .. n-1 are the alarms; this one hands a frame to the network interface.
constexpr sim::EventKind transmit_now = 0xFFFF;
constexpr sim::EventKind opened_now = 0xFFFE;

/// What a job of a processor is: in its number above the low 32 bits.
enum class JobKind : std::uint16_t { alarm, message, frame, sealing };
constexpr std::uint32_t rank_of_sealing = 1U << 31;  // behind alarms and messages of the instant
std::uint64_t job_number(JobKind kind, std::uint16_t which, std::uint32_t detail) {
  return static_cast<std::uint64_t>(kind) << 48 | static_cast<std::uint64_t>(which) << 32 | detail;
}
}  // namespace

Process::Process(sim::Simulation& simulation, Traffic& traffic, HostOutput& output, const LocalClock& clock,
                 const OsLatency& latency, std::string_view path, std::unique_ptr<Application> application)
    : simulation_(&simulation),
      traffic_(&traffic),
      output_(&output),
      clock_(&clock),
      source_(simulation.add(*this)),
      transmit_(latency.transmit, simulation.seed(), path, "os transmit"),
      wake_up_(latency.wake_up, simulation.seed(), path, "os wake-up"),
      transmits_at_once_(transmit_.is_none()),
      wakes_at_once_(wake_up_.is_none()),
      application_(std::move(application)) {
  const AlarmId count = application_->alarm_count();
  TAKT_CHECK(count < opened_now, "too many alarms");
  for (AlarmId alarm = 0; alarm < count; ++alarm)
    alarms_.emplace_back(sim::Timer(source_.id(), sim::Phase::timer, alarm));
}

void Process::handle(sim::Simulation& simulation, const sim::Event& event) {
  if (event.kind() == transmit_now) {
    if (single_talker_port_ != nullptr) simulation.uncount_event();  // there for the recorder only
    const auto frame = static_cast<std::uint32_t>(event.argument);
    if (threads_.transmit) {
      Traffic::trace_processing(simulation, id(), FrameIndex{frame});
      cpu_->submit(*threads_.transmit, *this, source_.id().index, traffic_->frame(FrameIndex{frame}).stream.value,
                   job_number(JobKind::frame, 0, frame), simulation.now());
    } else {
      hand_over(FrameIndex{frame}, true);
    }
    return;
  }
  if (event.kind() == opened_now)
    return read_message(static_cast<std::uint32_t>(event.argument),
                        event.argument >> 32 != crashes_ ? Ending::crashed : Ending::done);
  TAKT_CHECK(event.kind() < alarms_.size(), "an alarm that was never set");
  Alarm& alarm = alarms_[event.kind()];
  if (!alarm.timer.is_due(simulation, source_, event)) return;
  const bool is_alone = due_alarms() == 1 && (partner_ == nullptr || partner_->due_alarms() == 0);
  is_alone ? expire(event.kind()) : expire_in_order();
}

std::size_t Process::due_alarms() const {
  const sim::TrueTime now = simulation_->now();
  return static_cast<std::size_t>(
      std::count_if(alarms_.begin(), alarms_.end(), [&](const Alarm& alarm) { return alarm.timer.deadline() <= now; }));
}

void Process::expire(AlarmId id) {
  Alarm& alarm = alarms_[id];
  alarm.timer.cancel();
  alarm.has_latency = false;
  if (threads_.turns && !alarm.is_exact)
    cpu_->submit(*threads_.turns, *this, source_.id().index, id, job_of(id), simulation_->now());
  else
    application_->wake(*this, id);
}

void Process::run_on(Cpu& cpu, CpuThreads threads) {
  cpu_ = &cpu;
  threads_ = std::move(threads);
  if (threads_.transmit) transmits_at_once_ = false;
}

/// The alarm's job from now on; one that it had before wakes nobody.
std::uint64_t Process::job_of(AlarmId id) {
  if (++jobs_ == 0) ++jobs_;
  alarms_[id].job = jobs_;
  return job_number(JobKind::alarm, id, jobs_);
}

bool Process::begin_job(std::uint32_t thread, AlarmId id) {
  if (thread >= threads_.threads.size() || !threads_.threads[thread]) return false;
  cpu_->submit(*threads_.threads[thread], *this, source_.id().index, id, job_of(id), simulation_->now());
  return true;
}

void Process::job_ended(sim::Simulation& simulation, std::uint64_t job, Ending ending) {
  const auto detail = static_cast<std::uint32_t>(job);
  switch (static_cast<JobKind>(job >> 48)) {
    case JobKind::alarm: {
      const auto id = static_cast<AlarmId>(job >> 32);
      if (alarms_[id].job != detail) return;  // it was set anew, or cancelled
      alarms_[id].job = 0;
      if (ending != Ending::crashed)
        application_->wake(*this, id);  // a turn that is refused takes place late, not never
      return;
    }
    case JobKind::message:
      read_message(detail, ending);
      return;
    case JobKind::frame:
      ending == Ending::done ? hand_over(FrameIndex{detail}, false) : lose(FrameIndex{detail}, ending);
      return;
    case JobKind::sealing:
      if (ending != Ending::done) return lose(FrameIndex{detail}, ending);
      simulation.schedule(source_, transmit_.pass(simulation.now()), sim::Phase::arrival, id(), transmit_now, detail);
      return;
  }
}

void Process::lose(FrameIndex frame, Ending ending) {
  traffic_->drop(frame, ending == Ending::crashed ? DropReason::node_down : DropReason::host_overload, source_.id(),
                 *simulation_);
}

void Process::secure(sim::Duration seal, sim::Duration open) {
  seal_ = seal;
  open_ = open;
  if (seal > sim::Duration()) transmits_at_once_ = false;
}

std::uint32_t Process::stored(StreamIndex stream, std::span<const std::byte> payload) {
  if (free_messages_.empty()) {
    free_messages_.push_back(static_cast<std::uint32_t>(messages_.size()));
    messages_.emplace_back();
  }
  const std::uint32_t slot = free_messages_.back();
  free_messages_.pop_back();
  messages_[slot].stream = stream;
  messages_[slot].octets.assign(payload.begin(), payload.end());
  return slot;
}

void Process::open_message(StreamIndex stream, std::span<const std::byte> payload) {
  const std::uint32_t slot = stored(stream, payload);
  simulation_->schedule(source_, simulation_->now().plus_saturated(open_), sim::Phase::arrival, id(), opened_now,
                        std::uint64_t{crashes_} << 32 | slot);
}

void Process::keep_message(StreamIndex stream, std::span<const std::byte> payload) {
  const std::uint32_t slot = stored(stream, payload);
  cpu_->submit(*threads_.turns, *this, source_.id().index, static_cast<std::uint32_t>(alarms_.size()) + stream.value,
               job_number(JobKind::message, 0, slot), simulation_->now(), {}, open_);
}

void Process::read_message(std::uint32_t slot, Ending ending) {
  const Message message = std::exchange(messages_[slot], {});
  free_messages_.push_back(slot);
  if (ending == Ending::done) application_->receive(*this, message.stream, message.octets);
}

/// A step of the clock makes many alarms due at once, and what one of them does may depend on the others: they expire
/// as they would have without the step, not in the order of their events. One that is set to this instant meanwhile
/// waits for its own event.
void Process::expire_in_order() {
  const sim::TrueTime now = simulation_->now();
  due_.clear();
  for (Process* const process : {this, partner_}) {
    if (process == nullptr) continue;
    for (AlarmId alarm = 0; alarm < process->alarms_.size(); ++alarm)
      if (process->alarms_[alarm].timer.deadline() <= now)
        due_.push_back({process->alarms_[alarm].time, process, alarm});
  }
  std::sort(due_.begin(), due_.end(), [](const Due& a, const Due& b) {
    return std::tuple(a.time, a.process->id().index, a.alarm) < std::tuple(b.time, b.process->id().index, b.alarm);
  });
  for (const Due& each : due_)
    if (each.process->alarms_[each.alarm].timer.deadline() <= now) each.process->expire(each.alarm);
}

void Process::hand_over(FrameIndex frame, bool last) {
  if (!output_->is_plain()) [[unlikely]]
    output_->offer(*simulation_, frame, id().index, now());
  else if (last)
    output_->port().offer_last(*simulation_, frame, traffic_->frame(frame), id().index);
  else
    output_->port().offer(*simulation_, frame, id().index);
}

void Process::set_alarm(AlarmId id, sim::LocalTime time) {
  Alarm& alarm = alarms_[id];
  if (alarm.job != 0 && alarm.time == time) return;  // it has expired and waits for the processor
  alarm.job = 0;
  alarm.is_exact = false;
  if (!wakes_at_once_ && !alarm.has_latency) {
    alarm.latency = wake_up_.sample();
    alarm.has_latency = true;
  }
  alarm.time = time;
  alarm.timer.arm(*simulation_, source_,
                  std::max(clock_->true_at(time), simulation_->now()).plus_saturated(alarm.latency));
}

void Process::set_exact_alarm(AlarmId id, sim::LocalTime time) {
  Alarm& alarm = alarms_[id];
  alarm.job = 0;
  alarm.is_exact = true;
  alarm.latency = {};
  alarm.has_latency = true;
  alarm.time = time;
  alarm.timer.arm(*simulation_, source_, std::max(clock_->true_at(time), simulation_->now()));
}

void Process::work(AlarmId id, sim::Duration duration) {
  if (threads_.turns) {
    cpu_->submit(*threads_.turns, *this, source_.id().index, id, job_of(id), simulation_->now(), duration);
    return;
  }
  Alarm& alarm = alarms_[id];
  alarm.time = sim::LocalTime();  // no clock moves it
  alarm.timer.arm(*simulation_, source_, simulation_->now().plus_saturated(duration));
}

void Process::clock_changed() {
  const sim::TrueTime now = simulation_->now();
  for (Alarm& alarm : alarms_) {
    // One that has expired and waits for the operating system only is past the clock. One that a step has passed
    // expires now.
    const bool has_expired = alarm.timer.deadline() <= now.plus_saturated(alarm.latency);
    if (!alarm.timer.armed() || alarm.time == sim::LocalTime() || has_expired) continue;
    alarm.timer.arm(*simulation_, source_, std::max(clock_->true_at(alarm.time), now).plus_saturated(alarm.latency));
  }
}

void Process::send(StreamIndex stream, std::span<const std::byte> payload) {
  const FrameIndex frame = traffic_->produce(stream, payload, *simulation_);
  if (single_talker_port_ != nullptr && single_talker_port_->accepts(*simulation_)) [[likely]] {
    const sim::TrueTime now = simulation_->now();
    single_talker_port_->send(*simulation_, frame, traffic_->frame(frame),
                              transmits_at_once_ ? now : transmit_.pass(now.plus_saturated(seal_)));
    return;
  }
  if (sim::TraceSink* const trace = simulation_->trace()) [[unlikely]]
    trace->record(
        {simulation_->now(), static_cast<std::uint32_t>(Occurrence::produced), id(), frame.value, stream.value});
  if (transmits_at_once_) {
    hand_over(frame, false);
    return;
  }
  if (threads_.turns && seal_ > sim::Duration()) {
    cpu_->submit(*threads_.turns, *this, source_.id().index, rank_of_sealing | stream.value,
                 job_number(JobKind::sealing, 0, frame.value), simulation_->now(), seal_);
    return;
  }
  simulation_->schedule(source_, transmit_.pass(simulation_->now().plus_saturated(seal_)), sim::Phase::arrival, id(),
                        transmit_now, frame.value);
}

}  // namespace takt::models
