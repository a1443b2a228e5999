// SPDX-License-Identifier: Apache-2.0
#include "output/clock_series.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <utility>

#include "json/printable.hpp"

namespace takt::output {
namespace {

/// In nanoseconds, with its sign.
std::string in_ns(sim::Duration offset) {
  const std::int64_t ps = offset.ps();
  return fmt::format("{}{}.{:03}", ps < 0 ? "-" : "", std::llabs(ps) / 1000, std::llabs(ps) % 1000);
}

}  // namespace

ClockSeries::ClockSeries(const models::Network& network, std::string path, sim::TrueTime from, sim::TrueTime to)
    : network_(&network), file_(std::move(path)), from_(from), to_(to) {
  file_.write("time_s,node,grandmaster,offset_ns,true_offset_ns\n");
}

void ClockSeries::sample(const scenario::ClockSample& sample) {
  if (sample.time < from_ || sample.time > to_) return;
  const std::vector<models::NodePlan>& nodes = network_->plan().nodes;
  const std::int64_t at = sample.time.ps();
  file_.write(fmt::format("{}.{:012},{},{},{},{}\n", at / 1'000'000'000'000, at % 1'000'000'000'000,
                          json::csv_field(nodes[sample.node.value].name),
                          json::csv_field(nodes[sample.grandmaster.value].name), in_ns(sample.offset),
                          in_ns(sample.true_offset)));
}

}  // namespace takt::output
