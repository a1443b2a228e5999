#include "evaluation/collect_clocks.hpp"

#include <cmath>

namespace takt::evaluation {

using namespace results;
namespace {

const char* name_of(models::gptp::ClockState state) {
  constexpr const char* names[] = {"free-running", "acquiring", "locked", "holdover", "down"};
  return names[static_cast<std::size_t>(state)];
}

}  // namespace

std::vector<ClockResult> clocks_of(const scenario::Run& run, sim::Duration from) {
  std::vector<ClockResult> results;
  if (run.clocks() == nullptr) return results;
  const models::Network& network = run.network();
  const auto name = [&](models::NodeIndex node) { return network.plan().nodes[node.value].name; };
  for (const scenario::ClockFigures& figures : run.clocks()->figures()) {
    const models::gptp::Station& station = *network.station(figures.node);
    ClockResult result;
    result.node = name(figures.node);
    result.grandmaster = name(station.grandmaster());
    result.state = station.is_up() && station.active_is_grandmaster() ? "grandmaster" : name_of(station.state());
    if (figures.locked) result.time_to_lock = figures.locked->since_start();
    const scenario::ClockFigures::Offsets& offsets = figures.offsets.from(from);
    result.samples = offsets.samples;
    if (offsets.samples > 0) {
      result.least = offsets.least;
      result.greatest = offsets.greatest;
      const auto count = static_cast<double>(offsets.samples);
      result.mean = sim::Duration::from_ps(std::llround(static_cast<double>(offsets.sum) / count));
      result.rms = sim::Duration::from_ps(std::llround(std::sqrt(static_cast<double>(offsets.sum_of_squares) / count)));
    }
    const auto rate = [&](models::NodeIndex node) { return static_cast<long double>(network.clock(node).rate().multiple()); };
    result.frequency_error_ppt = std::llround((rate(figures.node) / rate(station.grandmaster()) - 1.0L) * 1e12L);
    result.steps = station.steps();
    result.messages = station.messages_sent();
    for (const models::gptp::Station::Change& change : station.changes()) result.changes.push_back({change.time, name(change.grandmaster), name_of(change.state)});
    results.push_back(std::move(result));
  }
  return results;
}

}  // namespace takt::evaluation
