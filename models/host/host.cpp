// SPDX-License-Identifier: Apache-2.0
#include "models/host/host.hpp"

#include <algorithm>
#include <utility>

#include "sim/insertion_sort.hpp"

namespace takt::models {
namespace {
constexpr auto deliver_now = static_cast<sim::EventKind>(NodeEvent::taken_in);
constexpr std::size_t few_listeners = 4;  // to go through them is faster than to search
}  // namespace

Host::Host(sim::Simulation& simulation, Traffic& traffic, NodeIndex node, const OsLatency& latency,
           std::string_view path, std::span<EgressPort> ports, const LocalClock& clock, bool eliminates_duplicates,
           bool has_stack_thread)
    : traffic_(&traffic),
      receives_at_once_(latency.receive.is_constant() && !eliminates_duplicates && !has_stack_thread),
      has_no_latency_(latency.receive.is_constant() && latency.receive.greatest() == sim::Duration() &&
                      !has_stack_thread),
      eliminates_duplicates_(eliminates_duplicates),
      source_(simulation.add(*this)),
      node_(node),
      receive_(latency.receive, simulation.seed(), path, "os receive"),
      ports_(ports),
      clock_(&clock),
      fixed_receive_(receives_at_once_ ? latency.receive.greatest() : sim::Duration()) {
  if (eliminates_duplicates) reception_checks_.require_always();
}

void Host::listen(StreamIndex stream, Process* process) {
  const auto at = std::lower_bound(listeners_.begin(), listeners_.end(), stream,
                                   [](const Listener& listener, StreamIndex s) { return listener.stream < s; });
  if (at != listeners_.end() && at->stream == stream && at->process == nullptr)
    at->process = process;
  else if (at == listeners_.end() || at->stream != stream || process != nullptr)
    listeners_.insert(at, {stream, process, Traffic::delivery_key(stream, node_)});
}

const Host::Listener* Host::listener_of(StreamIndex stream) const {
  if (listeners_.size() <= few_listeners) [[likely]] {
    for (const Listener& listener : listeners_)
      if (listener.stream == stream) return &listener;
    return nullptr;
  }
  const auto at = std::lower_bound(listeners_.begin(), listeners_.end(), stream,
                                   [](const Listener& listener, StreamIndex s) { return listener.stream < s; });
  return at != listeners_.end() && at->stream == stream ? &*at : nullptr;
}

void Host::handle(sim::Simulation& simulation, const sim::Event& event) {
  const ArrivalArgument arrival = ArrivalArgument::unpack(event.argument);
  if (reception_checks_.is_needed() || (arrival.flags != 0 && is_in_doubt(arrival))) [[unlikely]]
    receive(simulation, event.kind(), arrival);
  else
    accept(simulation, event.kind(), arrival);
}

/// A frame with flags, most of which come as they were sent.
inline bool Host::is_in_doubt(ArrivalArgument arrival) const {
  return !ports_[arrival.port].incoming().is_loss_free() || traffic_->frame(arrival.frame).bad_fcs;
}

inline void Host::accept(sim::Simulation& simulation, sim::EventKind kind, ArrivalArgument arrival) {
  const Frame& frame = traffic_->frame(arrival.frame);
  if (frame.link_local && link_local_ != nullptr) [[unlikely]]
    link_local_->receive(simulation, arrival.frame, arrival.port, simulation.now() - fixed_receive_);
  else if (kind == deliver_now || receives_at_once_)
    deliver(simulation, arrival.frame, frame, listener_of(frame.stream));
  else
    simulation.schedule(source_, through(simulation.now()), sim::Phase::arrival, id(), deliver_now,
                        ArrivalArgument::pack(arrival.frame, arrival.port));
}

void Host::receive(sim::Simulation& simulation, sim::EventKind kind, ArrivalArgument arrival) {
  const auto needs_no_look = [](const Frame& frame) { return !frame.bad_fcs && !frame.link_local; };
  const bool is_sure = eliminates_duplicates_ && kind != deliver_now && arrival.flags == 0 &&
                       !reception_checks_.has_cancelled_arrivals();
  if (is_sure && up_ && !tells_arrivals_ && !arrives_for_recorder_ && needs_no_look(traffic_->frame(arrival.frame)))
      [[likely]]
    gather_last(simulation, {arrival.frame, arrival.port});
  else
    receive_slow(simulation, kind, arrival);
}

void Host::receive_slow(sim::Simulation& simulation, sim::EventKind kind, ArrivalArgument arrival) {
  if (kind != deliver_now) {
    if (arrives_for_recorder_ && !traffic_->frame(arrival.frame).link_local) simulation.uncount_event();
    const std::optional<FrameIndex> frame = check_reception(simulation, arrival);
    if (!frame) return;
    arrival.frame = *frame;
    if (eliminates_duplicates_ && !traffic_->frame(*frame).link_local) {
      gather_last(simulation, {*frame, arrival.port});
      return;
    }
  } else if (!up_) {
    traffic_->drop(arrival.frame, DropReason::node_down, id(), simulation);
    return;
  } else if (cpu_ != nullptr) {
    const std::uint32_t stream = traffic_->frame(arrival.frame).stream.value;
    Traffic::trace_processing(simulation, id(), arrival.frame);
    cpu_->submit(stack_thread_, *this, id().index, stream, ArrivalArgument::pack(arrival.frame, arrival.port),
                 simulation.now());
    return;
  }
  const Frame& frame = traffic_->frame(arrival.frame);
  const Listener* const listener = listener_of(frame.stream);
  if (kind == deliver_now && eliminates_duplicates_ && only_counts(frame, listener))
    simulation.uncount_event();  // it is there for a recorder: see pass_through_system()
  if (keeps_book_ && (kind == deliver_now || receives_at_once_) && listener != nullptr)
    deliver_noted(simulation, arrival.frame, frame, listener);
  else
    accept(simulation, kind, arrival);
}

/// The protocol stack has taken a frame in, or never will.
void Host::job_ended(sim::Simulation& simulation, std::uint64_t job, Ending ending) {
  const FrameIndex frame = ArrivalArgument::unpack(job).frame;
  if (ending != Ending::done) {
    traffic_->drop(frame, ending == Ending::crashed ? DropReason::node_down : DropReason::host_overload, id(),
                   simulation);
    return;
  }
  const Frame& record = traffic_->frame(frame);
  deliver_noted(simulation, frame, record, listener_of(record.stream));
}

/// The same as deliver(), and it is entered in the book where one is kept.
void Host::deliver_noted(sim::Simulation& simulation, FrameIndex index, const Frame& frame, const Listener* listener) {
  if (keeps_book_ && listener != nullptr) traffic_->book().deliver(frame, node_, simulation.now());
  deliver(simulation, index, frame, listener);
}

/// A frame in a condition of its own, or a host that does more than deliver: what goes on, if anything.
std::optional<FrameIndex> Host::check_reception(sim::Simulation& simulation, ArrivalArgument arrival) {
  FrameIndex frame = arrival.frame;
  if ((arrival.is_uncertain() || reception_checks_.has_cancelled_arrivals()) &&
      !ports_[arrival.port].incoming().receive(simulation, frame, arrival.flags))
    return std::nullopt;
  if (tells_arrivals_ && simulation.trace() != nullptr)
    simulation.trace()->record({simulation.now(), static_cast<std::uint32_t>(Occurrence::arrived), id(), frame.value,
                                ArrivalDetail{arrival.port, ports_[arrival.port].incoming().sender()}.pack()});
  if (!up_ || traffic_->frame(frame).bad_fcs) {
    traffic_->drop(frame, up_ ? DropReason::bad_fcs : DropReason::node_down, id(), simulation);
    return std::nullopt;
  }
  return eliminates_duplicates_ ? frame : recover(simulation, frame, arrival.port);
}

std::optional<FrameIndex> Host::recover(sim::Simulation& simulation, FrameIndex frame, std::uint16_t port) {
  if (redundancy_.is_empty()) return frame;
  const std::optional<FrameIndex> passed =
      redundancy_.receive(*traffic_, frame, port, clock_->unstepped_at(simulation.now() - fixed_receive_));
  if (!passed) traffic_->drop(frame, DropReason::duplicate, id(), simulation);
  return passed;
}

void Host::receive_internally(sim::Simulation& simulation, FrameIndex frame, std::uint16_t port) {
  if (!up_)
    traffic_->drop(frame, DropReason::node_down, id(), simulation);
  else
    gather(simulation, {frame, port});
}

inline void Host::gather(sim::Simulation& simulation, const Arrived& arrived) {
  if (arrived_.empty()) simulation.decide_later(id(), sim::Decision::reception);
  arrived_.push_back(arrived);
}

/// The same as the last act of an event handler.
inline void Host::gather_last(sim::Simulation& simulation, const Arrived& arrived) {
  if (!simulation.is_last()) {
    gather(simulation, arrived);
  } else if (const std::optional<FrameIndex> frame = recover(simulation, arrived.frame, arrived.port)) {
    pass_through_system(simulation, {*frame, arrived.port});
  }
}

void Host::decide(sim::Simulation& simulation) {
  const auto comes_before = [](const Arrived& a, const Arrived& b) { return a.port < b.port; };
  if (arrived_.size() > 2) [[unlikely]]
    sim::insertion_sort(arrived_, comes_before);
  else if (comes_before(arrived_.back(), arrived_.front()))  // two copies, as most often
    std::swap(arrived_.front(), arrived_.back());
  for (const Arrived& arrived : arrived_)
    if (const std::optional<FrameIndex> frame = recover(simulation, arrived.frame, arrived.port))
      pass_through_system(simulation, {*frame, arrived.port});
  arrived_.clear();
}

/// Nothing happens when the frame is delivered but that it is counted, so it does not matter when in its instant that
/// is.
inline bool Host::only_counts(const Frame& frame, const Listener* listener) const {
  return has_no_latency_ && !frame.link_local &&
         (listener == nullptr || listener->process == nullptr || frame.payload.is_none());
}

/// Applications act on received frames when the instant is over. A frame that is only counted needs no event, but is
/// traced when it would be with one.
inline void Host::pass_through_system(sim::Simulation& simulation, const Arrived& arrived) {
  const Frame& frame = traffic_->frame(arrived.frame);
  const Listener* const listener = listener_of(frame.stream);
  if (simulation.trace() == nullptr && only_counts(frame, listener))
    deliver_noted(simulation, arrived.frame, frame, listener);
  else
    simulation.schedule(source_, through(simulation.now()), sim::Phase::arrival, id(), deliver_now,
                        ArrivalArgument::pack(arrived.frame, arrived.port));
}

void Host::prefetch(const sim::Event& event, Ahead ahead) const {
  const StreamIndex stream = traffic_->frame(ArrivalArgument::unpack(event.argument).frame).stream;
  if (ahead == Ahead::two_events) {
    traffic_->prefetch_delivery(stream);
    __builtin_prefetch(listeners_.data());
  } else {
    traffic_->prefetch_latency(stream);
  }
}

void Host::deliver(sim::Simulation& simulation, FrameIndex index, const Frame& frame, const Listener* listener) {
  if (listener == nullptr) {
    traffic_->drop(index, DropReason::no_filtering_entry, id(), simulation);
    return;
  }
  traffic_->count_delivery(frame, listener->delivery, simulation);
  if (sim::TraceSink* const trace = simulation.trace()) [[unlikely]]
    trace->record({simulation.now(), static_cast<std::uint32_t>(Occurrence::received), id(), index.value,
                   static_cast<std::uint64_t>(frame.stream.value) << 32 | node_.value});
  if (listener->process != nullptr && !frame.payload.is_none()) {
    const Listener* const end = listeners_.data() + listeners_.size();
    for (const Listener* each = listener; each != end && each->stream == frame.stream; ++each)
      each->process->receive(frame.stream, traffic_->payload(frame.payload).view());
  }
  traffic_->release(index);
}

}  // namespace takt::models
