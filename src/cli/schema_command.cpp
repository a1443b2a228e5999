// takt schema: what the files of takt may say, as JSON Schema for editors or as a page for people.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cstdio>
#include <memory>

#include "cli/commands.hpp"
#include "node/applications/config.hpp"
#include "node/config.hpp"
#include "scenario/description/description.hpp"
#include "scenario/json/reference.hpp"
#include "study/description.hpp"

namespace takt::cli {

namespace {

namespace json = scenario::json;

/// A kind of file that takt reads.
struct FileKind {
  const char* name;
  const char* title;
  json::Node (*schema)(std::string_view title);
};

constexpr std::array file_kinds{
    FileKind{"scenario", "takt scenario", json::schema_tree<scenario::Scenario>},
    FileKind{"study", "takt study", json::schema_tree<study::Study>},
    FileKind{"node", "takt node: Programs", json::schema_tree<node::Config>},
    FileKind{"applications", "takt node: applications", json::schema_tree<node::ApplicationsConfig>},
};

struct Options {
  std::string kind = file_kinds.front().name;
  bool as_reference = false;
};

std::string text_for(const Options& options) {
  const FileKind& kind = *std::ranges::find_if(file_kinds, [&](const FileKind& each) { return each.name == options.kind; });
  const json::Node tree = kind.schema(kind.title);
  if (!options.as_reference) return json::pretty(tree);
  return json::reference(tree, fmt::format("All keys of such a file. Made by `takt schema {} --reference` from the tables that the loader reads by; every mistake in a file is "
                                           "reported with its place and what was expected, and `takt schema {}` prints the JSON Schema for editors.",
                                           kind.name, kind.name));
}

}  // namespace

void add_schema_command(CLI::App& app, ExitStatus& status) {
  CLI::App& command = *app.add_subcommand("schema", "Print what files of takt may say: JSON Schema for editors, or a page for people");
  const auto options = std::make_shared<Options>();
  std::vector<std::string> names;
  for (const FileKind& kind : file_kinds) names.emplace_back(kind.name);
  command.add_option("KIND", options->kind, "The kind of file: scenario, study, node (of Programs) or applications (a node of them)")->check(CLI::IsMember(names));
  command.add_flag("--reference", options->as_reference, "Markdown for people instead: every key with unit, range, default and meaning");
  command.footer("Examples:\n  takt schema > scenarios/takt.schema.json\n  takt schema study > scenarios/studies/takt-study.schema.json\n  takt schema scenario --reference | less");
  command.callback([options, &status] {
    std::fputs(text_for(*options).c_str(), stdout);
    status = ExitStatus::pass;
  });
}

}  // namespace takt::cli
