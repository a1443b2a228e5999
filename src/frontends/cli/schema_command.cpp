// SPDX-License-Identifier: Apache-2.0
// takt schema: what the files of takt may say and its outputs hold, as JSON Schema or as a page for people.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>

#include "cli/commands.hpp"
#include "cli/companion.hpp"
#include "cli/file_kinds.hpp"

namespace takt::cli {

namespace {

struct Options {
  std::string kind = "scenario";
  bool as_reference = false;
};

std::string text_for(const FileKind& kind, bool as_reference) {
  if (!as_reference) return json::pretty(kind.schema(kind.title));
  if (kind.record != nullptr)
    return json::record_reference(*kind.record(), kind.title,
                                  fmt::format("Made by `takt schema {} --reference` from the tables that the output is "
                                              "written by; `takt schema {}` prints its JSON Schema. Keys that end with "
                                              "`_ps`, and times without another unit, are whole picoseconds.",
                                              kind.name, kind.name));
  return json::reference(
      kind.schema(kind.title),
      fmt::format(
          "All keys of such a file. Made by `takt schema {} --reference` from the tables that the loader reads by; "
          "every mistake in a file is "
          "reported with its place and what was expected, and `takt schema {}` prints the JSON Schema for editors.",
          kind.name, kind.name));
}

}  // namespace

void add_schema_command(Command app, ExitStatus& status, std::span<const FileKind> kinds) {
  const Command command = app.add_subcommand(
      "schema", "Print what files of takt may say and its outputs hold: JSON Schema, or a page for people");
  const auto options = std::make_shared<Options>();
  std::vector<std::string> names;
  for (const FileKind& kind : kinds) names.emplace_back(kind.name);
  for (const char* const name : companion_kinds)
    if (std::ranges::find(names, name) == names.end()) names.emplace_back(name);
  command
      .add_option(
          "KIND", options->kind,
          "The kind of file: scenario, device, study, node (of Programs) or applications (a node of them); of output: "
          "result, profile, bound, verify, explain, explore, schedule (of instances), schedule-scenario, "
          "schedule-change (of a scenario), compare, status, describe (of a node), statistics (of a node of "
          "applications) or emulate (takt check --format json writes a scenario)")
      .one_of(names);
  command.add_flag("--reference", options->as_reference,
                   "Markdown for people instead: every key with unit, range, default and meaning");
  command.footer(
      "Examples:\n  takt schema > scenarios/takt.schema.json\n  takt schema study > "
      "scenarios/studies/takt-study.schema.json\n  takt schema scenario --reference | less");
  command.callback([options, kinds, &status] {
    const auto kind = std::ranges::find_if(kinds, [&](const FileKind& each) { return each.name == options->kind; });
    if (kind == kinds.end()) {
      std::vector<std::string> words = {"takt", "schema", options->kind};
      if (options->as_reference) words.emplace_back("--reference");
      status = become("takt-schema", std::move(words));
      return;
    }
    std::fputs(text_for(*kind, options->as_reference).c_str(), stdout);
    status = ExitStatus::pass;
  });
}

}  // namespace takt::cli
