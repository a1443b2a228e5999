// SPDX-License-Identifier: Apache-2.0
#include "output/frame_events.hpp"

#include <algorithm>
#include <tuple>

namespace takt::output {

using models::Occurrence;

std::string_view name_of(FrameEnd end) {
  switch (end) {
    case FrameEnd::delivered:
      return "delivered";
    case FrameEnd::dropped:
      return "dropped";
    case FrameEnd::under_way:
      break;
  }
  return "under way";
}

FrameEvents::FrameEvents(const models::Network& network) : network_(&network), view_(network), directory_(network) {
  const auto know = [&](sim::ComponentId component, std::uint32_t node) {
    if (node_of_component_.size() <= component.index)
      node_of_component_.resize(component.index + std::size_t{1}, FrameEvent::none);
    node_of_component_[component.index] = static_cast<std::int32_t>(node);
  };
  for (std::uint32_t n = 0; n < network.plan().nodes.size(); ++n) {
    if (const models::Host* const host = network.host({n})) know(host->id(), n);
    if (network.plan().nodes[n].forwards()) know(network.bridge({n}).id(), n);
  }
}

void FrameEvents::place(sim::ComponentId component, FrameEvent& event) const {
  if (const std::uint32_t port = directory_.find(component); port != PortDirectory::none) {
    const PortId id = directory_.ports()[port].id;
    event.node = static_cast<std::int32_t>(id.node.value);
    event.port = id.port;
  } else if (component.index < node_of_component_.size()) {
    event.node = node_of_component_[component.index];
  }
}

void FrameEvents::record(const sim::TraceRecord& record) {
  const auto occurrence = static_cast<Occurrence>(record.kind);
  if (occurrence != Occurrence::received && occurrence != Occurrence::drop) return;
  const models::Frame& frame = view_.frame({static_cast<std::uint32_t>(record.what)});
  if (frame.link_local) return;
  FrameEvent event;
  event.stream = frame.stream.value;
  event.sequence = frame.sequence;
  event.produced = frame.produced;
  event.at = record.time;
  if (occurrence == Occurrence::received) {
    event.node = static_cast<std::int32_t>(record.detail);
  } else {
    event.end = FrameEnd::dropped;
    event.reason = static_cast<models::DropReason>(record.detail);
    place(record.where, event);
  }
  take(event);
}

void FrameEvents::emit_rest() {
  std::vector<models::Frame> left;
  network_->traffic().for_each_live([&](const models::Frame& frame) {
    if (!frame.link_local) left.push_back(frame);
  });
  // Where their records lie is nobody's business.
  std::ranges::sort(left, {}, [](const models::Frame& frame) {
    return std::tuple(frame.produced, frame.stream, frame.sequence, frame.references);
  });
  for (const models::Frame& frame : left) {
    FrameEvent event;
    event.stream = frame.stream.value;
    event.sequence = frame.sequence;
    event.end = FrameEnd::under_way;
    event.produced = frame.produced;
    for (std::uint32_t copy = 0; copy < frame.references; ++copy) take(event);
  }
}

}  // namespace takt::output
