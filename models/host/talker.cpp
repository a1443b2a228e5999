// SPDX-License-Identifier: Apache-2.0
#include "models/host/talker.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace takt::models {
namespace {

constexpr sim::EventKind transmit_now = 1;

/// offset + period * count; never() if that is beyond all instants.
sim::LocalTime instant(sim::Duration offset, sim::Duration period, std::int64_t count) {
  const sim::int128 ps = offset.ps() + static_cast<sim::int128>(period.ps()) * count;
  return ps >= sim::LocalTime::never().ps() ? sim::LocalTime::never()
                                            : sim::LocalTime::from_ps(static_cast<std::int64_t>(ps));
}

template <class... Cases>
struct Overloaded : Cases... {
  using Cases::operator()...;
};
template <class... Cases>
Overloaded(Cases...) -> Overloaded<Cases...>;  // clang 14 needs the deduction guide

}  // namespace

Talker::Talker(sim::Simulation& simulation, Traffic& traffic, HostOutput& output, const LocalClock& clock,
               const OsLatency& latency, std::string_view path, StreamIndex stream, Octets payload,
               TalkerSchedule schedule)
    : traffic_(&traffic),
      output_(&output),
      source_(simulation.add(*this)),
      stream_(stream),
      payload_(payload),
      has_table_(std::holds_alternative<TraceSchedule>(schedule)),
      clock_(&clock),
      schedule_(std::move(schedule)),
      own_transmit_(latency.transmit, simulation.seed(), path, "os transmit"),
      chance_(simulation.seed(), path, "schedule") {
  transmits_at_once_ = own_transmit_.is_none();
  const auto* const periodic = std::get_if<PeriodicSchedule>(&schedule_);
  if (periodic != nullptr && periodic->jitter == sim::Duration()) fixed_step_ = periodic->period;
}

sim::LocalTime Talker::time_of_next() {
  using sim::Duration;
  using sim::LocalTime;
  const auto count = static_cast<std::int64_t>(count_);
  return std::visit(
      Overloaded{[&](const PeriodicSchedule& s) {
                   LocalTime time = instant(s.offset, s.period, count);
                   if (s.jitter > Duration())
                     time = time.plus_saturated(Duration::from_ps(
                         static_cast<std::int64_t>(chance_.below(static_cast<std::uint64_t>(s.jitter.ps()) + 1))));
                   return time;
                 },
                 [&](const ExponentialSchedule& s) {
                   const LocalTime from = count == 0 ? LocalTime() + s.offset : last_;
                   return from.plus_saturated(sim::Distribution::exponential(s.mean).draw(chance_));
                 },
                 [&](const BurstSchedule& s) {
                   return instant(s.offset, s.period, count / s.frames).plus_saturated(s.spacing * (count % s.frames));
                 },
                 [&](const RandomGapSchedule& s) {
                   const LocalTime from = count == 0 ? LocalTime() + s.offset : last_;
                   return from.plus_saturated(s.gap->draw(chance_));
                 },
                 [&](const TraceSchedule& s) {
                   return count_ < s.entries.size() ? s.entries[count_].time : LocalTime::never();
                 }},
      schedule_);
}

sim::TrueTime Talker::ask_clock() {
  if (fixed_step_ > sim::Duration()) steps_ = clock_->steps_from(last_, fixed_step_);
  return clock_->true_at(last_);
}

/// Which frame it is nobody asks where they come at equal distances.
inline void Talker::go_on(sim::Simulation& simulation) {
  if (!steps_.is_set()) ++count_;
  has_begun_ = true;
  schedule_next(simulation);
}

inline void Talker::schedule_next(sim::Simulation& simulation) {
  const bool follows = steps_.is_set();
  const sim::LocalTime time =
      follows || (has_begun_ && fixed_step_ > sim::Duration()) ? last_.plus_saturated(fixed_step_) : time_of_next();
  is_over_ = time >= until_;
  if (is_over_) return;
  last_ = time;
  schedule_at(simulation, follows ? steps_.next() : ask_clock());
}

void Talker::start(sim::Simulation& simulation) {
  order_ = simulation.order_of(phase_, id(), id());
  // A clock that is ahead at the start shows times that never were: nothing was due then.
  const sim::LocalTime begin = clock_->local_at(simulation.now());
  const auto first = [begin](sim::Duration offset, sim::Duration period) {
    const std::int64_t late = begin.ps() - offset.ps();
    return late <= 0 || period <= sim::Duration() ? std::uint64_t{0}
                                                  : static_cast<std::uint64_t>((late - 1) / period.ps() + 1);
  };
  std::visit(Overloaded{[&](const PeriodicSchedule& s) { count_ = first(s.offset, s.period); },
                        [&](ExponentialSchedule& s) { s.offset = std::max(s.offset, begin - sim::LocalTime()); },
                        [&](RandomGapSchedule& s) { s.offset = std::max(s.offset, begin - sim::LocalTime()); },
                        [&](const BurstSchedule& s) { count_ = first(s.offset, s.period) * s.frames; },
                        [&](const TraceSchedule& s) {
                          while (count_ < s.entries.size() && s.entries[count_].time < begin) ++count_;
                        }},
             schedule_);
  has_begun_ = count_ > 0;
  if (has_begun_ && fixed_step_ > sim::Duration())
    last_ = instant(std::get<PeriodicSchedule>(schedule_).offset, fixed_step_, static_cast<std::int64_t>(count_) - 1);
  schedule_next(simulation);
}

void Talker::clock_changed(sim::Simulation& simulation) {
  if (is_over_) return;
  ++generation_;
  // What a step has passed over wholly was never: two such would produce at one instant.
  is_over_ = clock_->local_at(simulation.now()) >= until_;
  if (!is_over_) schedule_at(simulation, ask_clock());
}

void Talker::prefetch(const sim::Event&, Ahead ahead) const {
  if (ahead == Ahead::one_event) {
    output_->port().prefetch_hot();
    return;
  }
  __builtin_prefetch(&steps_, 1);
  __builtin_prefetch(output_);
  traffic_->prefetch_sending(stream_);
}

/// What belongs to this host alone.
void Talker::mark(Frame& frame) const {
  frame.marked = true;
  frame.eligible = launch_ ? last_ + *launch_ : sim::LocalTime::from_ps(std::numeric_limits<std::int64_t>::min());
  if (host_priority_) frame.queue_priority = *host_priority_;
}

void Talker::send_with_processing(sim::Simulation& simulation, FrameIndex frame, bool is_last) {
  const sim::LocalTime now = clock_->local_at(simulation.now());
  if (host_priority_ && !launch_)
    traffic_->frame(frame).eligible = now;  // where others have launch times it is due at once
  if (is_last)
    output_->offer_last(simulation, frame, source_.id().index, now);
  else
    output_->offer(simulation, frame, source_.id().index, now);
}

inline void Talker::hand_over(sim::Simulation& simulation, FrameIndex frame) {
  if (output_->is_plain()) [[likely]]
    output_->port().offer_last(simulation, frame, traffic_->frame(frame), source_.id().index);
  else
    send_with_processing(simulation, frame, true);
}

/// The protocol stack has sent a frame, or never will.
void Talker::job_ended(sim::Simulation& simulation, std::uint64_t job, Ending ending) {
  const FrameIndex frame{static_cast<std::uint32_t>(job)};
  if (ending == Ending::done)
    send_with_processing(simulation, frame, false);
  else
    traffic_->drop(frame, ending == Ending::crashed ? DropReason::node_down : DropReason::host_overload, source_.id(),
                   simulation);
}

void Talker::handle(sim::Simulation& simulation, const sim::Event& event) {
  if (event.kind() == transmit_now) {
    if (cpu_ != nullptr) [[unlikely]] {
      Traffic::trace_processing(simulation, source_.id(), FrameIndex{static_cast<std::uint32_t>(event.argument)});
      cpu_->submit(stack_thread_, *this, source_.id().index, 0, event.argument, simulation.now());
      return;
    }
    hand_over(simulation, FrameIndex{static_cast<std::uint32_t>(event.argument)});
    return;
  }
  if (event.argument != generation_) return;  // the clock has changed since
  if (!output_->is_up()) [[unlikely]] {       // a host that is down produces nothing; its schedule goes on
    go_on(simulation);
    return;
  }
  const Octets payload = has_table_ ? std::get<TraceSchedule>(schedule_).entries[count_].payload : payload_;
  const FrameIndex frame = traffic_->produce(stream_, payload, simulation);
  if (marks_) mark(traffic_->frame(frame));
  if (sim::TraceSink* const trace = simulation.trace()) [[unlikely]]
    trace->record(
        {simulation.now(), static_cast<std::uint32_t>(Occurrence::produced), source_.id(), frame.value, stream_.value});
  if (!transmits_at_once_)
    simulation.schedule(
        source_, shares_latency_ ? transmit_->pass_strictly(simulation.now()) : transmit_->pass(simulation.now()),
        sim::Phase::arrival, source_.id(), transmit_now, frame.value);
  go_on(simulation);
  if (transmits_at_once_) hand_over(simulation, frame);
}

}  // namespace takt::models
