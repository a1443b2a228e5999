#include "output/clock_series.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <utility>

#include "output/csv_field.hpp"

namespace takt::output {
ClockSeries::ClockSeries(const models::Network& network, std::string path) : network_(&network), file_(std::move(path)) {
  file_.write("time_s,node,grandmaster,offset_ns\n");
}

void ClockSeries::sample(sim::TrueTime time, models::NodeIndex node, models::NodeIndex grandmaster, sim::Duration offset) {
  const std::vector<models::NodePlan>& nodes = network_->plan().nodes;
  const std::int64_t ps = offset.ps();
  file_.write(fmt::format("{}.{:012},{},{},{}{}.{:03}\n", time.ps() / 1'000'000'000'000, time.ps() % 1'000'000'000'000, csv_field(nodes[node.value].name),
                          csv_field(nodes[grandmaster.value].name), ps < 0 ? "-" : "", std::llabs(ps) / 1000, std::llabs(ps) % 1000));
}

}  // namespace takt::output
