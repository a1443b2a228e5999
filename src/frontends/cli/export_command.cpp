// SPDX-License-Identifier: Apache-2.0
// takt export: a scenario in the words of devices and other tools.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <system_error>
#include <vector>

#include "cli/commands.hpp"
#include "cli/companion.hpp"
#include "cli/load.hpp"
#include "cli/places.hpp"
#include "cli/terminal.hpp"
#include "interchange/device_import.hpp"
#include "interchange/format.hpp"
#include "interchange/yang/validate.hpp"
#include "json/printable.hpp"
#include "output/result_folder.hpp"

namespace takt::cli {
namespace {

struct ExportOptions {
  std::string format;
  ScenarioOptions scenario;
  std::string node;
  std::string folder;
  std::vector<std::string> settings;
  bool lossy = false;
  std::string modules;
};

std::string export_formats_help() {
  std::string text;
  for (const interchange::ExportFormat& format : interchange::export_formats()) {
    text += fmt::format("  {:<10} {}\n", format.name, format.help);
    for (const interchange::SettingInfo& setting : format.settings)
      text += fmt::format("             -o {}={}{}: {}\n", setting.key, setting.values,
                          setting.fallback.empty() ? "" : fmt::format(" ({})", setting.fallback), setting.help);
  }
  return text;
}

ExitStatus refuse_export(const std::string& text) {
  std::fprintf(stderr, "takt: %s\n", text.c_str());
  return ExitStatus::bad_input;
}

/// Whether a name is a path that leaves the folder it is in.
bool leads_out(const std::string& name) {
  const std::filesystem::path path(name);
  return name.empty() || path.is_absolute() || std::ranges::find(path, std::filesystem::path("..")) != path.end();
}

ExitStatus write_files(const interchange::Exported& exported, const std::string& folder, bool is_json) {
  namespace fs = std::filesystem;
  std::vector<std::string> paths;
  for (const interchange::OutputFile& file : exported.files) {
    if (leads_out(file.name))
      return refuse_export(json::quote(file.name) +
                           " is no name of a file in the folder of --out: give the scenario or node another name");
    std::string path = (fs::path(folder) / json::file_name(file.name)).string();
    if (std::ranges::find(paths, path) != paths.end())
      return refuse_export("two files would be " + json::quote(path) + ": give the scenario or node another name");
    paths.push_back(std::move(path));
  }
  std::vector<Place> places;
  for (const std::string& path : paths) places.push_back({"--out", path, Place::Kind::file});
  if (!can_write(places, is_json)) return ExitStatus::bad_input;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const interchange::OutputFile& file = exported.files[i];
    const std::string& path = paths[i];
    if (const std::string problem = output::write_file(path, file.content); !problem.empty()) {
      std::fprintf(stderr, "takt: cannot write: %s\n", problem.c_str());
      return ExitStatus::internal_error;
    }
    std::error_code error;
    if (file.is_executable)
      fs::permissions(path, fs::perms::owner_exec | fs::perms::group_exec | fs::perms::others_exec,
                      fs::perm_options::add, error);
  }
  return ExitStatus::pass;
}

ExitStatus run_export(const ExportOptions& options) {
  const interchange::ExportFormat& format = *interchange::find_export_format(options.format);
  std::string mistake;
  const auto settings = interchange::Settings::read(options.settings, format.settings, mistake);
  if (!settings) return refuse_export(mistake);
  if (!options.modules.empty() && format.name != "yang")
    return refuse_export("--validate: found format " + json::quote(options.format) +
                         ", expected yang, whose files modules describe");
  if (!options.modules.empty() && !interchange::can_validate_yang())
    return refuse_export(
        "--validate: this takt is built without libyang; install libyang2-dev (Debian) and build it again, or give the "
        "files to yanglint (libyang2-tools)");
  if (!can_write({{"--out", options.folder, Place::Kind::folder}}, options.scenario.is_json()))
    return ExitStatus::bad_input;
  const auto resolved = load(options.scenario);
  if (!resolved) return ExitStatus::bad_input;
  std::optional<std::uint32_t> node;
  if (!options.node.empty()) {
    node = resolved->topology.find(options.node);
    json::Diagnostics none;
    if (!node) {
      const std::string suggestion = scenario::suggest_node(resolved->topology, options.node, none);
      return refuse_export("--node: unknown node: found " + json::quote(options.node) +
                           (suggestion.empty() ? "" : " (did you mean " + json::quote(suggestion) + "?)"));
    }
  }
  interchange::Names names;
  if (const std::string beside = interchange::names_file_of(options.scenario.file);
      std::filesystem::is_regular_file(beside)) {
    json::Diagnostics diagnostics;
    std::ifstream stream(beside, std::ios::binary);
    names.read({beside, "", std::string(std::istreambuf_iterator<char>(stream), {})}, diagnostics);
    tell(diagnostics);
    if (diagnostics.has_errors()) return ExitStatus::bad_input;
  }
  const interchange::Exported exported = format.write({*resolved, node, *settings, names.interfaces()});
  if (!exported.mistake.empty()) return refuse_export(exported.mistake);
  for (const interchange::Loss& loss : exported.losses)
    std::fprintf(stderr, "takt: %s cannot say: %s: %s\n", options.format.c_str(), loss.where.c_str(),
                 loss.what.c_str());
  if (!exported.losses.empty() && !options.lossy)
    return refuse_export(fmt::format("nothing was written, since {} {} lost; --lossy writes the rest",
                                     exported.losses.size(),
                                     exported.losses.size() == 1 ? "thing would be" : "things would be"));
  if (!options.modules.empty()) {
    const interchange::YangValidation validation =
        interchange::validate_yang(exported.files, (*settings)["dialect"] == "2018", options.modules);
    if (!validation.mistake.empty()) return refuse_export("--validate: " + validation.mistake);
    for (const std::string& invalid : validation.invalid)
      std::fprintf(stderr, "takt: not valid by the modules: %s\n", invalid.c_str());
    if (!validation.invalid.empty()) {
      std::fprintf(stderr, "takt: nothing was written, since %zu of the files are not valid\n",
                   validation.invalid.size());
      return ExitStatus::requirement_failed;
    }
  }
  if (!options.folder.empty()) return write_files(exported, options.folder, options.scenario.is_json());
  if (exported.files.size() == 1) {
    std::fwrite(exported.files.front().content.data(), 1, exported.files.front().content.size(), stdout);
    return ExitStatus::pass;
  }
  for (const interchange::OutputFile& file : exported.files) {
    std::printf("==> %s <==\n", json::file_name(file.name).c_str());
    std::fwrite(file.content.data(), 1, file.content.size(), stdout);
    std::printf("\n");
  }
  return ExitStatus::pass;
}

}  // namespace

void add_export_command(Command app, ExitStatus& status) {
  const Command command = app.add_subcommand("export", companion_help("export"));
  const auto options = std::make_shared<ExportOptions>();
  std::vector<std::string> names;
  for (const interchange::ExportFormat& format : interchange::export_formats()) names.emplace_back(format.name);
  command.add_option("FORMAT", options->format, "What to write (below)").required().one_of(names);
  add_scenario_options(command, options->scenario);
  command.add_option("--node", options->node, "Only what is for this node").type_name("NODE");
  command.add_option("--out", options->folder, "The folder for the files; standard output if absent").type_name("DIR");
  command.add_option("-o", options->settings, "A setting of the format (repeatable)")
      .type_name("KEY=VALUE")
      .one_value_each();
  command
      .add_option("--validate", options->modules,
                  "Of yang: first validates the files by the modules in this folder, with libyang; if one is not valid "
                  "nothing is written")
      .type_name("MODULES");
  command.add_flag("--lossy", options->lossy,
                   "Write even if something is lost that the scenario says and the format cannot");
  command.footer(
      "Formats:\n" + export_formats_help() +
      "Examples:\n"
      "  takt export linux scenarios/tsn/gates-on-a-line.json --out scripts   a script for each node\n"
      "  takt export linux scenarios/tsn/gates-on-a-line.json --node sw1      the one of sw1, on standard output\n"
      "  takt export dot scenarios/robot-arm.json | neato -Tsvg > arm.svg     the topology\n"
      "Exit status: 0 written, 1 not valid by the modules of --validate, 2 mistakes, or something is lost and --lossy "
      "is not given (nothing was written then).");
  command.callback([options, &status] { status = run_export(*options); });
}

}  // namespace takt::cli
