// SPDX-License-Identifier: Apache-2.0
// The formats of planners: the files are read as takt schedule reads them, and become a scenario.
#include <fmt/format.h>

#include <algorithm>

#include "interchange/device_import.hpp"
#include "interchange/planning/planning.hpp"
#include "schedule_instances/instances.hpp"
#include "schedule_instances/solutions.hpp"
#include "json/fields.hpp"
#include "json/quantity.hpp"
#include "schedule/gate_lists.hpp"
#include "schedule_check/instance_check.hpp"

namespace takt::interchange {
namespace {

using schedule_instances::Content;

constexpr SettingInfo gates_setting{
    "gates", "none|auto", "none",
    "auto: takt chooses the offsets and lays out gates, as the planner would be asked to"};
constexpr SettingInfo planning_settings[] = {gates_setting};
constexpr SettingInfo applications_settings[] = {
    gates_setting,
    {"rate", "a rate such as 1Gbps", "1Gbps", "of all links: the files do not say"},
    {"hyperperiod", "a duration such as 500us", "500us",
     "to which the frequency of a time-triggered application refers: the files do not say"},
    {"avb", "off|on", "off", "applications of AVB, too: a burst each 125us (class A) or 250us (class B)"},
};

struct Family {
  const char* what;  ///< in words
  std::vector<Content> contents;
  const char* files;
  bool has_classes = true;  ///< the files say the class of each stream
};

/// The files that are instances; what does not belong to the format is told.
std::vector<schedule_instances::TextFile> instance_files(const ImportRequest& request, const Family& family,
                                                json::Diagnostics& diagnostics, std::vector<const InputFile*>& others) {
  std::vector<schedule_instances::TextFile> files;
  for (const InputFile& each : request.files) {
    schedule_instances::TextFile file{each.name, each.text};
    const Content content = is_names_file(each) ? Content::other : schedule_instances::content_of(file);
    if (std::ranges::find(family.contents, content) != family.contents.end())
      files.push_back(std::move(file));
    else
      others.push_back(&each);
  }
  if (files.empty() && !others.empty() && !is_names_file(*others.front())) {
    // A text that is not even JSON or XML says why.
    schedule_instances::InstanceReader reader(std::vector<schedule_instances::TextFile>{{others.front()->name, others.front()->text}});
    if (schedule_instances::content_of({others.front()->name, others.front()->text}) == Content::other) reader.next(diagnostics);
  }
  return files;
}

Imported import_instance(const ImportRequest& request, const Family& family, json::Diagnostics& diagnostics,
                         schedule_instances::GraphmlAssumptions assumptions = {}) {
  Imported imported;
  std::vector<const InputFile*> others;
  auto files = instance_files(request, family, diagnostics, others);
  std::optional<PlanningExtras> extras;
  std::vector<json::Document> documents;  // extras and solutions point into them
  std::optional<json::Document> solution_document;
  for (const InputFile* const other : others) {
    if (is_names_file(*other)) {
      if (const auto document = json::parse(other->text, other->name, diagnostics)) {
        json::decode(*document, extras.emplace(), diagnostics);
        documents.push_back(*document);
      }
      continue;
    }
    json::Diagnostics unheard;
    auto document =
        family.contents.front() == Content::neutral ? json::parse(other->text, other->name, unheard) : std::nullopt;
    const json::Node* const format =
        document && document->root().kind == json::Kind::object ? document->root().find("format") : nullptr;
    if (format != nullptr && format->text == "schedule-solution-1" && !solution_document)
      solution_document = std::move(document);
    else
      diagnostics.error_unless(diagnostics.has_errors(), {other->name, 1, 1, ""}, std::string("not of ") + family.what,
                               {"something else", family.files});
  }
  if (files.empty())
    diagnostics.error_unless(diagnostics.has_errors(),
                             {request.files.empty() ? "command line" : request.files.front().name, 1, 1, ""},
                             "no instance", {"none", family.files});
  if (diagnostics.has_errors()) return imported;
  // A neutral problem of takt's has these beside it in the same file.
  if (family.contents.front() == Content::neutral)
    if (const auto document = json::parse(files.front().text, files.front().name, diagnostics);
        document && document->root().find("takt") != nullptr) {
      json::Reader reader(*document, diagnostics);
      json::decode_value(*document->root().find("takt"), extras.emplace(), reader);
      documents.push_back(*document);
    }
  schedule_instances::InstanceReader reader(std::move(files), assumptions);
  const auto instance = reader.next_instance(diagnostics);
  if (!instance) {
    diagnostics.error_unless(diagnostics.has_errors(), {request.files.front().name, 1, 1, ""},
                             "a network without streams", {"no streams beside it", family.files});
    return imported;
  }
  if (!reader.is_at_end())
    diagnostics.error(instance->places.whole, "several instances",
                      {"more than one", "one instance: it becomes one scenario"});
  std::optional<schedule::Solution> solution;
  if (solution_document) {
    solution = schedule_instances::read_solution(*solution_document, instance->problem, diagnostics);
    // Whoever wrote it: what is no schedule of the problem is refused, in the words of the checker.
    if (!diagnostics.has_errors())
      if (const auto wrong = schedule_check::check(instance->problem, *solution); !wrong.empty())
        diagnostics.error({solution_document->file_name(), 1, 1, ""}, "no schedule of the problem",
                          {wrong.front(), "what takt schedule --out writes for it"});
    if (!diagnostics.has_errors()) {
      const auto no_lists = schedule::make_gate_lists(instance->problem, *solution, {});
      if (no_lists)
        imported.remark(RemarkKind::lost, {solution_document->file_name(), 1, 1, ""},
                        "gate control lists: " + *no_lists);
      if (const json::Node* const gates = solution_document->root().find("gates"))
        imported.remark(RemarkKind::changed, json::place_of(*solution_document->tree(), *gates),
                        "gate control lists are made anew of the starts");
    }
  }
  const bool plans_gates = request.settings["gates"] == "auto";
  if (plans_gates && solution)
    diagnostics.error({solution_document->file_name(), 1, 1, ""}, "a schedule, and gates that takt shall lay out",
                      {"both", "a schedule, or -o gates=auto"});
  if (diagnostics.has_errors()) return imported;
  make_scenario(
      {*instance, solution ? &*solution : nullptr, extras ? &*extras : nullptr, family.has_classes, plans_gates},
      imported, diagnostics);
  return imported;
}

}  // namespace

const std::span<const SettingInfo> planning_import_settings = planning_settings;
const std::span<const SettingInfo> applications_import_settings = applications_settings;

Imported import_neutral(const ImportRequest& request, json::Diagnostics& diagnostics) {
  return import_instance(
      request, {"the neutral problem", {Content::neutral}, "PROBLEM.json, and perhaps SOLUTION.json"}, diagnostics);
}
Imported import_tas_benchmark(const ImportRequest& request, json::Diagnostics& diagnostics) {
  return import_instance(request, {"TAS_Benchmark", {Content::tas_benchmark}, "INSTANCE.json"}, diagnostics);
}
Imported import_tsnbench(const ImportRequest& request, json::Diagnostics& diagnostics) {
  return import_instance(
      request, {"TSNBenchScenarios", {Content::bench_streams, Content::bench_topology}, "TOPOLOGY.top STREAMS.pat"},
      diagnostics);
}
Imported import_tsnkit(const ImportRequest& request, json::Diagnostics& diagnostics) {
  return import_instance(request,
                         {"tsnkit", {Content::tsnkit_tasks, Content::tsnkit_topology}, "TASK.csv TOPOLOGY.csv", false},
                         diagnostics);
}
Imported import_tsnsched(const ImportRequest& request, json::Diagnostics& diagnostics) {
  return import_instance(request, {"TSNsched", {Content::tsnsched}, "INPUT.json"}, diagnostics);
}
Imported import_ecrts(const ImportRequest& request, json::Diagnostics& diagnostics) {
  return import_instance(request, {"the challenge of ECRTS'25", {Content::ecrts}, "STREAMS.txt"}, diagnostics);
}

Imported import_applications(const ImportRequest& request, json::Diagnostics& diagnostics) {
  schedule_instances::GraphmlAssumptions assumptions;
  const auto rate = json::parse_data_rate(request.settings["rate"]);
  const auto hyperperiod = json::parse_duration(request.settings["hyperperiod"]);
  if (!rate || (*rate).bits_per_second < 1'000'000)
    diagnostics.error({"-o rate", 0, 0, ""}, "not a rate",
                      {json::quote(request.settings["rate"]), "a rate of at least 1Mbps"});
  if (!hyperperiod || (*hyperperiod).ps() <= 0 || (*hyperperiod).ps() > schedule::longest_time >> 4)
    diagnostics.error({"-o hyperperiod", 0, 0, ""}, "not a hyperperiod",
                      {json::quote(request.settings["hyperperiod"]), "a duration such as 500us"});
  if (diagnostics.has_errors()) return {};
  assumptions.rate = static_cast<std::int64_t>((*rate).bits_per_second);
  assumptions.hyperperiod = (*hyperperiod).ps();
  assumptions.with_avb = request.settings["avb"] == "on";
  return import_instance(request,
                         {"GraphML with applications",
                          {Content::graphml_applications, Content::graphml_network},
                          "NETWORK.graphml APPLICATIONS.xml"},
                         diagnostics, assumptions);
}

}  // namespace takt::interchange
