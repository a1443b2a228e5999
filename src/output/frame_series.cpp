#include "output/frame_series.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>
#include <utility>

#include "output/csv_field.hpp"

namespace takt::output {

using models::Occurrence;

FrameSeries::FrameSeries(const models::Network& network, std::string path) : network_(&network), directory_(network), file_(std::move(path)) {
  for (const models::Stream& stream : network.traffic().streams()) streams_.push_back(csv_field(stream.name));
  const auto know = [&](sim::ComponentId component, std::uint32_t node) {
    if (node_of_component_.size() <= component.index) node_of_component_.resize(component.index + std::size_t{1}, PortDirectory::none);
    node_of_component_[component.index] = node;
  };
  for (std::uint32_t n = 0; n < network.plan().nodes.size(); ++n) {
    nodes_.push_back(csv_field(network.plan().nodes[n].name));
    if (const models::Host* const host = network.host({n})) know(host->id(), n);
    if (network.plan().nodes[n].forwards()) know(network.bridge({n}).id(), n);
  }
  file_.write("stream,sequence,event,node,port,produced_ps,at_ps,latency_ps,reason\n");
}

FrameSeries::Place FrameSeries::place_of(sim::ComponentId component) const {
  if (const std::uint32_t port = directory_.find(component); port != PortDirectory::none) {
    const PortId id = directory_.ports()[port].id;
    return {nodes_[id.node.value], std::to_string(id.port)};
  }
  const std::uint32_t node = component.index < node_of_component_.size() ? node_of_component_[component.index] : PortDirectory::none;
  return {node == PortDirectory::none ? std::string() : nodes_[node], {}};
}

void FrameSeries::row(const models::Frame& frame, std::string_view event, const Place& place, std::string_view end) {
  file_.write(fmt::format("{},{},{},{},{},{},{}\n", streams_[frame.stream.value], frame.sequence, event, place.node, place.port, frame.produced.ps(), end));
}

void FrameSeries::record(const sim::TraceRecord& record) {
  const auto occurrence = static_cast<Occurrence>(record.kind);
  if (occurrence != Occurrence::received && occurrence != Occurrence::drop) return;
  const models::Frame& frame = network_->traffic().frame({static_cast<std::uint32_t>(record.what)});
  if (frame.link_local) return;
  if (occurrence == Occurrence::received)
    row(frame, "delivered", {nodes_[static_cast<std::uint32_t>(record.detail)], {}}, fmt::format("{},{},", record.time.ps(), (record.time - frame.produced).ps()));
  else
    row(frame, "dropped", place_of(record.where), fmt::format("{},,{}", record.time.ps(), models::name_of(static_cast<models::DropReason>(record.detail))));
}

std::string FrameSeries::close() {
  std::vector<models::Frame> left;
  network_->traffic().for_each_live([&](const models::Frame& frame) {
    if (!frame.link_local) left.push_back(frame);
  });
  // Where their records lie is nobody's business.
  std::ranges::sort(left, {}, [](const models::Frame& frame) { return std::tuple(frame.produced, frame.stream, frame.sequence, frame.references); });
  for (const models::Frame& frame : left)
    for (std::uint32_t copy = 0; copy < frame.references; ++copy) row(frame, "under way", {}, ",,");
  return file_.close();
}

}  // namespace takt::output
