#include "scenario/run/clock_monitor.hpp"

#include <algorithm>
#include <utility>

namespace takt::scenario {
namespace {
constexpr sim::Duration near_enough = sim::Duration::from_ps(1'000'000);  // a servo calls itself locked while it still closes in
}

ClockMonitor::ClockMonitor(sim::Simulation& simulation, const models::Network& network, sim::Duration every, std::span<const sim::Duration> instants)
    : simulation_(&simulation), network_(&network), every_(every), source_(simulation.add(*this)) {
  for (std::uint32_t n = 0; n < network.plan().nodes.size(); ++n)
    if (network.station(models::NodeIndex{n}) != nullptr) figures_.push_back({models::NodeIndex{n}, {}, Accounts<ClockFigures::Offsets>(instants), Accounts<ClockFigures::Distances>(instants)});
}

void ClockMonitor::handle(sim::Simulation& simulation, const sim::Event&) {
  for (ClockFigures& figures : figures_) look_at(*network_->station(figures.node), figures);
  simulation.schedule(source_, simulation.now() + every_, sim::Phase::control, source_.id(), 0, 0);
}

void ClockMonitor::look_at(const models::gptp::Station& station, ClockFigures& figures) {
  if (!station.is_up()) return;
  const sim::TrueTime now = simulation_->now();
  const models::NodeIndex grandmaster = station.grandmaster();
  const sim::Duration offset = sim::Duration::from_ps(network_->clock(figures.node).local_at(now).ps() - network_->clock(grandmaster).local_at(now).ps());
  if (sink_ != nullptr) sink_->sample(now, figures.node, grandmaster, offset);
  const sim::Duration distance = offset < sim::Duration() ? sim::Duration() - offset : offset;
  figures.distances.add(now, [&](ClockFigures::Distances& distances) {
    ++distances.samples;
    distances.greatest = std::max(distances.greatest, distance);
  });
  if (!figures.locked) {
    if (station.target().state() != models::gptp::TargetState::locked || distance > near_enough) return;
    figures.locked = now;
  }
  figures.offsets.add(now, [&](ClockFigures::Offsets& offsets) { offsets.add(offset); });
}

void ClockFigures::Offsets::add(sim::Duration offset) {
  least = samples == 0 ? offset : std::min(least, offset);
  greatest = samples == 0 ? offset : std::max(greatest, offset);
  ++samples;
  sum += offset.ps();
  sum_of_squares += static_cast<sim::int128>(offset.ps()) * offset.ps();
}

}  // namespace takt::scenario
