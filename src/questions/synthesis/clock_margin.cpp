// SPDX-License-Identifier: Apache-2.0
#include "synthesis/clock_margin.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <string>

#include "analysis/assessment.hpp"
#include "analysis/flow_graph.hpp"
#include "json/node.hpp"
#include "json/quantity.hpp"
#include "json/record.hpp"
#include "scenario/gates/timing.hpp"
#include "scenario/resolve/clock_groups.hpp"
#include "scenario/gates/resolve_gates.hpp"
#include "scenario/resolve.hpp"
#include "scenario/run/run.hpp"

namespace takt::synthesis {
namespace {

using scenario::Resolved;
using scenario::Scenario;
using sim::Duration;

constexpr Duration look_every = Duration::from_ps(100'000'000);

Duration whole_ns(Duration time) { return Duration::from_ps((time.ps() + 999) / 1'000 * 1'000); }

/// What two oscillators drift apart in that time, each off by up to so many parts in 10^12.
Duration drift_apart(Duration time, std::int64_t rate_ppt) {
  constexpr sim::int128 one_ppt = 1'000'000'000'000;
  return Duration::from_ps(
      static_cast<std::int64_t>((static_cast<sim::int128>(time.ps()) * 2 * rate_ppt + one_ppt - 1) / one_ppt));
}

/// The scenario as its clocks see it: offsets and gates that are yet to be found do not matter to them.
Scenario for_clocks(const Scenario& wanted) {
  Scenario made = wanted;
  made.gates.reset();
  made.allow_overload = true;
  for (scenario::Stream& stream : made.streams)
    if (stream.offset && stream.offset->is_auto) stream.offset = json::OrAuto<Duration>(Duration());
  for (scenario::Program& program : made.programs)
    if (program.offset && program.offset->is_auto) program.offset = json::OrAuto<Duration>(Duration());
  if (made.clocks.gptp) made.clocks.gptp->report_every = std::min(made.clocks.gptp->report_every, look_every);
  return made;
}

class Measurement {
 public:
  Measurement(const Scenario& wanted, json::Diagnostics& diagnostics)
      : wanted_(wanted), diagnostics_(diagnostics), place_(wanted.gates->where.at("margin")) {}

  std::optional<ClockMargin> run() {
    Scenario bare = for_clocks(wanted_);
    const auto resolved = scenario::resolve(bare, diagnostics_);
    if (!resolved || diagnostics_.has_errors()) return std::nullopt;
    if (resolved->plan.gptp.empty())
      return refuse("a margin of clocks that nothing synchronises", "\"auto\" without gPTP",
                    "a duration, or \"gptp\" in \"clocks\"");
    resolved->scenario.gates = wanted_.gates;
    const auto gated = scenario::gate_problem_of(*resolved, scenario::timings_of(*resolved), diagnostics_);
    resolved->scenario.gates.reset();
    if (!gated) return std::nullopt;
    if (!is_synchronised_all_the_way(*resolved, gated->problem)) return std::nullopt;
    const analysis::ClockPremise premise = analysis::clock_premise(*resolved, {});
    made_.from = premise.requirement ? premise.after : wanted_.warm_up;
    if (premise.requirement) made_.required = premise.difference();
    made_.nodes = nodes_on_ways(*resolved);
    if (made_.from >= wanted_.duration)
      return refuse("nothing to measure clocks by",
                    json::to_text(made_.from) + " of " + json::to_text(wanted_.duration) + " pass before",
                    "a longer \"duration\"");
    for (; made_.seeds < clock_margin_seeds; ++made_.seeds) {
      bare.seed = wanted_.seed + made_.seeds;
      if (!measure(bare)) return std::nullopt;
    }
    std::int64_t rate_ppt = 0;
    for (std::uint32_t n = 0; n < resolved->plan.nodes.size(); ++n)
      if (resolved->plan.gptp[n])
        rate_ppt = std::max(rate_ppt, analysis::clock_quality(*resolved, models::NodeIndex{n}, {}).rate_ppt);
    made_.between_looks = drift_apart(bare.clocks.gptp->report_every / 2, rate_ppt);
    made_.difference = whole_ns(std::max(made_.measured + made_.between_looks, made_.required.value_or(Duration())));
    made_.on_the_way = drift_apart(longest_wait(gated->problem), rate_ppt);
    made_.margin = whole_ns(made_.difference + made_.on_the_way);
    constexpr Duration most = Duration::from_ps(1'000'000'000'000);  // as for a margin that is written
    if (made_.margin > most)
      return refuse("clocks that are too far apart for gates", json::to_text(made_.margin) + " as margin",
                    "clocks that need at most " + json::to_text(most));
    return made_;
  }

 private:
  std::nullopt_t refuse(const std::string& what, const std::string& found, const std::string& expected) {
    diagnostics_.error(place_, what, {found, expected});
    return std::nullopt;
  }

  /// Clocks of nodes without gPTP may be any time apart from the others.
  bool is_synchronised_all_the_way(const Resolved& resolved, const scenario::GateProblem& problem) {
    for (const scenario::GatedPort& port : problem.ports) {
      if (resolved.plan.gptp[port.node.value]) continue;
      refuse("a margin of clocks that nothing synchronises",
             json::quote(resolved.plan.nodes[port.node.value].name) + " sends scheduled frames and is without gPTP",
             "a duration, or gPTP at all nodes that scheduled frames pass");
      return false;
    }
    return true;
  }

  bool measure(const Scenario& seeded) {
    const auto resolved = scenario::resolve(seeded, diagnostics_);
    if (!resolved || diagnostics_.has_errors()) return false;
    const std::string in_a_run = fmt::format(" in a run with seed {}", seeded.seed);
    const std::string later = made_.required ? "a later \"after\" of the requirement on clocks"
                                             : "a longer \"warm_up\", or a requirement \"sync\" with \"after\"";
    scenario::Run run(*resolved);
    run.advance();
    for (const scenario::ClockFigures& each : run.clocks()->figures()) {
      const models::gptp::Station& station = *run.network().station(each.node);
      if (station.grandmaster() == each.node || (each.locked && *each.locked <= sim::TrueTime() + made_.from)) continue;
      const std::string& name = resolved->plan.nodes[each.node.value].name;
      const std::string since =
          each.locked ? "from " + json::to_text(each.locked->since_start()) + " on" : "at no time";
      refuse("clocks that are not synchronised in time",
             fmt::format("{} follows its grandmaster {}{}, not by {}", json::quote(name), since, in_a_run,
                         json::to_text(made_.from)),
             later);
      return false;
    }
    for (const scenario::Parting& each : run.clocks()->partings())
      if (!each.until || each.until->since_start() > made_.from)
        return refuse("clocks that follow two grandmasters",
                      resolved->plan.nodes[each.node.value].name + " follows another one than the rest" + in_a_run +
                          " at " + json::to_text(each.from.since_start()),
                      "one, or a duration as margin"),
               false;
    for (std::size_t g = 0; g < run.clocks()->groups().size(); ++g)
      if (run.clocks()->groups()[g].name.starts_with(scenario::clocks_on_ways) &&
          !take(run.clocks()->differences(g).from(made_.from), *resolved, in_a_run))
        return false;
    return true;
  }

  bool take(const scenario::ClockDifferences& seen, const Resolved& resolved, const std::string& in_a_run) {
    if (seen.samples == 0)
      return refuse("nothing to measure clocks by", "no look at them" + in_a_run, "a longer \"duration\""), false;
    made_.measured = std::max(made_.measured, seen.greatest);
    if (!made_.required || seen.greatest <= *made_.required) return true;
    const auto name = [&](models::NodeIndex node) { return json::quote(resolved.plan.nodes[node.value].name); };
    return refuse(
               "clocks that are worse than is required",
               json::to_text(seen.greatest) + " between " + name(seen.behind) + " and " + name(seen.ahead) + in_a_run,
               "at most the " + json::to_text(*made_.required) + " of the requirement on clocks"),
           false;
  }

  /// Those with gPTP: the others send nothing that is scheduled.
  static std::vector<std::string> nodes_on_ways(const Resolved& resolved) {
    std::vector<std::string> names;
    for (const std::vector<std::uint32_t>& joined : scenario::nodes_joined_by_ways(resolved))
      for (const std::uint32_t node : joined)
        if (resolved.plan.gptp[node]) names.push_back(resolved.plan.nodes[node].name);
    return names;
  }

  /// For how long a frame is under way, and may stand before gates, by clocks that drift.
  static Duration longest_wait(const scenario::GateProblem& problem) {
    Duration longest;
    for (const scenario::ScheduledStream& stream : problem.streams) {
      std::vector<Duration> at;
      for (const scenario::ScheduledHop& hop : stream.hops)
        at.push_back((hop.previous ? at[*hop.previous] : Duration()) + hop.transmission + hop.behind);
      for (const Duration each : at) longest = std::max(longest, stream.period + each);
    }
    return longest;
  }

  const Scenario& wanted_;
  json::Diagnostics& diagnostics_;
  json::Place place_;
  ClockMargin made_;
};

}  // namespace

std::optional<ClockMargin> measure_clock_margin(const Scenario& wanted, json::Diagnostics& diagnostics) {
  return Measurement(wanted, diagnostics).run();
}

Scenario with_clock_margin(Scenario scenario, const ClockMargin& margin) {
  scenario.gates->margin = json::OrAuto<Duration>(margin.margin);
  if (margin.required || margin.nodes.size() < 2) return scenario;
  scenario::Requirement kept;
  kept.clocks = scenario::Names{margin.nodes};
  kept.within.emplace().time = margin.difference;
  kept.after = margin.from;
  scenario.require.push_back(std::move(kept));
  return scenario;
}

const json::Record& describe(json::Type<ClockMargin>) {
  static constexpr json::Output outputs[] = {
      json::output<&ClockMargin::margin>("margin_ps",
                                         "By how much clocks of two nodes on a way may differ while a frame is under "
                                         "way: the difference and what drifts on the way, in whole ns."),
      json::output<&ClockMargin::difference>(
          "difference_ps",
          "By how much clocks of two nodes on a way may differ at one instant: what is required, or what was measured "
          "and drifts between looks if that is more."),
      json::output<&ClockMargin::seeds>("seeds",
                                        "Runs of the scenario that it was measured in, with seeds from its own on."),
      json::output<&ClockMargin::from>("from_ps", "Measured from then on."),
      json::output<&ClockMargin::measured>("measured_ps", "The greatest difference of two clocks in all runs."),
      json::output<&ClockMargin::between_looks>("between_looks_ps",
                                                "Bound of what oscillators drift apart from the nearest look on."),
      json::output<&ClockMargin::required>("required_ps",
                                           "What requirements of the scenario let clocks differ by; null: it has none, "
                                           "and gets the difference as a requirement `clocks`."),
      json::output<&ClockMargin::on_the_way>(
          "on_the_way_ps", "Bound of what oscillators drift apart in a period and on the way of a scheduled frame."),
  };
  static constexpr json::Record record{"clock_margin", "The margin \"auto\" of gates, and what it is made of.",
                                       outputs};
  return record;
}

}  // namespace takt::synthesis
