// SPDX-License-Identifier: Apache-2.0
#include "output/frame_series.hpp"

#include <fmt/format.h>

#include <utility>

#include "json/printable.hpp"

namespace takt::output {

FrameSeries::FrameSeries(const models::Network& network, std::string path)
    : FrameEvents(network), file_(std::move(path)) {
  for (const models::Stream& stream : network.traffic().streams()) streams_.push_back(json::csv_field(stream.name));
  for (const auto& node : network.plan().nodes) nodes_.push_back(json::csv_field(node.name));
  file_.write("stream,sequence,event,node,port,produced_ps,at_ps,latency_ps,reason\n");
}

void FrameSeries::take(const FrameEvent& event) {
  const std::string node =
      event.node == FrameEvent::none ? std::string() : nodes_[static_cast<std::size_t>(event.node)];
  const std::string port = event.port == FrameEvent::none ? std::string() : std::to_string(event.port);
  std::string end = ",,";
  if (event.end == FrameEnd::delivered) end = fmt::format("{},{},", event.at.ps(), (event.at - event.produced).ps());
  if (event.end == FrameEnd::dropped) end = fmt::format("{},,{}", event.at.ps(), models::name_of(event.reason));
  file_.write(fmt::format("{},{},{},{},{},{},{}\n", streams_[event.stream], event.sequence, name_of(event.end), node,
                          port, event.produced.ps(), end));
}

std::string FrameSeries::close() {
  emit_rest();
  return file_.close();
}

}  // namespace takt::output
