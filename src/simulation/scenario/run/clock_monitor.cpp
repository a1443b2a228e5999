// SPDX-License-Identifier: Apache-2.0
#include "scenario/run/clock_monitor.hpp"

#include <algorithm>
#include <utility>

#include "sim/check.hpp"

namespace takt::scenario {
namespace {
constexpr sim::Duration near_enough =
    sim::Duration::from_ps(1'000'000);       // a servo calls itself locked while it still closes in
constexpr std::size_t most_partings = 1000;  // that are kept of those that are over

sim::Duration difference(sim::LocalTime a, sim::LocalTime b) { return sim::Duration::from_ps(a.ps() - b.ps()); }
sim::Duration size_of(sim::Duration duration) {
  return duration < sim::Duration() ? sim::Duration() - duration : duration;
}
}  // namespace

ClockMonitor::ClockMonitor(sim::Simulation& simulation, const models::Network& network, Settings settings,
                           std::span<const sim::Duration> instants)
    : simulation_(&simulation),
      network_(&network),
      settings_(std::move(settings)),
      distances_(instants),
      differences_(settings_.groups.size(), Accounts<ClockDifferences>(instants)),
      source_(simulation.add(*this)) {
  const auto nodes = static_cast<std::uint32_t>(network.plan().nodes.size());
  for (std::uint32_t n = 0; n < nodes; ++n) {
    const models::NodeIndex node{n};
    if (network.has(node)) own_.push_back(node);
    if (network.station(node) != nullptr)
      figures_.push_back(
          {node, {}, false, Accounts<ClockFigures::Offsets>(instants), Accounts<ClockFigures::Distances>(instants)});
  }
  is_part_ = own_.size() < nodes;
}

void ClockMonitor::handle(sim::Simulation& simulation, const sim::Event&) {
  const sim::TrueTime now = simulation.now();
  ++count_;
  std::vector<Look>& looks = is_part_ ? looks_ : now_;
  if (!is_part_) looks.clear();
  for (const models::NodeIndex node : own_) looks.push_back(look_at(node));
  if (!is_part_) judge(now, looks);
  simulation.schedule(source_, now + settings_.every, sim::Phase::control, source_.id(), 0, 0);
}

ClockMonitor::Look ClockMonitor::look_at(models::NodeIndex node) const {
  Look look{network_->clock(node).local_at(simulation_->now()), node};
  const models::gptp::Station* const station = network_->station(node);
  if (station == nullptr) return look;
  look.speaks_gptp = true;
  look.grandmaster = station->grandmaster();
  look.is_up = station->is_up();
  look.is_locked = station->target().state() == models::gptp::TargetState::locked;
  look.has_grandmaster = station->has_grandmaster();
  return look;
}

void ClockMonitor::judge(sim::TrueTime now, const std::vector<Look>& looks) {
  for (ClockFigures& figures : figures_)
    if (const Look& look = looks[figures.node.value]; look.is_up)
      take(figures, now, look, looks[look.grandmaster.value].local);
  if (!figures_.empty()) judge_leaders(now, looks);
  judge_groups(now, looks);
}

/// The node whose time it has in the end: a secondary grandmaster of a hot standby may itself follow the primary one.
models::NodeIndex ClockMonitor::source_of(const std::vector<Look>& looks, models::NodeIndex node) {
  constexpr int most_steps = 4;  // while a grandmaster is elected nodes may name each other
  for (int step = 0; step < most_steps; ++step) {
    const Look& look = looks[node.value];
    if (!look.is_up || !look.has_grandmaster || look.grandmaster == node) return node;
    node = look.grandmaster;
  }
  return node;
}

/// The grandmasters whose clocks are farthest apart, of those that somebody follows; or of those that would be it and
/// cannot give time.
std::optional<ClockMonitor::Span> ClockMonitor::grandmasters_in(const std::vector<Look>& looks, bool give_time) const {
  std::optional<Span> span;
  for (const ClockFigures& figures : figures_) {
    const Look& look = looks[figures.node.value];
    if (!look.is_up || look.has_grandmaster != give_time) continue;
    if (!span) span = {look.grandmaster, look.grandmaster};
    const sim::LocalTime shown = looks[look.grandmaster.value].local;
    if (shown < looks[span->behind.value].local) span->behind = look.grandmaster;
    if (shown > looks[span->ahead.value].local) span->ahead = look.grandmaster;
  }
  return span;
}

void ClockMonitor::judge_leaders(sim::TrueTime now, const std::vector<Look>& looks) {
  source_of_.assign(looks.size(), models::NodeIndex{});
  followers_.assign(looks.size(), 0);
  const auto participates = [&](const ClockFigures& figures) { return looks[figures.node.value].is_up; };
  std::optional<Span> span = grandmasters_in(looks, true);
  if (!span) span = grandmasters_in(looks, false);
  if (!span) return;  // nobody is up
  for (ClockFigures& figures : figures_) {
    if (!participates(figures)) continue;
    const Look& look = looks[figures.node.value];
    source_of_[figures.node.value] = source_of(looks, figures.node);
    if (look.has_grandmaster) ++followers_[source_of_[figures.node.value].value];  // itself, too
    const models::NodeIndex far = size_of(difference(look.local, looks[span->behind.value].local)) >
                                          size_of(difference(look.local, looks[span->ahead.value].local))
                                      ? span->behind
                                      : span->ahead;
    const sim::Duration distance = size_of(difference(look.local, looks[far.value].local));
    distances_.add(now, [&](GrandmasterDistances& all) {
      if (all.samples++ == 0 || distance > all.greatest) all = {all.samples, distance, now, figures.node, far};
    });
  }
  const auto leader = static_cast<std::uint32_t>(std::ranges::max_element(followers_) - followers_.begin());
  std::optional<Parting> parting;
  for (ClockFigures& figures : figures_) {
    const Look& look = looks[figures.node.value];
    std::optional<Parting> alone;
    if (participates(figures)) {
      const models::NodeIndex source = source_of_[figures.node.value];
      figures.has_led = figures.has_led || followers_[figures.node.value] > 1;
      // Where nobody gives the time, nobody follows another one.
      const bool is_apart =
          followers_[leader] == 0 ? figures_.size() > 1 : !look.has_grandmaster || source.value != leader;
      const Parting seen{now,
                         {},
                         figures.node,
                         look.has_grandmaster ? std::optional(source) : std::nullopt,
                         followers_[leader] > 0 ? std::optional(models::NodeIndex{leader}) : std::nullopt};
      if (is_apart && !parting) parting = seen;
      if (is_apart && (!look.has_grandmaster || (source == figures.node && followers_[figures.node.value] == 1)))
        alone = seen;
    }
    note(figures.alone, now, alone);
  }
  note(partings_, now, parting);
}

/// Partings that an election explains are forgotten when they are over.
void ClockMonitor::note(std::vector<Parting>& partings, sim::TrueTime now, const std::optional<Parting>& seen) const {
  const bool is_going_on = !partings.empty() && !partings.back().until;
  if (seen && !is_going_on && partings.size() < most_partings) partings.push_back(*seen);
  if (seen || !is_going_on) return;
  partings.back().until = now;
  if (now - partings.back().from <= settings_.election_time) partings.pop_back();
}

void ClockMonitor::judge_groups(sim::TrueTime now, const std::vector<Look>& looks) {
  for (std::size_t g = 0; g < settings_.groups.size(); ++g) {
    std::optional<Span> span;
    for (const std::uint32_t n : settings_.groups[g].nodes) {
      if (!looks[n].is_up) continue;
      if (!span) span = {models::NodeIndex{n}, models::NodeIndex{n}};
      if (looks[n].local < looks[span->behind.value].local) span->behind = models::NodeIndex{n};
      if (looks[n].local > looks[span->ahead.value].local) span->ahead = models::NodeIndex{n};
    }
    if (!span) continue;
    const sim::Duration apart = difference(looks[span->ahead.value].local, looks[span->behind.value].local);
    differences_[g].add(now, [&](ClockDifferences& all) {
      if (all.samples++ == 0 || apart > all.greatest) all = {all.samples, apart, now, span->behind, span->ahead};
    });
  }
}

void ClockMonitor::take(ClockFigures& figures, sim::TrueTime now, const Look& look, sim::LocalTime grandmaster) {
  const sim::Duration offset = difference(look.local, grandmaster);
  if (sink_ != nullptr)
    sink_->sample({now, figures.node, look.grandmaster, offset, sim::Duration::from_ps(look.local.ps() - now.ps())});
  const sim::Duration distance = size_of(offset);
  figures.distances.add(now, [&](ClockFigures::Distances& distances) {
    if (distances.samples++ == 0 || distance > distances.greatest) distances = {distances.samples, distance, now};
  });
  if (!figures.locked) {
    if (!look.is_locked || distance > near_enough) return;
    figures.locked = now;
  }
  figures.offsets.add(now, [&](ClockFigures::Offsets& offsets) { offsets.add(now, offset); });
}

void ClockMonitor::put_together(std::span<const ClockMonitor* const> all) {
  // Where all nodes are in one part, nothing was left to be put together.
  for (const ClockMonitor* const monitor : all)
    if (!monitor->is_part_) {
      figures_ = monitor->figures_;
      distances_ = monitor->distances_;
      differences_ = monitor->differences_;
      partings_ = monitor->partings_;
      return;
    }
  for (const ClockMonitor* const monitor : all)
    TAKT_CHECK(monitor->count_ == count_, "parts of a run end at one instant");
  now_.resize(network_->plan().nodes.size());
  for (std::uint64_t k = 0; k < count_; ++k) {
    for (const ClockMonitor* const monitor : all)
      for (std::size_t at = 0; at < monitor->own_.size(); ++at)
        now_[monitor->own_[at].value] = monitor->looks_[k * monitor->own_.size() + at];
    judge(sim::TrueTime() + settings_.every * static_cast<std::int64_t>(k + 1), now_);
  }
}

void ClockFigures::Offsets::add(sim::TrueTime at, sim::Duration offset) {
  if (samples == 0 || size_of(offset) > std::max(greatest, sim::Duration() - least)) greatest_at = at;
  least = samples == 0 ? offset : std::min(least, offset);
  greatest = samples == 0 ? offset : std::max(greatest, offset);
  ++samples;
  sum += offset.ps();
  sum_of_squares += static_cast<sim::int128>(offset.ps()) * offset.ps();
}

}  // namespace takt::scenario
