#include "models/host/host.hpp"

#include <algorithm>

namespace takt::models {
namespace {
constexpr auto deliver_now = static_cast<sim::EventKind>(NodeEvent::first_free);
}

Host::Host(sim::Simulation& simulation, Traffic& traffic, NodeIndex node, const OsLatency& latency, std::string_view path)
    : traffic_(&traffic),
      source_(simulation.add(*this)),
      node_(node),
      receives_at_once_(latency.receive.is_constant()),
      receive_(latency.receive, simulation.seed(), path, "os receive") {}

void Host::listen(StreamIndex stream, Process* process) {
  const auto at = std::lower_bound(listeners_.begin(), listeners_.end(), stream,
                                   [](const Listener& listener, StreamIndex s) { return listener.stream < s; });
  if (at != listeners_.end() && at->stream == stream)
    at->process = process;
  else
    listeners_.insert(at, {stream, process});
}

const Host::Listener* Host::listener_of(StreamIndex stream) const {
  if (listeners_.size() == 1) [[likely]]
    return listeners_[0].stream == stream ? listeners_.data() : nullptr;
  const auto at = std::lower_bound(listeners_.begin(), listeners_.end(), stream,
                                   [](const Listener& listener, StreamIndex s) { return listener.stream < s; });
  return at != listeners_.end() && at->stream == stream ? &*at : nullptr;
}

void Host::handle(sim::Simulation& simulation, const sim::Event& event) {
  const FrameIndex frame = ArrivalArgument::unpack(event.argument).frame;
  if (event.kind() == deliver_now || receives_at_once_) {
    deliver(simulation, frame);
    return;
  }
  simulation.schedule(source_, receive_.pass(simulation.now()), sim::Phase::arrival, id(), deliver_now, event.argument);
}

void Host::prefetch(const sim::Event& event, Ahead ahead) const {
  const StreamIndex stream = traffic_->frame(ArrivalArgument::unpack(event.argument).frame).stream;
  if (ahead == Ahead::two_events)
    traffic_->prefetch_account(stream);
  else
    traffic_->prefetch_latency(stream);
}

void Host::deliver(sim::Simulation& simulation, FrameIndex index) {
  const Frame& frame = traffic_->frame(index);
  const Listener* const listener = listener_of(frame.stream);
  if (listener == nullptr) {
    traffic_->drop(index, DropReason::no_filtering_entry, id(), simulation);
    return;
  }
  traffic_->count_delivery(frame, node_, simulation);
  if (listener->process != nullptr && !frame.payload.is_none())
    listener->process->receive(frame.stream, traffic_->payload(frame.payload).view());
  traffic_->release(index);
}

}  // namespace takt::models
