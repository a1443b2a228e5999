// SPDX-License-Identifier: Apache-2.0
#include "output/hop_series.hpp"

#include <fmt/format.h>

#include <array>

#include "json/printable.hpp"

namespace takt::output {
namespace {
constexpr auto causes = static_cast<std::size_t>(explain::Cause::count);
}

HopSeries::HopSeries(const models::Network& network, const Selection& selection, std::string path)
    : selection_(&selection), file_(std::move(path)) {
  for (const models::Stream& stream : network.traffic().streams()) streams_.push_back(json::csv_field(stream.name));
  for (const models::NodePlan& node : network.plan().nodes) nodes_.push_back(json::csv_field(node.name));
  std::string head = "stream,sequence,node,port,to,class,produced_ps,came_ps,started_ps,octets,cuts";
  for (std::size_t cause = 0; cause < causes; ++cause)
    head += fmt::format(",{}_ps", explain::name_of(static_cast<explain::Cause>(cause)));
  file_.write(head + "\n");
}

void HopSeries::row(const explain::Way& way, const std::string& place, const std::string& times,
                    const std::vector<explain::Part>& parts) {
  std::array<sim::Duration, causes> sums{};
  for (const explain::Part& part : parts) sums[static_cast<std::size_t>(part.cause)] += part.length;
  std::string line = fmt::format("{},{},{},{},{}", streams_[way.frame.stream.value], way.frame.sequence, place,
                                 way.produced.ps(), times);
  for (const sim::Duration sum : sums) line += fmt::format(",{}", sum.ps());
  file_.write(line + "\n");
}

void HopSeries::ended(const explain::Way& way) {
  if (!selection_->has(way)) return;
  if (!way.before.empty() && (way.hops.empty() || !way.hops.front().is_reported))
    row(way, nodes_[way.talker.value] + ",,,", fmt::format("{},,,0", way.produced.ps()), way.before);
  for (const explain::Hop& hop : way.hops) {
    if (hop.is_reported) continue;
    const std::string to = hop.peer.is_none() ? std::string() : nodes_[hop.peer.value];
    const bool has_started = hop.started != sim::TrueTime::never();
    row(way, fmt::format("{},{},{},{}", nodes_[hop.port.node.value], hop.port.port, to, hop.traffic_class),
        has_started ? fmt::format("{},{},{},{}", hop.came.ps(), hop.started.ps(), hop.octets, hop.cuts)
                    : fmt::format("{},,,0", hop.came.ps()),
        hop.parts);
  }
}

}  // namespace takt::output
