// SPDX-License-Identifier: Apache-2.0
// Any octets as a scenario: a diagnostic or a sound scenario, never a crash, a hang or a broken CHECK; what is sound
// runs, is reported, and means the same after it has been written out and read again.
//
// The first line, if it begins with "--set ", is an override of the rest. Two kinds of input are left out: streams with
// a trace, since they would open files, and what is sound but large, since it would only be slow.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "evaluation/evaluate.hpp"
#include "json/override.hpp"
#include "output/text_report.hpp"
#include "results/result_json.hpp"
#include "scenario/resolve.hpp"
#include "scenario/run/run.hpp"
#include "scenario/topology/generators.hpp"
#include "sim/check.hpp"

namespace {

using namespace takt;

constexpr std::uint64_t most_generated = 200;  // nodes of one generator
constexpr std::uint32_t most_at_once = 500;    // frames of a burst
constexpr std::uint64_t most_events = 2'000;

bool is_left_out(const scenario::Scenario& scenario) {
  const auto opens_file = [](const scenario::Stream& s) { return s.trace.has_value(); };
  const auto floods = [](const scenario::Stream& s) { return s.burst && s.burst->frames > most_at_once; };
  const auto is_large = [](const scenario::Generator& g) {
    json::Diagnostics ignored;
    scenario::generate(g, most_generated, ignored);
    return ignored.has_errors() && (ignored.kept().front().message == "too many nodes");
  };
  return std::any_of(scenario.streams.begin(), scenario.streams.end(), opens_file) ||
         std::any_of(scenario.streams.begin(), scenario.streams.end(), floods) ||
         std::any_of(scenario.network.generate.begin(), scenario.network.generate.end(), is_large);
}

std::uint64_t digest_of(const scenario::Resolved& resolved) {
  scenario::Run run(resolved);
  const bool is_complete = run.advance(most_events);
  const results::RunResult result = evaluation::evaluate(run, !is_complete);
  json::Diagnostics diagnostics;
  TAKT_CHECK(json::parse(results::run_json(result), "result.json", diagnostics), "a result is valid JSON");
  TAKT_CHECK(!output::run_report(result).empty() && !output::check_report(resolved).empty(), "there is a report");
  return run.simulation().digest().value();
}

void try_sound(const scenario::Resolved& resolved) {
  const std::string copy = json::encode(resolved.scenario);
  json::Diagnostics diagnostics;
  const auto again = scenario::load_text(copy, "copy.json", {}, diagnostics);
  TAKT_CHECK(again, "a resolved copy has no mistakes");
  TAKT_CHECK(again->scenario == resolved.scenario && json::encode(again->scenario) == copy,
             "a resolved copy means the same");
  if (resolved.plan.nodes.size() > 2 * most_generated) return;
  TAKT_CHECK(digest_of(resolved) == digest_of(*again), "a resolved copy runs the same");
}

void try_input(std::string_view text, const std::vector<std::string>& overrides) {
  {
    json::Diagnostics ignored;
    auto document = json::parse(text, "fuzz.json", ignored);
    scenario::Scenario scenario;
    if (document) {
      for (const std::string& option : overrides) json::apply(*document, option, ignored);
      json::decode(*document, scenario, ignored);
    }
    if (is_left_out(scenario)) return;
  }
  json::Diagnostics diagnostics;
  const auto resolved = scenario::load_text(text, "fuzz.json", overrides, diagnostics);
  TAKT_CHECK((resolved != nullptr) != diagnostics.has_errors(),
             "a text that is refused has an error, a sound one has none");
  TAKT_CHECK(diagnostics.to_text().size() <= std::size_t{1} << 22, "what is told to the user is bounded");
  if (resolved) try_sound(*resolved);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string_view text(reinterpret_cast<const char*>(data), size);
  std::vector<std::string> overrides;
  constexpr std::string_view prefix = "--set ";
  if (text.starts_with(prefix)) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    overrides.emplace_back(text.substr(prefix.size(), end - prefix.size()));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  try_input(text, overrides);
  return 0;
}
