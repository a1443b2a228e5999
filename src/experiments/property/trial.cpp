// SPDX-License-Identifier: Apache-2.0
#include "property/trial.hpp"

#include <algorithm>
#include <memory>
#include <set>

#include "evaluation/evaluate.hpp"
#include "scenario/resolve.hpp"
#include "scenario/run/run.hpp"
#include "sim/check.hpp"
#include "verify/free_variable.hpp"
#include "verify/shortened.hpp"

namespace takt::property {
namespace {

using scenario::Scenario;
using sim::Duration;

constexpr std::int64_t parts = 1000;

Duration part_of(Duration whole, std::uint32_t thousandths) {
  return Duration::from_ps(static_cast<std::int64_t>(static_cast<sim::int128>(whole.ps()) *
                                                     std::min<std::uint32_t>(thousandths, parts - 1) / parts));
}

class Builder {
 public:
  Builder(const scenario::Resolved& resolved, const Space& space, Scenario made)
      : resolved_(resolved), space_(space), made_(std::move(made)) {}

  void add(const Trouble& trouble) {
    const Duration at = part_of(made_.duration, trouble.when);
    const Duration longest = space_.longest > Duration() ? space_.longest : made_.duration / 10;
    const Duration lasts =
        std::max(Duration::from_ps(1), std::min(part_of(longest, trouble.size), made_.duration - at));
    if (trouble.kind == Trouble::Kind::crash) {
      crash(trouble.where, at, lasts);
      return;
    }
    if (resolved_.plan.links.empty()) return;
    const std::size_t link = trouble.where % resolved_.plan.links.size();
    if (!taken_.insert({trouble.kind, link}).second) return;
    const std::vector<std::string> ends{name_of(resolved_.plan.links[link].a.node),
                                        name_of(resolved_.plan.links[link].b.node)};
    if (trouble.kind == Trouble::Kind::link_down) {
      scenario::LinkDown fault;
      fault.link = ends;
      fault.at = at;
      fault.lasts = lasts;
      made_.faults.emplace_back(fault);
    } else if (trouble.size > 0) {
      scenario::FrameErrors fault;
      fault.link = ends;
      fault.loss = space_.highest_loss * static_cast<double>(std::min<std::uint32_t>(trouble.size, parts)) /
                   static_cast<double>(parts);
      made_.faults.emplace_back(fault);
    }
  }

  Scenario take() { return std::move(made_); }

 private:
  const std::string& name_of(models::NodeIndex node) const { return resolved_.plan.nodes[node.value].name; }

  void crash(std::uint32_t where, Duration at, Duration lasts) {
    std::vector<std::string> hosts;
    for (const scenario::TopologyNode& node : resolved_.topology.nodes)
      if (node.is_end_station()) hosts.push_back(node.name);
    if (hosts.empty() || !taken_.insert({Trouble::Kind::crash, where % hosts.size()}).second) return;
    scenario::Crash fault;
    fault.node = hosts[where % hosts.size()];
    fault.at = at;
    fault.lasts = lasts;
    made_.faults.emplace_back(fault);
  }

  const scenario::Resolved& resolved_;
  const Space& space_;
  Scenario made_;
  std::set<std::pair<Trouble::Kind, std::size_t>> taken_;
};

}  // namespace

Scenario scenario_of(const scenario::Resolved& resolved, const Space& space, const Trial& trial) {
  const std::vector<verify::FreeVariable> variables =
      space.phases ? verify::free_variables_of(resolved) : std::vector<verify::FreeVariable>{};
  verify::Choice choice{resolved.scenario.seed + trial.seed, {}};
  for (std::size_t f = 0; f < variables.size(); ++f)
    choice.values.push_back(part_of(variables[f].range, f < trial.phases.size() ? trial.phases[f] : 0));
  const Duration outage = space.longest * (space.link_downs || space.crashes ? 3 : 0);
  Builder builder(resolved, space,
                  verify::scenario_of(space.shorten ? verify::shortened(resolved.scenario, outage) : resolved.scenario,
                                      variables, choice));
  for (const Trouble& trouble : trial.troubles) builder.add(trouble);
  return builder.take();
}

bool Outcome::reacted_within(const std::string& kind, Duration limit) const {
  for (const results::ProgramResult& program : result_.programs)
    for (const results::ReactionResult& reaction : program.reactions)
      if (reaction.kind == kind && !reaction.superseded && reaction.duration().value_or(Duration::max()) > limit)
        return false;
  return true;
}

bool Outcome::all_end_in(const std::string& state) const {
  for (const results::ProgramResult& program : result_.programs)
    for (const std::string& each : program.states)
      if (each != state) return false;
  return true;
}

bool Outcome::keeps_invariants() const {
  return std::all_of(result_.programs.begin(), result_.programs.end(),
                     [](const results::ProgramResult& program) { return program.violations.empty(); });
}

bool Outcome::latency_within(const std::string& stream, Duration limit) const {
  for (const results::StreamResult& each : result_.streams)
    if (each.name == stream) return !each.latency || each.latency->max <= limit;
  TAKT_CHECK(false, "the property names a stream of the scenario");
}

Outcome run(const Scenario& scenario) {
  json::Diagnostics diagnostics;
  const std::unique_ptr<scenario::Resolved> resolved = scenario::resolve(scenario, diagnostics);
  TAKT_CHECK(resolved != nullptr, "a trial of a sound scenario is one");
  scenario::Run live(*resolved);
  live.advance();
  return Outcome(evaluation::evaluate(live, false));
}

}  // namespace takt::property
