// SPDX-License-Identifier: Apache-2.0
// takt import: a scenario from what devices are set to and other tools write.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>

#include "cli/commands.hpp"
#include "cli/companion.hpp"
#include "cli/places.hpp"
#include "interchange/device_import.hpp"
#include "interchange/format.hpp"
#include "json/fields.hpp"
#include "output/result_folder.hpp"
#include "scenario/resolve.hpp"

namespace takt::cli {
namespace {

struct ImportOptions {
  std::string format;
  std::vector<std::string> files;
  std::string out;
  std::string into;
  std::vector<std::string> settings;
};

std::string import_formats_help() {
  std::string text;
  for (const interchange::ImportFormat& format : interchange::import_formats()) {
    text += fmt::format("  {:<10} {}\n             files: {}{}\n", format.name, format.help, format.files,
                        format.into_base ? "; --into" : "");
    for (const interchange::SettingInfo& setting : format.settings)
      text += fmt::format("             -o {}={}{}: {}\n", setting.key, setting.values,
                          setting.fallback.empty() ? "" : fmt::format(" ({})", setting.fallback), setting.help);
  }
  return text;
}

/// "NODE=FILE", or a file that is called after its node.
interchange::InputFile read_input(const std::string& argument, json::Diagnostics& diagnostics) {
  interchange::InputFile file;
  file.name = argument;
  std::error_code ignored;
  const std::size_t equals = argument.find('=');
  if (equals != std::string::npos && !std::filesystem::exists(argument, ignored)) {
    file.device = argument.substr(0, equals);
    file.name = argument.substr(equals + 1);
  } else {
    file.device = interchange::device_of_file(std::filesystem::path(argument).filename().string());
  }
  std::ifstream stream(file.name, std::ios::binary);
  if (!stream || std::filesystem::is_directory(file.name, ignored)) {
    diagnostics.error({file.name, 0, 0, ""}, "cannot be read", {stream ? "a folder" : std::strerror(errno), "a file"});
    return file;
  }
  // A file costs what it is long: piece by piece, since pipes do not say their length.
  std::string piece(std::size_t{64} << 10, '\0');
  while (stream && file.text.size() <= interchange::max_input_octets) {
    stream.read(piece.data(), static_cast<std::streamsize>(piece.size()));
    file.text.append(piece, 0, static_cast<std::size_t>(stream.gcount()));
  }
  file.text.shrink_to_fit();
  if (file.text.size() > interchange::max_input_octets)
    diagnostics.error({file.name, 0, 0, ""}, "too large", {"more than 64 MiB", "at most 64 MiB"});
  return file;
}

/// The mistakes at the lines of the files that said what is wrong, as far as these are known.
json::Diagnostics placed_in_files(const json::Diagnostics& diagnostics, const interchange::Imported& imported) {
  json::Diagnostics placed;
  for (const json::Diagnostic& each : diagnostics.sorted()) {
    if (each.severity != json::Severity::error) continue;
    json::Place place = each.place;
    for (std::string pointer = place.pointer; !pointer.empty(); pointer.resize(pointer.rfind('/')))
      if (const auto origin = imported.origins.find(pointer); origin != imported.origins.end()) {
        place = origin->second;
        break;
      }
    placed.error(std::move(place), each.message, each.details);
  }
  return placed;
}

/// What was made is a scenario like any other: what it says must go together.
bool is_sound_scenario(const std::string& text, const std::string& name, const interchange::Imported& imported,
                       std::size_t files) {
  json::Diagnostics diagnostics;
  const auto resolved = scenario::load_text(text, name, {}, diagnostics);
  if (resolved) return true;
  json::Diagnostics placed = placed_in_files(diagnostics, imported);
  std::fputs(placed.to_text().c_str(), stderr);
  std::fprintf(stderr,
               "takt: what the %s is no sound scenario (above, by the lines of the files, or where it would stand)\n",
               files == 1 ? "file says" : "files say");
  return false;
}

ExitStatus write_out(const ImportOptions& options, const std::string& text,
                     const interchange::InterfaceNames& interfaces) {
  if (options.out.empty()) {
    if (!interfaces.empty())
      std::fprintf(stderr,
                   "takt: the names of interfaces are not kept on standard output; --out FILE.json writes them into "
                   "FILE.names.json\n");
    std::fputs(text.c_str(), stdout);
    return ExitStatus::pass;
  }
  std::string problem = output::write_file(options.out, text);
  if (problem.empty() && !interfaces.empty())
    problem = output::write_file(interchange::names_file_of(options.out), interchange::interfaces_table(interfaces));
  if (problem.empty()) return ExitStatus::pass;
  std::fprintf(stderr, "takt: cannot write: %s\n", problem.c_str());
  return ExitStatus::internal_error;
}

ExitStatus run_import(const ImportOptions& options) {
  const interchange::ImportFormat& format = *interchange::find_import_format(options.format);
  std::string mistake;
  const auto settings = interchange::Settings::read(options.settings, format.settings, mistake);
  if (settings && !format.into_base && !options.into.empty())
    mistake = "--into: this format brings a network of its own";
  if (!mistake.empty()) {
    std::fprintf(stderr, "takt: %s\n", mistake.c_str());
    return ExitStatus::bad_input;
  }
  if (!can_write({{"--out", options.out, Place::Kind::file}})) return ExitStatus::bad_input;
  json::Diagnostics diagnostics;
  std::optional<scenario::Scenario> base;
  if (!options.into.empty()) {
    const auto document = json::parse_file(options.into, diagnostics);
    base.emplace();
    if (document) json::decode(*document, *base, diagnostics);
  }
  std::vector<interchange::InputFile> files;
  for (const std::string& argument : options.files) files.push_back(read_input(argument, diagnostics));
  interchange::Imported imported;
  if (!diagnostics.has_errors()) imported = format.read({files, base ? &*base : nullptr, *settings}, diagnostics);
  std::fputs(diagnostics.to_text().c_str(), stderr);
  if (diagnostics.has_errors() || (!imported.scenario && !imported.device)) return ExitStatus::bad_input;
  for (const interchange::Remark& remark : imported.remarks)
    std::fprintf(stderr, "%s\n", interchange::to_text(remark).c_str());
  if (imported.device) return write_out(options, *imported.device, {});
  const std::string text = interchange::sparse_text(*imported.scenario);
  if (!is_sound_scenario(text, options.out.empty() ? "scenario.json" : options.out, imported, files.size()))
    return ExitStatus::bad_input;
  return write_out(options, text, imported.interfaces);
}

}  // namespace

void add_import_command(Command app, ExitStatus& status) {
  const Command command = app.add_subcommand("import", companion_help("import"));
  const auto options = std::make_shared<ImportOptions>();
  std::vector<std::string> names;
  for (const interchange::ImportFormat& format : interchange::import_formats()) names.emplace_back(format.name);
  command.add_option("FORMAT", options->format, "What the files are (below)").required().one_of(names);
  command.add_option("FILES", options->files, "The files, as NODE=FILE where a file is not called after its node")
      .required();
  command.add_option("--out", options->out, "The scenario (device: the type) to write; standard output if absent")
      .type_name("FILE");
  command
      .add_option("--into", options->into,
                  "A scenario with the network that the devices are in, and all that the files do not say")
      .type_name("SCENARIO");
  command.add_option("-o", options->settings, "A setting of the format (repeatable)")
      .type_name("KEY=VALUE")
      .one_value_each();
  command.footer(
      "Formats:\n" + import_formats_help() +
      "What was changed on the way, is lost or has no meaning in takt is told on standard error, with its place.\n"
      "Examples:\n"
      "  takt import linux sw1.sh sw2.sh --into plant.json --out plant-as-set.json    gates and shapers of two "
      "switches\n"
      "  takt import linux sw1.qdisc.json sw1.link.json --out sw1.json                one machine, with a host at each "
      "port\n"
      "Exit status: 0 written, 2 mistakes (all of them are listed; nothing was written).");
  command.callback([options, &status] { status = run_import(*options); });
}

}  // namespace takt::cli
