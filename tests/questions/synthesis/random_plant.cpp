// SPDX-License-Identifier: Apache-2.0
#include "random_plant.hpp"

#include <gtest/gtest.h>

#include <set>
#include <vector>

#include "json/document.hpp"
#include "json/fields.hpp"
#include "sim/random.hpp"

namespace takt::synthesis::test {
namespace {

/// A ring, perhaps with a chord, and one host more at the first switch.
std::string network(std::uint64_t switches, bool has_chord, const std::string& limits) {
  std::string text = R"({"generate": [{"topology": "ring", "switches": )" + std::to_string(switches) +
                     R"(, "forwarding_delay": "1us")" + limits +
                     R"(}], "nodes": {"x": {"kind": "host"}}, "links": [{"ends": ["x", "sw1"]})";
  if (has_chord) text += R"(, {"ends": ["sw1", "sw3"]})";
  return text + "]}";
}

/// `is_dense`: long frames of one period, for which there is hardly room.
std::string stream(sim::RandomStream& random, const std::string& name, std::uint64_t switches, bool is_dense) {
  const auto host = [&] {
    const std::uint64_t which = random.below(switches + 1);
    return which == switches ? std::string("x") : "h" + std::to_string(which + 1);
  };
  const std::string from = host();
  std::string to = host();
  while (to == from) to = host();
  constexpr const char* payloads[] = {"18B", "100B", "400B", "1000B", "1400B"};
  constexpr const char* periods[] = {"100us", "200us", "250us", "500us", "1ms"};
  return R"({"name": ")" + name + R"(", "from": ")" + from + R"(", "to": ")" + to + R"(", "payload": ")" +
         payloads[is_dense ? 2 + random.below(3) : random.below(5)] + R"(", "every": ")" +
         periods[is_dense ? 0 : random.below(5)] + R"(", "offset": "auto")" +
         (random.below(6) == 0 ? R"(, "jitter": "3us")" : "") + R"(, "pcp": )" + (random.below(4) == 0 ? "5" : "6") +
         "}";
}

}  // namespace

scenario::Scenario scenario_of(const std::string& text) {
  json::Diagnostics diagnostics;
  scenario::Scenario made;
  const auto document = json::parse(text, "plant.json", diagnostics);
  EXPECT_TRUE(document && json::decode(*document, made, diagnostics)) << diagnostics.to_text();
  return made;
}

scenario::Scenario scheduled(const scenario::Scenario& wanted) {
  json::Diagnostics diagnostics;
  ScenarioOptions options;
  options.search.attempts = 4;
  const auto answer = schedule_scenario(wanted, options, diagnostics);
  EXPECT_TRUE(answer && answer->resolved) << diagnostics.to_text() << (answer ? answer->how : "");
  // As a file has it.
  return answer && answer->resolved ? scenario_of(json::encode(answer->resolved->scenario)) : wanted;
}

std::optional<RandomPlant> random_plant(std::uint64_t seed) {
  sim::RandomStream random(seed, "plant", "transition");
  const bool is_dense = random.below(3) == 0;
  const std::uint64_t switches = is_dense ? 3 : 3 + random.below(4);
  const std::uint64_t streams = is_dense ? 12 + random.below(16) : 2 + random.below(14);
  constexpr const char* limits[] = {"", "", "", R"(, "gate_limits": {"entries": 16})",
                                    R"(, "gate_limits": {"least_interval": "500ns", "granularity": "10ns"})"};
  std::string text = R"({"name": "random", "duration": "10ms", "network": )" +
                     network(switches, switches > 3 && random.below(2) == 0, limits[random.below(5)]) +
                     R"(, "gates": {"plan": "auto", "classes": [5, 6])" +
                     (random.below(3) == 0 ? R"(, "guard": "longest-frame")" : "") + R"(}, "streams": [)";
  for (std::uint64_t s = 0; s < streams; ++s)
    text += (s == 0 ? "" : ", ") + stream(random, "s" + std::to_string(s), switches, is_dense);
  text += "]";
  if (random.below(4) == 0)
    text +=
        R"(, "programs": [{"name": "p", "master": "h1", "slaves": ["h2"], "cycle": "500us", "offset": "auto", "process_data": [{"name": "d", "from": "h1", "fields": {"q": {"type": "Double", "count": 6}}}]}],
 "script": [{"at": "1ms", "program": "p", "call": "Start"}])";
  RandomPlant made;
  made.wanted = scenario_of(text + "}");
  json::Diagnostics diagnostics;
  ScenarioOptions options;
  options.search.attempts = 4;
  const auto answer = schedule_scenario(made.wanted, options, diagnostics);
  if (!answer || !answer->resolved) return std::nullopt;
  made.running = scenario_of(json::encode(answer->resolved->scenario));
  AskedChanges& asked = made.asked;
  asked.lead = sim::Duration::from_ps(static_cast<std::int64_t>(1 + random.below(3)) * 1'000'000'000);
  std::string coming = R"({"streams": [)";
  const std::uint64_t come = random.below(3);
  for (std::uint64_t s = 0; s < come; ++s)
    coming += (s == 0 ? "" : ", ") + stream(random, "new" + std::to_string(s), switches, is_dense);
  if (come > 0) {
    ComingStreams read;
    const auto document = json::parse(coming + "]}", "coming.json", diagnostics);
    EXPECT_TRUE(document && json::decode(*document, read, diagnostics)) << diagnostics.to_text();
    asked.add = read.streams;
  }
  if (random.below(2) == 0) {
    std::set<std::string> gone;
    for (std::uint64_t s = random.below(std::min<std::uint64_t>(streams, 3)); s > 0; --s)
      gone.insert("s" + std::to_string(random.below(streams)));
    asked.remove.assign(gone.begin(), gone.end());
  }
  if (random.below(2) == 0) {
    const std::uint64_t first = 1 + random.below(switches), next = first % switches + 1;
    asked.fail.push_back("sw" + std::to_string(first) + ">sw" + std::to_string(next));
  }
  if (asked.add.empty() && asked.remove.empty() && asked.fail.empty()) asked.remove.push_back("s0");
  return made;
}

}  // namespace takt::synthesis::test
