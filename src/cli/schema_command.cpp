// takt schema: what the files of takt may say and its outputs hold, as JSON Schema or as a page for people.
#include <fmt/format.h>

#include <array>
#include <cstdio>
#include <memory>

#include "analysis/report_record.hpp"
#include "cli/commands.hpp"
#include "emulate/emulation.hpp"
#include "explain/explanation.hpp"
#include "explore/report/report.hpp"
#include "interchange/schedules/report.hpp"
#include "json/record.hpp"
#include "json/reference.hpp"
#include "node/applications/config.hpp"
#include "node/applications/host.hpp"
#include "node/config.hpp"
#include "node/description.hpp"
#include "node/key_service_node.hpp"
#include "node/node_status.hpp"
#include "results/run_result.hpp"
#include "scenario/description/description.hpp"
#include "study/compare.hpp"
#include "study/description.hpp"
#include "synthesis/change_report.hpp"
#include "synthesis/report.hpp"
#include "verify/report_record.hpp"

namespace takt::cli {

namespace {

/// A kind of file that takt reads, or of output that it writes.
struct FileKind {
  const char* name;
  const char* title;
  json::Node (*schema)(std::string_view title);
  const json::Record* (*record)() = nullptr;   ///< of an output
};

template <class T>
constexpr FileKind read_as(const char* name, const char* title) {
  return {name, title, json::schema_tree<T>};
}
template <class T>
constexpr FileKind written_as(const char* name, const char* title) {
  return {name, title, [](std::string_view words) { return json::record_schema(describe(json::Type<T>{}), words); }, [] { return &describe(json::Type<T>{}); }};
}

constexpr std::array file_kinds{
    read_as<scenario::Scenario>("scenario", "takt scenario"),
    read_as<study::Study>("study", "takt study"),
    read_as<node::Config>("node", "takt node: Programs"),
    read_as<node::ApplicationsConfig>("applications", "takt node: applications"),
    read_as<node::KeyServiceNode>("key-service", "takt node: a key service"),
    written_as<results::RunResult>("result", "takt run: result.json"),
    written_as<analysis::BoundReport>("bound", "takt bound --format json"),
    written_as<verify::Report>("verify", "takt verify --format json"),
    written_as<explain::Explanation>("explain", "takt explain --format json"),
    written_as<explore::Exploration>("explore", "takt explore --format json"),
    written_as<interchange::schedules::ScheduleReport>("schedule", "takt schedule INSTANCE --format json"),
    written_as<synthesis::ScenarioSchedule>("schedule-scenario", "takt schedule SCENARIO --format json"),
    written_as<synthesis::ChangeSummary>("schedule-change", "takt schedule --to SCENARIO --format json"),
    written_as<study::Comparison>("compare", "takt compare --format json"),
    written_as<node::NodeStatus>("status", "takt ctl NODE status --format json"),
    written_as<node::NodeDescription>("describe", "takt node --describe"),
    written_as<node::ApplicationsReport>("statistics", "takt node: statistics of applications"),
    written_as<emulate::Report>("emulate", "takt emulate --format json"),
};

struct Options {
  std::string kind = file_kinds.front().name;
  bool as_reference = false;
};

std::string text_for(const Options& options) {
  const FileKind& kind = *std::ranges::find_if(file_kinds, [&](const FileKind& each) { return each.name == options.kind; });
  if (!options.as_reference) return json::pretty(kind.schema(kind.title));
  if (kind.record != nullptr)
    return json::record_reference(*kind.record(), kind.title,
                                  fmt::format("Made by `takt schema {} --reference` from the tables that the output is written by; `takt schema {}` prints its JSON Schema. Keys that end with "
                                              "`_ps`, and times without another unit, are whole picoseconds.",
                                              kind.name, kind.name));
  return json::reference(kind.schema(kind.title), fmt::format("All keys of such a file. Made by `takt schema {} --reference` from the tables that the loader reads by; every mistake in a file is "
                                           "reported with its place and what was expected, and `takt schema {}` prints the JSON Schema for editors.",
                                           kind.name, kind.name));
}

}  // namespace

void add_schema_command(Command app, ExitStatus& status) {
  const Command command = app.add_subcommand("schema", "Print what files of takt may say and its outputs hold: JSON Schema, or a page for people");
  const auto options = std::make_shared<Options>();
  std::vector<std::string> names;
  for (const FileKind& kind : file_kinds) names.emplace_back(kind.name);
  command.add_option("KIND", options->kind, "The kind of file: scenario, study, node (of Programs) or applications (a node of them); of output: result, bound, verify, explain, explore, schedule (of instances), schedule-scenario, schedule-change (of a scenario), compare, status, describe (of a node), statistics (of a node of applications) or emulate (takt check --format json writes a scenario)").one_of(names);
  command.add_flag("--reference", options->as_reference, "Markdown for people instead: every key with unit, range, default and meaning");
  command.footer("Examples:\n  takt schema > scenarios/takt.schema.json\n  takt schema study > scenarios/studies/takt-study.schema.json\n  takt schema scenario --reference | less");
  command.callback([options, &status] {
    std::fputs(text_for(*options).c_str(), stdout);
    status = ExitStatus::pass;
  });
}

}  // namespace takt::cli
