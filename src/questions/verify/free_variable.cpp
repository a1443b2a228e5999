// SPDX-License-Identifier: Apache-2.0
#include "verify/free_variable.hpp"

#include <algorithm>

#include "json/quantity.hpp"
#include "sim/check.hpp"
#include "verify/free_phases.hpp"

namespace takt::verify {
namespace {

using scenario::Program;
using scenario::Scenario;
using sim::Duration;

void add_calls(const Scenario& scenario, std::vector<FreeVariable>& found) {
  std::vector<Duration> times;
  for (const scenario::ScriptEntry& entry : scenario.script) times.push_back(entry.at);
  std::sort(times.begin(), times.end());
  for (std::size_t i = 0; i < scenario.script.size(); ++i) {
    const scenario::ScriptEntry& entry = scenario.script[i];
    if (!entry.call) continue;
    const auto program = std::find_if(scenario.programs.begin(), scenario.programs.end(),
                                      [&](const Program& p) { return !entry.program || p.name == *entry.program; });
    if (program == scenario.programs.end()) continue;
    const auto next = std::upper_bound(times.begin(), times.end(), entry.at);
    const Duration room = (next == times.end() ? scenario.duration : *next) - entry.at;
    const Duration range = std::min(program->cycle, room);
    if (range > Duration())
      found.push_back({FreeVariable::Kind::call, i, 0, range, "instant of call " + std::to_string(i + 1), {}, {}, {}});
  }
}

/// When the fault is over; nothing for those that are not about links and nodes, or that last to the end.
struct FaultSpan {
  Duration begin;
  Duration end;
};
template <class F>
FaultSpan span_of(const F& fault) {
  if constexpr (requires { fault.lasts; })
    return {fault.at, fault.lasts ? fault.at + *fault.lasts : fault.at};
  else
    return {fault.at, fault.at};
}

Duration longest_period(const Scenario& scenario) {
  Duration longest;
  for (const scenario::Stream& stream : scenario.streams)
    longest = std::max(longest, stream.every.value_or(Duration()));
  for (const Program& program : scenario.programs) longest = std::max(longest, program.cycle);
  return longest;
}

void add_faults(const Scenario& scenario, std::vector<FreeVariable>& found) {
  const Duration longest = longest_period(scenario);
  std::vector<FaultSpan> spans;
  for (const scenario::Fault& fault : scenario.faults)
    spans.push_back(std::visit([](const auto& each) { return span_of(each); }, fault));
  for (std::size_t i = 0; i < scenario.faults.size(); ++i) {
    // A gate that is stuck for longer, or a clock that jumps later, would be another premise of the bounds.
    if (!std::holds_alternative<scenario::LinkDown>(scenario.faults[i]) &&
        !std::holds_alternative<scenario::Crash>(scenario.faults[i]))
      continue;
    Duration next = scenario.duration;
    for (std::size_t other = 0; other < spans.size(); ++other)
      if (other != i && spans[other].end >= spans[i].begin) next = std::min(next, spans[other].begin);
    const Duration range = std::min(longest, next - spans[i].end);
    if (range > Duration())
      found.push_back(
          {FreeVariable::Kind::fault, i, 0, range, "instant of fault " + std::to_string(i + 1), {}, {}, {}});
  }
}

void add_jitters(const Scenario& scenario, std::vector<FreeVariable>& found) {
  for (std::size_t s = 0; s < scenario.streams.size(); ++s)
    if (const scenario::Stream& stream = scenario.streams[s]; stream.every && stream.jitter > Duration())
      found.push_back({FreeVariable::Kind::jitter,
                       s,
                       0,
                       stream.jitter + Duration::from_ps(1),
                       "jitter of " + stream.name,
                       {},
                       {},
                       {}});
}

void add_losses(const Scenario& scenario, std::vector<FreeVariable>& found) {
  for (std::size_t i = 0; i < scenario.faults.size(); ++i) {
    const auto* const errors = std::get_if<scenario::FrameErrors>(&scenario.faults[i]);
    const bool is_chance =
        errors != nullptr && (errors->burst_loss || (errors->loss && *errors->loss > 0 && *errors->loss < 1));
    if (!is_chance || errors->at >= scenario.duration || longest_period(scenario) == Duration()) continue;
    const Duration range = std::min(errors->lasts.value_or(scenario.duration), scenario.duration - errors->at);
    if (range > Duration())
      found.push_back(
          {FreeVariable::Kind::losses, i, 0, range, "losses by fault " + std::to_string(i + 1), {}, {}, {}});
  }
}

void lose_in_one_stretch(Scenario& made, std::size_t item, Duration later) {
  auto& errors = std::get<scenario::FrameErrors>(made.faults[item]);
  scenario::FrameErrors rest = errors;
  rest.loss.reset();
  rest.burst_loss.reset();
  const Duration end = errors.at + std::min(errors.lasts.value_or(made.duration), made.duration);
  errors.burst_loss.reset();
  errors.loss = 1;
  errors.corruption.reset();
  errors.bit_error_rate.reset();
  errors.duplication.reset();
  errors.at += later;
  errors.lasts = std::min(longest_period(made), end - errors.at);
  if (rest.corruption || rest.bit_error_rate || rest.duplication) made.faults.emplace_back(std::move(rest));
}

/// What the scenario says of the node's clock, if it gives a range of frequencies.
const scenario::Clock* ranging_clock(const Scenario& scenario, const std::string& node) {
  const scenario::Clocks& clocks = scenario.clocks;
  const auto own =
      std::find_if(clocks.nodes.begin(), clocks.nodes.end(), [&](const auto& each) { return each.first == node; });
  const scenario::Clock* const clock = own != clocks.nodes.end() ? &own->second : clocks.all ? &*clocks.all : nullptr;
  return clock != nullptr && !clock->ideal && clock->offset.from && clock->offset.to &&
                 *clock->offset.from != *clock->offset.to
             ? clock
             : nullptr;
}

void add_frequencies(const scenario::Resolved& r, std::vector<FreeVariable>& found) {
  for (const models::NodePlan& node : r.plan.nodes) {
    const scenario::Clock* const clock = ranging_clock(r.scenario, node.name);
    if (clock == nullptr) continue;
    found.push_back({FreeVariable::Kind::frequency,
                     0,
                     0,
                     always_greatest + Duration::from_ps(1),
                     "frequency of " + node.name + ", " + json::to_text(*clock->offset.from) + " to " +
                         json::to_text(*clock->offset.to),
                     {},
                     {},
                     {},
                     node.name});
  }
}

void set_frequency(Scenario& made, const std::string& node, Duration value) {
  scenario::Clock clock = *ranging_clock(made, node);
  clock.offset.fixed = value == always_least ? clock.offset.from : clock.offset.to;
  clock.offset.from.reset();
  clock.offset.to.reset();
  const auto own = std::find_if(made.clocks.nodes.begin(), made.clocks.nodes.end(),
                                [&](const auto& each) { return each.first == node; });
  if (own != made.clocks.nodes.end())
    own->second = std::move(clock);
  else
    made.clocks.nodes.emplace_back(node, std::move(clock));
}

/// What has no ceiling worth the name is left to chance: no bound is claimed there, and a frame for ever under way
/// shows nothing.
constexpr Duration longest_latency = Duration::from_ps(10'000'000'000'000);

constexpr std::pair<FreeVariable::Latency, const char*> latencies[] = {
    {FreeVariable::Latency::transmit, "transmit latency"},
    {FreeVariable::Latency::receive, "receive latency"},
    {FreeVariable::Latency::wake_up, "wake-up latency"}};

void add_latencies(const models::OsLatency& os, FreeVariable::Kind kind, std::size_t item, const std::string& whose,
                   std::vector<FreeVariable>& found) {
  for (const auto& [latency, name] : latencies) {
    const sim::Distribution& distribution = latency == FreeVariable::Latency::transmit  ? os.transmit
                                            : latency == FreeVariable::Latency::receive ? os.receive
                                                                                        : os.wake_up;
    if (distribution.least() == distribution.greatest() || distribution.greatest() > longest_latency) continue;
    found.push_back({kind, item, 0, either_end + Duration::from_ps(1), std::string(name) + " of " + whose, latency,
                     distribution.least(), distribution.greatest()});
  }
}

void add_latencies(const scenario::Resolved& r, std::vector<FreeVariable>& found) {
  const auto& nodes = r.scenario.network.nodes;
  for (std::size_t n = 0; n < nodes.size(); ++n)
    if (const auto node = r.topology.find(nodes[n].first); node && scenario::end_station_of(nodes[n].second) != nullptr)
      add_latencies(r.plan.os_latencies[r.plan.nodes[*node].os_latency], FreeVariable::Kind::host_latency, n,
                    nodes[n].first, found);
  const auto& generate = r.scenario.network.generate;
  for (std::size_t g = 0; g < generate.size(); ++g) {
    // Any host of it stands for all.
    const auto host =
        std::find_if(r.topology.nodes.begin(), r.topology.nodes.end(), [&](const scenario::TopologyNode& node) {
          const scenario::EndStation* const description = scenario::end_station_of(node.description);
          const bool is_listed =
              std::any_of(nodes.begin(), nodes.end(), [&](const auto& listed) { return listed.first == node.name; });
          return description != nullptr && !is_listed && description->os == generate[g].os;
        });
    if (host != r.topology.nodes.end())
      add_latencies(
          r.plan.os_latencies[r.plan.nodes[static_cast<std::size_t>(host - r.topology.nodes.begin())].os_latency],
          FreeVariable::Kind::generator_latency, g, "the hosts of generator " + std::to_string(g + 1), found);
  }
}

void fix(scenario::OperatingSystem& os, const FreeVariable& variable, Duration value) {
  scenario::Latency fixed;
  if (value == either_end)
    fixed.table = {{variable.least, 1}, {variable.greatest, 1}};
  else
    fixed.fixed = value == always_least ? variable.least : variable.greatest;
  (variable.latency == FreeVariable::Latency::transmit  ? os.transmit
   : variable.latency == FreeVariable::Latency::receive ? os.receive
                                                        : os.wake_up) = fixed;
}

}  // namespace

std::vector<FreeVariable> free_variables_of(const scenario::Resolved& resolved) {
  std::vector<FreeVariable> found;
  add_free_publishers(resolved.scenario, found);
  add_calls(resolved.scenario, found);
  add_free_talkers(resolved.scenario, found);
  add_faults(resolved.scenario, found);
  add_latencies(resolved, found);
  add_jitters(resolved.scenario, found);
  add_losses(resolved.scenario, found);
  add_frequencies(resolved, found);
  return found;
}

Scenario scenario_of(const Scenario& scenario, std::span<const FreeVariable> variables, const Choice& choice) {
  TAKT_CHECK(variables.size() == choice.values.size(), "a value for each variable");
  Scenario made = scenario;
  made.seed = choice.seed;
  for (std::size_t i = 0; i < variables.size(); ++i) {
    const FreeVariable& variable = variables[i];
    const Duration value = choice.values[i];
    TAKT_CHECK(value >= Duration() && value < variable.range, "a value within its range");
    if (value == Duration()) continue;
    switch (variable.kind) {
      case FreeVariable::Kind::talker:
        made.streams[variable.item].offset = value;
        break;
      case FreeVariable::Kind::publisher:
        made.programs[variable.item].phases.emplace_back(
            participant_name(made.programs[variable.item], variable.participant), value);
        break;
      case FreeVariable::Kind::call:
        made.script[variable.item].at += value;
        break;
      case FreeVariable::Kind::fault:
        std::visit([&](auto& fault) { fault.at += value; }, made.faults[variable.item]);
        break;
      case FreeVariable::Kind::host_latency:
        fix(scenario::end_station_of(made.network.nodes[variable.item].second)->os, variable, value);
        break;
      case FreeVariable::Kind::generator_latency:
        fix(made.network.generate[variable.item].os, variable, value);
        break;
      case FreeVariable::Kind::jitter:
        made.streams[variable.item].offset = made.streams[variable.item].offset.value_or(Duration()) + value;
        made.streams[variable.item].jitter = Duration();
        break;
      case FreeVariable::Kind::losses:
        lose_in_one_stretch(made, variable.item, value);
        break;
      case FreeVariable::Kind::frequency:
        set_frequency(made, variable.node, value);
        break;
    }
  }
  return made;
}

}  // namespace takt::verify
