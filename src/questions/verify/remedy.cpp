// SPDX-License-Identifier: Apache-2.0
#include "verify/remedy.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "analysis/bounds.hpp"
#include "explain/ask.hpp"
#include "json/fields.hpp"
#include "json/quantity.hpp"
#include "scenario/resolve.hpp"
#include "verify/adversary.hpp"
#include "verify/bounds.hpp"
#include "verify/free_variable.hpp"
#include "verify/probe.hpp"

namespace takt::verify {
namespace {

using results::RequirementKind;
using scenario::Scenario;
using sim::Duration;

/// What a change takes of who makes it, the least first.
enum class Price : std::uint8_t {
  configured,    ///< a setting of what is there
  reconfigured,  ///< a setting that touches others
  programmed,    ///< less data, or data more seldom: the application is another one
  bought         ///< other devices
};

/// Something that can be changed: `apply` puts a value into a scenario.
struct Knob {
  std::string what;
  std::vector<std::int64_t>
      values;  ///< from what is nearest to the present one on; holds from some place on, or nowhere
  std::function<void(Scenario&, std::int64_t)> apply;
  std::function<std::string(std::int64_t)> text;
  Price price = Price::configured;
};

/// What a search for a change that is proved may cost, in runs: so many that those with other seeds fit in the quarter
/// that they get.
constexpr std::uint64_t runs_of_a_trial(unsigned seeds) { return 4 * std::uint64_t{seeds}; }

class Workshop {
 public:
  Workshop(const scenario::Resolved& resolved, const RemedyQuestion& question, Budget& budget)
      : now_(resolved),
        asked_(resolved.scenario),
        question_(question),
        required_(question.requirement),
        seeds_(question.seeds),
        cost_of_trial_(runs_of_a_trial(question.seeds) * question.cost_of_run),
        budget_(budget) {}

  std::optional<Remedy> look(const Knob& knob) {
    const auto is_proved_with = [&](std::size_t number) { return proved_with(knob, knob.values[number]); };
    std::optional<std::size_t> nearest = first_of(knob, 0, is_proved_with);
    if (!nearest) return std::nullopt;
    std::optional<Tried> tried = tried_with(knob, knob.values[*nearest]);
    if (!tried) {
      // What is wrong with it is no matter of the bound.
      nearest = first_of(knob, *nearest + 1,
                         [&](std::size_t number) { return tried_with(knob, knob.values[number]).has_value(); });
      if (nearest) tried = tried_with(knob, knob.values[*nearest]);
    }
    if (!tried) return std::nullopt;
    const std::int64_t found = knob.values[*nearest];
    return Remedy{knob.what, knob.text(found), tried->bound, tried->breaks,
                  [apply = knob.apply, found](Scenario& changed) { apply(changed, found); }};
  }

 private:
  /// The first value from there on with which it holds, if it does with the last one.
  template <class Holds>
  std::optional<std::size_t> first_of(const Knob& knob, std::size_t from, Holds&& holds_with) {
    if (from >= knob.values.size() || !holds_with(knob.values.size() - 1)) return std::nullopt;
    std::size_t fails = from, holds = knob.values.size();  // in numbers from 1; `from`: known to fail, or not asked
    while (holds - fails > 1) {
      if (budget_.is_interrupted()) return std::nullopt;
      const std::size_t middle = (fails + holds) / 2;
      (holds_with(middle - 1) ? holds : fails) = middle;
    }
    return holds - 1;
  }

  std::unique_ptr<scenario::Resolved> changed_by(const Knob& knob, std::int64_t value) const {
    Scenario changed = asked_;
    knob.apply(changed, value);
    json::Diagnostics diagnostics;
    return scenario::resolve(std::move(changed), diagnostics);
  }

  bool proved_with(const Knob& knob, std::int64_t value) {
    if (budget_.left() == 0) return false;
    const auto resolved = changed_by(knob, value);
    if (!resolved) return false;
    const analysis::Bounds bounds = bounds_of(*resolved);
    return is_proved(*resolved, bounds, bounds.ledger);
  }

  analysis::Bounds bounds_of(const scenario::Resolved& resolved) {
    analysis::Bounds bounds = analysis::bound(resolved, {.interrupted = budget_.interrupted()});
    budget_.spend(cost_of_bounds(resolved, bounds));
    return bounds;
  }

  bool is_proved(const scenario::Resolved& resolved, const analysis::Bounds& bounds,
                 const analysis::AssumptionLedger& ledger) const {
    if (bounds.is_interrupted) return false;
    const Proof proof = prove(resolved, bounds, {required_}, {}).front();
    return proof.holds && proof.time && ledger.objection(proof.assumptions, proof.from).empty();
  }

  struct Tried {
    Duration bound;
    std::vector<std::string> breaks;
  };

  /// Whether the requirement is proved as things are.
  static bool is_kept(const scenario::Resolved& resolved, const analysis::Bounds& bounds, std::size_t requirement) {
    results::RequirementResult asked;
    asked.requirement = requirement;
    const Proof proof = prove(resolved, bounds, {asked}, {}).front();
    return proof.holds && bounds.ledger.objection(proof.assumptions, proof.from).empty();
  }

  /// What the change costs others.
  std::vector<std::string> broken_by(const scenario::Resolved& changed, const analysis::Bounds& bounds) const {
    std::vector<std::string> broken;
    for (std::size_t i = 0; i < now_.requirements.size(); ++i)
      if (i != *required_.requirement && is_kept(now_, question_.bounds, i) && !is_kept(changed, bounds, i))
        broken.push_back(results::titled(now_.requirements[i].name, now_.requirements[i].text));
    return broken;
  }

  /// A run that has failed it, with the change: what is free in both has the value that it had there.
  bool fails_again(const scenario::Resolved& changed, const analysis::Bounds& bounds) {
    const std::vector<FreeVariable> variables = free_variables_of(changed);
    for (const FoundRun& run : question_.worst) {
      Choice choice{run.choice->seed, std::vector<Duration>(variables.size())};
      for (std::size_t v = 0; v < variables.size(); ++v)
        for (std::size_t known = 0; known < run.ground->variables.size(); ++known)
          if (const FreeVariable& other = run.ground->variables[known]; other.name == variables[v].name)
            choice.values[v] = Duration::from_ps(run.choice->values[known].ps() % variables[v].range.ps());
      const std::optional<Probe> again =
          probe(scenario_of(changed.scenario, variables, choice), bounds, budget_.interrupted());
      if (!again || again->requirements[*required_.requirement].verdict == results::Verdict::fail) return true;
      budget_.spend(question_.cost_of_run);
    }
    return false;
  }

  /// The bound of the scenario with the change, if it is proved, and if no run that a search makes fails it.
  std::optional<Tried> tried_with(const Knob& knob, std::int64_t value) {
    if (budget_.left() < cost_of_trial_) return std::nullopt;
    const auto resolved = changed_by(knob, value);
    if (!resolved) return std::nullopt;
    const analysis::Bounds bounds = bounds_of(*resolved);
    if (!is_proved(*resolved, bounds, bounds.ledger) || fails_again(*resolved, bounds)) return std::nullopt;
    SearchOptions options;
    options.seeds = seeds_;
    options.events = cost_of_trial_;
    options.interrupted = budget_.interrupted();
    const Search found = search(*resolved, bounds, options);
    budget_.spend(cost_of_trial_);
    if (found.partial || found.contradiction) return std::nullopt;
    analysis::AssumptionLedger ledger = bounds.ledger;
    for (const Violation& violation : found.violations) ledger.violate(violation.assumption, violation.witness);
    const bool agrees = !found.findings[*required_.requirement].worst.failed;
    if (!agrees || !is_proved(*resolved, bounds, ledger)) return std::nullopt;
    return Tried{*bounds.requirements[*required_.requirement].duration, broken_by(*resolved, bounds)};
  }

  const scenario::Resolved& now_;
  Scenario asked_;
  const RemedyQuestion& question_;
  results::RequirementResult required_;
  unsigned seeds_;
  std::uint64_t cost_of_trial_;
  Budget& budget_;
};

std::vector<std::int64_t> down_from(std::int64_t present, std::int64_t least, std::int64_t step) {
  std::vector<std::int64_t> values;
  for (std::int64_t value = present - 1; value >= least; --value)
    if (value % step == 0) values.push_back(value);
  return values;
}

std::string as_priority(std::int64_t pcp) { return fmt::format("pcp {}", pcp); }
std::string as_time(std::int64_t ps) { return json::to_text(Duration::from_ps(ps)); }

/// Rounded down to whole steps of a thousandth of it, at least a nanosecond.
std::vector<std::int64_t> times_below(Duration present) {
  std::int64_t step = 1'000;
  while (step * 10'000 <= present.ps()) step *= 10;
  std::vector<std::int64_t> values;
  for (std::int64_t ps = (present.ps() - 1) / step * step; ps > 0; ps -= step) values.push_back(ps);
  return values;
}

constexpr std::int64_t rates[] = {10'000'000,    100'000'000,    1'000'000'000,  2'500'000'000,
                                  5'000'000'000, 10'000'000'000, 25'000'000'000, 100'000'000'000};

template <class Visit>
void for_each_rate(Scenario& scenario, Visit&& visit) {
  for (auto& link : scenario.network.links) visit(link.rate);
  for (auto& generator : scenario.network.generate) {
    visit(generator.rate);
    if (generator.host_rate) visit(*generator.host_rate);
  }
}

Knob link_rate(const Scenario& scenario) {
  std::uint64_t slowest = ~std::uint64_t{0};
  Scenario copy = scenario;
  for_each_rate(copy, [&](sim::DataRate& rate) { slowest = std::min(slowest, rate.bits_per_second); });
  Knob knob{"rate of all links at least",
            {},
            [](Scenario& changed, std::int64_t value) {
              for_each_rate(changed, [&](sim::DataRate& rate) {
                rate.bits_per_second = std::max(rate.bits_per_second, static_cast<std::uint64_t>(value));
              });
            },
            [](std::int64_t value) { return json::to_text(sim::DataRate{static_cast<std::uint64_t>(value)}); },
            Price::bought};
  for (const std::int64_t rate : rates)
    if (static_cast<std::uint64_t>(rate) > slowest) knob.values.push_back(rate);
  return knob;
}

/// All other periodic streams, each with its period stretched.
Knob load_of_others(const Scenario& scenario, const std::string& subject) {
  Knob knob{subject.empty() ? "load of the streams at most" : "load of the other streams at most",
            {},
            [subject](Scenario& changed, std::int64_t percent) {
              for (scenario::Stream& stream : changed.streams)
                if (stream.name != subject && stream.every)
                  stream.every = Duration::from_ps((stream.every->ps() * 100 + percent - 1) / percent);
            },
            [](std::int64_t percent) { return fmt::format("{} % of what it is", percent); },
            Price::programmed};
  const bool any = std::ranges::any_of(scenario.streams, [&](const scenario::Stream& stream) {
    return stream.name != subject && stream.every.has_value();
  });
  if (any) knob.values = down_from(100, 1, 1);
  return knob;
}

std::vector<Knob> knobs_of_stream(const Scenario& scenario, std::size_t index) {
  const scenario::Stream& stream = scenario.streams[index];
  std::vector<Knob> knobs;
  knobs.push_back({"payload of " + stream.name + " at most", down_from(stream.payload.count, 1, 1),
                   [index](Scenario& changed, std::int64_t value) {
                     changed.streams[index].payload = sim::Octets{static_cast<std::uint32_t>(value)};
                   },
                   [](std::int64_t value) { return json::to_text(sim::Octets{static_cast<std::uint32_t>(value)}); },
                   Price::programmed});
  Knob priority{
      "priority of " + stream.name + " at least",
      {},
      [index](Scenario& changed, std::int64_t value) { changed.streams[index].pcp = static_cast<std::uint8_t>(value); },
      as_priority,
      Price::reconfigured};
  for (std::int64_t pcp = stream.pcp.value_or(0) + 1; pcp <= 7; ++pcp) priority.values.push_back(pcp);
  knobs.push_back(std::move(priority));
  if (stream.every) {
    // Its own frames may be in each other's way: a longer period, up to a hundred times.
    Knob period{
        "period of " + stream.name + " at least",
        {},
        [index](Scenario& changed, std::int64_t value) { changed.streams[index].every = Duration::from_ps(value); },
        as_time,
        Price::programmed};
    for (std::int64_t tenths = 11; tenths <= 1000; ++tenths) period.values.push_back(stream.every->ps() / 10 * tenths);
    knobs.push_back(std::move(period));
  }
  return knobs;
}

/// The shorter the cycle, the greater its own load: what holds ends somewhere, so that the shortest is no place to
/// begin at.
std::vector<std::int64_t> cycles_below(Duration present) {
  std::vector<std::int64_t> cycles = times_below(present);
  std::erase_if(cycles, [&](std::int64_t value) { return value < present.ps() / 4; });
  return cycles;
}

std::vector<Knob> knobs_of_program(const Scenario& scenario, std::size_t index) {
  const auto& program = scenario.programs[index];
  std::vector<Knob> knobs;
  if (program.publish == scenario::Publish::cyclic)
    knobs.push_back(
        {"publish of " + program.name,
         {1},
         [index](Scenario& changed, std::int64_t) { changed.programs[index].publish = scenario::Publish::on_change; },
         [](std::int64_t) { return std::string("on-change"); },
         Price::configured});
  Knob priority{"priority of " + program.name + " at least",
                {},
                [index](Scenario& changed, std::int64_t value) {
                  changed.programs[index].pcp = static_cast<std::uint8_t>(value);
                },
                as_priority,
                Price::reconfigured};
  for (std::int64_t pcp = program.pcp + 1; pcp <= 7; ++pcp) priority.values.push_back(pcp);
  knobs.push_back(std::move(priority));
  knobs.push_back(
      {"cycle of " + program.name + " at most", cycles_below(program.cycle),
       [index](Scenario& changed, std::int64_t value) { changed.programs[index].cycle = Duration::from_ps(value); },
       as_time, Price::reconfigured});
  knobs.push_back({"initialisation of " + program.name + " at most", times_below(program.initialisation),
                   [index](Scenario& changed, std::int64_t value) {
                     changed.programs[index].initialisation = Duration::from_ps(value);
                   },
                   as_time, Price::programmed});
  return knobs;
}

/// Phases of all that is periodic and has none, so chosen that frames meet no others.
Knob phases(const Scenario& scenario) {
  const auto is_free = [](const scenario::Stream& stream) { return stream.every && !stream.offset; };
  Knob knob{"offset of all that is periodic",
            {},
            [is_free](Scenario& changed, std::int64_t) {
              json::OrAuto<Duration> chosen;
              chosen.is_auto = true;
              for (scenario::Stream& stream : changed.streams)
                if (is_free(stream)) stream.offset = chosen;
              for (auto& program : changed.programs)
                if (!program.offset && program.roles.empty()) program.offset = chosen;
            },
            [](std::int64_t) { return std::string("auto"); },
            Price::reconfigured};
  if (std::ranges::any_of(scenario.streams, is_free)) knob.values = {1};
  return knob;
}

/// Frames of the classes below that one are cut for it, at every port.
Knob preemption(const Scenario& scenario, std::uint8_t pcp) {
  Knob knob{"preemption of what is below",
            {},
            [](Scenario& changed, std::int64_t value) {
              scenario::Preemption below;
              for (std::int64_t q = 0; q < value; ++q) below.preemptable.push_back(static_cast<std::uint8_t>(q));
              const auto set = [&](std::vector<scenario::Egress>& ports) {
                if (ports.empty()) ports.emplace_back();
                for (scenario::Egress& port : ports) port.preemption = below;
              };
              for (auto& [name, node] : changed.network.nodes) set(scenario::ports_of(node).egress);
              for (scenario::Generator& generator : changed.network.generate) set(generator.egress);
            },
            as_priority,
            Price::bought};
  const auto has_it = [](const std::vector<scenario::Egress>& ports) {
    return std::ranges::any_of(ports, [](const scenario::Egress& port) { return port.preemption.has_value(); });
  };
  const bool is_there =
      std::ranges::any_of(scenario.network.nodes,
                          [&](const auto& node) { return has_it(scenario::ports_of(node.second).egress); }) ||
      std::ranges::any_of(scenario.network.generate,
                          [&](const scenario::Generator& each) { return has_it(each.egress); });
  if (!is_there && pcp > 0) knob.values = {pcp};
  return knob;
}

/// The priority of the messages that the requirement is about.
std::uint8_t priority_of(const Scenario& scenario, const results::RequirementResult& requirement) {
  for (const scenario::Stream& stream : scenario.streams)
    if (requirement.taken_as != RequirementKind::reaction && stream.name == requirement.subject)
      return stream.pcp.value_or(0);
  for (const auto& program : scenario.programs)
    if (requirement.subject.empty() || program.name == requirement.subject) return program.pcp;
  return 0;
}

std::vector<Knob> knobs_of_network(const Scenario& scenario, const results::RequirementResult& requirement) {
  std::vector<Knob> knobs{phases(scenario)};
  if (scenario.gates && scenario.gates->margin && !scenario.gates->margin->is_auto)
    knobs.push_back({"margin of the gates at most", times_below(scenario.gates->margin->value),
                     [](Scenario& changed, std::int64_t value) {
                       changed.gates->margin = json::OrAuto<Duration>(Duration::from_ps(value));
                     },
                     as_time, Price::reconfigured});
  knobs.push_back(preemption(scenario, priority_of(scenario, requirement)));
  knobs.push_back(link_rate(scenario));
  return knobs;
}

}  // namespace

std::vector<Remedy> remedies_for(const scenario::Resolved& resolved, const RemedyQuestion& question, Budget& budget) {
  const results::RequirementResult& requirement = question.requirement;
  if (!requirement.limit || !requirement.requirement) return {};
  const Scenario& scenario = resolved.scenario;
  std::vector<Knob> knobs;
  if (requirement.taken_as == RequirementKind::reaction) {
    for (std::size_t p = 0; p < scenario.programs.size(); ++p)
      if (requirement.subject.empty() || scenario.programs[p].name == requirement.subject)
        std::ranges::move(knobs_of_program(scenario, p), std::back_inserter(knobs));
    knobs.push_back(load_of_others(scenario, {}));
  } else if (requirement.taken_as == RequirementKind::latency || requirement.taken_as == RequirementKind::jitter) {
    const auto stream = std::ranges::find(scenario.streams, requirement.subject, &scenario::Stream::name);
    if (stream != scenario.streams.end())
      knobs = knobs_of_stream(scenario, static_cast<std::size_t>(stream - scenario.streams.begin()));
    knobs.push_back(load_of_others(scenario, requirement.subject));
  } else {
    return {};
  }
  std::ranges::move(knobs_of_network(scenario, requirement), std::back_inserter(knobs));
  std::ranges::stable_sort(knobs, {}, &Knob::price);
  Workshop workshop(resolved, question, budget);
  std::vector<Remedy> found;
  for (const Knob& knob : knobs) {
    if (budget.is_interrupted() || budget.left() == 0) break;
    if (std::optional<Remedy> remedy = workshop.look(knob)) found.push_back(std::move(*remedy));
  }
  return found;
}

std::vector<WeightyPart> weightiest_parts(const Scenario& run, const results::RequirementResult& requirement,
                                          Duration measured, const std::function<bool()>& interrupted) {
  json::Diagnostics diagnostics;
  const auto resolved = scenario::resolve(run, diagnostics);
  if (!resolved || !requirement.requirement || *requirement.requirement >= resolved->requirements.size()) return {};
  std::map<std::pair<std::string, std::string>, Duration> sums;
  if (requirement.taken_as == RequirementKind::reaction) {
    const auto asked = scenario::reaction_of(resolved->requirements[*requirement.requirement].figure);
    const auto reaction =
        asked ? explain::explain_reaction(*resolved, *asked, sim::TrueTime() + requirement.from, measured, interrupted)
              : std::nullopt;
    if (!reaction) return {};
    for (const explain::ExplainedStep& step : reaction->steps) sums[{step.who, step.what}] += step.takes;
  } else if (requirement.taken_as == RequirementKind::latency) {
    explain::FrameQuestion question{.from = sim::TrueTime() + requirement.from};
    for (std::uint32_t s = 0; s < resolved->plan.streams.size(); ++s)
      if (resolved->plan.streams[s].name == requirement.subject) question.stream = models::StreamIndex{s};
    const std::vector<explain::ExplainedFrame> frames = explain::explain_frame(*resolved, question, interrupted);
    if (frames.empty() || frames.front().takes != measured) return {};  // it is of one that is under way
    for (const explain::ExplainedHop& hop : frames.front().hops)
      for (const explain::ExplainedPart& part : hop.parts)
        sums[{explain::place_of(hop, part), part.words}] += part.takes;
  }
  std::vector<WeightyPart> parts;
  for (const auto& [key, takes] : sums) parts.push_back({key.first, key.second, takes});
  std::ranges::stable_sort(parts, std::ranges::greater(), &WeightyPart::takes);
  constexpr std::size_t most = 3;
  if (parts.size() > most) parts.resize(most);
  return parts;
}

}  // namespace takt::verify
