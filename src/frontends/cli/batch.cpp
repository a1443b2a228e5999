// SPDX-License-Identifier: Apache-2.0
#include "cli/batch.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <set>

#include "cli/input_kind.hpp"
#include "cli/places.hpp"
#include "cli/terminal.hpp"
#include "json/printable.hpp"
#include "json/suggest.hpp"
#include "scenario/figures/requirement.hpp"

namespace takt::cli {
namespace {

/// Each * stands for any text, an empty one too.
bool matches(std::string_view pattern, std::string_view text) {
  const std::size_t star = pattern.find('*');
  if (star == std::string_view::npos) return pattern == text;
  if (!text.starts_with(pattern.substr(0, star))) return false;
  const std::string_view rest = pattern.substr(star + 1);
  text.remove_prefix(star);
  for (std::size_t skipped = 0; skipped <= text.size(); ++skipped)
    if (matches(rest, text.substr(skipped))) return true;
  return false;
}

std::string stem_of(const std::string& file) { return std::filesystem::path(file).stem().string(); }

/// What the call itself has wrong, before any file is read.
void check_call(const BatchOptions& options, json::Diagnostics& diagnostics) {
  const auto mistake = [&](const char* where, const char* what, const std::string& found, const char* expected) {
    diagnostics.error({where, 0, 0, ""}, what, {found, expected});
  };
  std::set<std::string> files, stems;
  for (const std::string& file : options.files) {
    if (!files.insert(file).second)
      mistake("command line", "a scenario twice", json::quote(file), "each file once");
    else if (!stems.insert(stem_of(file)).second && !options.out.empty())
      mistake("--out", "two scenarios with one folder", json::quote(stem_of(file)), "files with different names");
  }
  if (!options.is_single() && !options.report.empty())
    mistake("--report", "one page for several scenarios", std::to_string(options.files.size()) + " scenarios",
            "a call for each page");
}

/// Which lines each of the scenarios has to judge. A word that none of them knows is a mistake.
void choose(const std::vector<std::string>& only, std::vector<LoadedScenario>& all, json::Diagnostics& diagnostics) {
  std::vector<std::vector<scenario::RequirementLine>> lines;
  std::vector<std::string_view> known;
  for (LoadedScenario& each : all) {
    lines.push_back(scenario::requirement_lines(*each.resolved));
    each.asked.assign(lines.back().size(), only.empty());
  }
  for (const auto& of_one : lines)
    for (const scenario::RequirementLine& line : of_one) known.emplace_back(line.name.empty() ? line.text : line.name);
  for (const std::string& word : only) {
    bool is_known = false;
    for (std::size_t s = 0; s < all.size(); ++s)
      for (std::size_t i = 0; i < lines[s].size(); ++i)
        if (is_meant(word, lines[s][i].name, lines[s][i].text)) is_known = all[s].asked[i] = true;
    if (!is_known)
      diagnostics.error({"--only", 0, 0, ""}, "unknown requirement",
                        {json::quote(word), "the name or the spelling of a requirement, with * for any text",
                         json::suggest(word, known)});
  }
}

/// Refusals of several files as one list.
void refuse(const std::vector<json::Diagnostics>& refused, bool is_json) {
  if (!is_json) {
    for (const json::Diagnostics& each : refused) tell(each);
    return;
  }
  json::Diagnostics all;
  for (const json::Diagnostics& each : refused)
    for (const json::Diagnostic& one : each.kept())
      one.severity == json::Severity::error ? all.error(one.place, one.message, one.details)
                                            : all.warning(one.place, one.message, one.details);
  std::fputs(json::pretty(all.to_json()).c_str(), stdout);
}

}  // namespace

bool is_meant(std::string_view word, std::string_view name, std::string_view text) {
  return (!name.empty() && (word == name || matches(word, name))) || word == text || matches(word, text);
}

void add_batch_options(Command command, BatchOptions& options) {
  command.add_option("SCENARIO", options.files, "Scenario files (JSON, comments allowed); one after the other")
      .required();
  add_scenario_changes(command, options.scenario);
  command
      .add_option("--only", options.only,
                  "Judge these requirements alone, by name or spelling; * stands for any text (repeatable)")
      .type_name("NAME")
      .one_value_each();
  command
      .add_option("--junit", options.junit,
                  "Write the verdicts into this file as JUnit XML, a test case a requirement; undecided is skipped")
      .type_name("FILE.xml");
}

std::optional<std::vector<LoadedScenario>> load_all(const BatchOptions& options) {
  const bool is_json = options.scenario.is_json();
  std::vector<json::Diagnostics> refused(1);
  check_call(options, refused.front());
  if (refused.front().has_errors()) {
    refuse(refused, is_json);
    return std::nullopt;
  }
  if (!can_write({{"--out", options.out, Place::Kind::folder},
                  {"--report", options.report, Place::Kind::file},
                  {"--junit", options.junit, Place::Kind::file}},
                 is_json))
    return std::nullopt;
  refused.clear();
  std::vector<LoadedScenario> all;
  for (const std::string& file : options.files) {
    ScenarioOptions one = options.scenario;
    one.file = file;
    json::Diagnostics diagnostics;
    LoadedScenario loaded{file, options.out, load(one, diagnostics), {}};
    if (!loaded.resolved)
      refused.push_back(std::move(diagnostics));
    else if (!options.quiet)
      tell(diagnostics);
    warn_of_another_maker(file);
    if (!options.is_single() && !options.out.empty())
      loaded.out = (std::filesystem::path(options.out) / json::file_name(stem_of(file))).string();
    all.push_back(std::move(loaded));
  }
  if (refused.empty()) {
    json::Diagnostics diagnostics;
    choose(options.only, all, diagnostics);
    if (diagnostics.has_errors()) refused.push_back(std::move(diagnostics));
  }
  if (!refused.empty()) {
    refuse(refused, is_json);
    return std::nullopt;
  }
  if (options.only.empty()) return all;
  std::erase_if(all, [&](const LoadedScenario& each) {
    const bool is_left_out = std::ranges::find(each.asked, true) == each.asked.end();
    if (is_left_out)
      std::fprintf(stderr, "takt: %s is left out: none of its requirements is asked for\n",
                   json::printable(each.file).c_str());
    return is_left_out;
  });
  return all;
}

std::string joined_json(const std::vector<std::string>& pages, bool is_single) {
  if (is_single) return pages.empty() ? "" : pages.front();
  std::string all = "[\n";
  for (std::size_t i = 0; i < pages.size(); ++i) {
    std::string_view page = pages[i];
    if (page.ends_with('\n')) page.remove_suffix(1);
    all.append(page).append(i + 1 < pages.size() ? ",\n" : "\n");
  }
  return all + "]\n";
}

}  // namespace takt::cli
