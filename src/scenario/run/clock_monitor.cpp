#include "scenario/run/clock_monitor.hpp"

#include <algorithm>
#include <utility>

#include "sim/check.hpp"

namespace takt::scenario {
namespace {
constexpr sim::Duration near_enough = sim::Duration::from_ps(1'000'000);  // a servo calls itself locked while it still closes in
}

ClockMonitor::ClockMonitor(sim::Simulation& simulation, const models::Network& network, sim::Duration every, std::span<const sim::Duration> instants)
    : simulation_(&simulation), network_(&network), every_(every), source_(simulation.add(*this)) {
  bool is_whole = true;
  for (std::uint32_t n = 0; n < network.plan().nodes.size(); ++n) {
    is_whole = is_whole && network.has(models::NodeIndex{n});
    if (network.station(models::NodeIndex{n}) == nullptr) continue;
    if (network.has(models::NodeIndex{n})) own_.push_back(static_cast<std::uint32_t>(figures_.size()));
    figures_.push_back({models::NodeIndex{n}, {}, Accounts<ClockFigures::Offsets>(instants), Accounts<ClockFigures::Distances>(instants)});
  }
  is_part_ = !is_whole;
}

void ClockMonitor::handle(sim::Simulation& simulation, const sim::Event&) {
  const sim::TrueTime now = simulation.now();
  ++count_;
  for (const std::uint32_t f : own_) {
    const Look look = look_at(figures_[f].node);
    if (is_part_)
      looks_.push_back(look);
    else if (look.is_up)
      take(figures_[f], now, look, network_->clock(look.grandmaster).local_at(now));
  }
  simulation.schedule(source_, now + every_, sim::Phase::control, source_.id(), 0, 0);
}

ClockMonitor::Look ClockMonitor::look_at(models::NodeIndex node) const {
  const models::gptp::Station& station = *network_->station(node);
  return {network_->clock(node).local_at(simulation_->now()), station.grandmaster(), station.is_up(), station.target().state() == models::gptp::TargetState::locked};
}

void ClockMonitor::take(ClockFigures& figures, sim::TrueTime now, const Look& look, sim::LocalTime grandmaster) {
  const sim::Duration offset = sim::Duration::from_ps(look.local.ps() - grandmaster.ps());
  if (sink_ != nullptr) sink_->sample(now, figures.node, look.grandmaster, offset);
  const sim::Duration distance = offset < sim::Duration() ? sim::Duration() - offset : offset;
  figures.distances.add(now, [&](ClockFigures::Distances& distances) {
    ++distances.samples;
    distances.greatest = std::max(distances.greatest, distance);
  });
  if (!figures.locked) {
    if (!look.is_locked || distance > near_enough) return;
    figures.locked = now;
  }
  figures.offsets.add(now, [&](ClockFigures::Offsets& offsets) { offsets.add(offset); });
}

void ClockMonitor::put_together(std::span<const ClockMonitor* const> all) {
  // Where all nodes are in one part, nothing was left to be put together.
  for (const ClockMonitor* const monitor : all)
    if (!monitor->is_part_) {
      figures_ = monitor->figures_;
      return;
    }
  struct Place {
    const ClockMonitor* monitor = nullptr;
    std::size_t at = 0;
  };
  std::vector<Place> places(figures_.size());
  std::vector<std::uint32_t> of_node(network_->plan().nodes.size());
  for (std::uint32_t f = 0; f < figures_.size(); ++f) of_node[figures_[f].node.value] = f;
  for (const ClockMonitor* const monitor : all) {
    TAKT_CHECK(monitor->count_ == count_, "parts of a run end at one instant");
    for (std::size_t at = 0; at < monitor->own_.size(); ++at) places[monitor->own_[at]] = {monitor, at};
  }
  const auto look = [&](std::uint32_t figures, std::uint64_t number) -> const Look& {
    const Place& place = places[figures];
    return place.monitor->looks_[number * place.monitor->own_.size() + place.at];
  };
  for (std::uint64_t k = 0; k < count_; ++k)
    for (std::uint32_t f = 0; f < figures_.size(); ++f)
      if (look(f, k).is_up) take(figures_[f], sim::TrueTime() + every_ * static_cast<std::int64_t>(k + 1), look(f, k), look(of_node[look(f, k).grandmaster.value], k).local);
}

void ClockFigures::Offsets::add(sim::Duration offset) {
  least = samples == 0 ? offset : std::min(least, offset);
  greatest = samples == 0 ? offset : std::max(greatest, offset);
  ++samples;
  sum += offset.ps();
  sum_of_squares += static_cast<sim::int128>(offset.ps()) * offset.ps();
}

}  // namespace takt::scenario
