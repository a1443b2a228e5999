// SPDX-License-Identifier: Apache-2.0
#include "verify/shortened.hpp"

#include <algorithm>
#include <numeric>
#include <optional>
#include <variant>
#include <vector>

#include "plant/protocol.hpp"
#include "scenario/description/promises.hpp"

namespace takt::verify {
namespace {

using scenario::Scenario;
using sim::Duration;

bool is_over_at_known_times(const scenario::Fault& fault) {
  return std::holds_alternative<scenario::LinkDown>(fault) || std::holds_alternative<scenario::Crash>(fault);
}

bool depends_on_its_times(const Scenario& scenario) {
  const scenario::Clocks& clocks = scenario.clocks;
  if (clocks.gptp || clocks.all || !clocks.nodes.empty() || scenario.rerouting) return true;
  if (!scenario.applications.empty() || !scenario.gateways.empty() || !scenario.persistence.empty()) return true;
  if (!std::ranges::all_of(scenario.faults, is_over_at_known_times)) return true;
  if (std::any_of(scenario.require.begin(), scenario.require.end(), [&](const scenario::Requirement& each) {
        return each.after.value_or(scenario.warm_up) > Duration();
      }))
    return true;
  if (std::any_of(scenario.script.begin(), scenario.script.end(),
                  [](const scenario::ScriptEntry& entry) { return !entry.call; }))
    return true;
  return std::any_of(scenario.streams.begin(), scenario.streams.end(), [](const scenario::Stream& stream) {
    return stream.trace.has_value() || stream.until.has_value() || stream.redundancy.has_value();
  });
}

Duration period_of(const scenario::Stream& stream) {
  return stream.every ? *stream.every : stream.burst ? stream.burst->every : Duration();
}

/// After which cycles of Programs and what is periodic meet again; of streams those alone whose phase is promised, or
/// all. Nothing if that is more than the whole scenario.
std::optional<Duration> common_period(const Scenario& scenario, bool of_all) {
  sim::int128 all = 1;
  const auto add = [&](Duration period) {
    if (period > Duration()) all = all / std::gcd(static_cast<std::int64_t>(all), period.ps()) * period.ps();
    return all <= scenario.duration.ps();
  };
  for (const scenario::Program& program : scenario.programs)
    if (!add(program.cycle)) return std::nullopt;
  for (const scenario::Stream& stream : scenario.streams)
    if ((of_all || scenario::promises_phase(stream)) && !add(period_of(stream))) return std::nullopt;
  return all > 1 ? std::optional(Duration::from_ps(static_cast<std::int64_t>(all))) : std::nullopt;
}

/// What may be left out of a pause: whole periods, so that what comes after it keeps its phase.
Duration to_skip(Duration pause, Duration enough, Duration period) {
  if (pause <= enough || period <= Duration()) return {};
  return period * ((pause - enough).ps() / period.ps());
}

/// Something that happens at a known time.
struct Event {
  Duration at;
  Duration* moved = nullptr;  // in the scenario that is made
  Duration lasts;             // what happens until then is not left out
};

/// `events` are those of `made`.
void bring_together(Scenario& made, std::vector<Event> events, Duration enough, Duration period) {
  std::stable_sort(events.begin(), events.end(), [](const Event& a, const Event& b) { return a.at < b.at; });
  Duration before;
  Duration skipped;
  for (const Event& event : events) {
    skipped += to_skip(event.at - before, enough, period);
    before = std::max(before, event.at + event.lasts);
    *event.moved = event.at - skipped;
  }
  skipped += to_skip(made.duration - before, enough, period);
  made.duration = made.duration - skipped;
}

/// Streams alone: all of it repeats.
Scenario of_streams(const Scenario& scenario) {
  const std::optional<Duration> period = common_period(scenario, true);
  if (!period) return scenario;
  Duration longest;
  Duration latest;
  for (const scenario::Stream& stream : scenario.streams) {
    longest = std::max(longest, period_of(stream));
    latest = std::max<Duration>(latest, stream.offset ? Duration(*stream.offset) : Duration());
    if (period_of(stream) == Duration() || stream.jitter > Duration()) return scenario;
  }
  Scenario made = scenario;
  made.duration = std::min(scenario.duration, latest + std::max(*period * 2, longest * 20));
  return made;
}

}  // namespace

Scenario shortened(const Scenario& scenario, Duration longest_reaction, Pauses pauses) {
  if (depends_on_its_times(scenario)) return scenario;
  if (scenario.programs.empty() && scenario.script.empty() && scenario.faults.empty()) return of_streams(scenario);
  const std::optional<Duration> period = common_period(scenario, false);
  if (scenario.programs.empty() || !period) return scenario;
  const std::int64_t cycles = pauses == Pauses::ample ? 40 : 8;
  Duration enough = longest_reaction;
  for (const scenario::Program& program : scenario.programs) {
    const Duration needed = program.initialisation * 2 + plant::receive_timeout_of(program);
    enough = std::max(enough, pauses == Pauses::ample ? program.cycle * cycles + needed
                                                      : longest_reaction + program.cycle * cycles + needed);
  }
  for (const scenario::Stream& stream : scenario.streams) {
    if (stream.offset) enough = std::max<Duration>(enough, *stream.offset);
    enough = std::max(enough, period_of(stream) * 2);
  }
  Scenario made = scenario;
  std::vector<Event> events;
  for (scenario::ScriptEntry& entry : made.script) events.push_back({entry.at, &entry.at, {}});
  for (scenario::Fault& fault : made.faults)
    std::visit(
        [&](auto& each) {
          if constexpr (requires {
                          each.lasts;
                          each.at;
                        })
            events.push_back({each.at, &each.at, each.lasts.value_or(Duration())});
        },
        fault);
  bring_together(made, std::move(events), enough, *period);
  return made;
}

}  // namespace takt::verify
