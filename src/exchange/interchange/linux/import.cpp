// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>

#include "interchange/linux/linux.hpp"
#include "interchange/linux/meaning.hpp"
#include "interchange/linux/script.hpp"

namespace takt::interchange {
namespace {

constexpr SettingInfo linux_import_table[] = {
    {"rate", "a rate such as 1Gbps", "1Gbps",
     "of ports that no shaper and no base says it of; the shortest interval of a gate list follows from it"},
    {"never-open", "refuse|accept", "refuse", "gate lists that never open a class: usually a mistake"},
    {"queues", "a whole number", "8", "transmit queues of the interfaces"},
};

/// The same of many lines is one remark, at the first.
void remark_once(const std::vector<Remark>& remarks, Imported& imported) {
  std::vector<std::pair<Remark, std::size_t>> told;
  for (const Remark& each : remarks) {
    const auto same = std::ranges::find_if(told, [&](const auto& other) {
      return other.first.kind == each.kind && other.first.text == each.text &&
             other.first.place.file == each.place.file;
    });
    if (same == told.end())
      told.emplace_back(each, 1);
    else
      ++same->second;
  }
  for (auto& [remark, count] : told)
    imported.remark(remark.kind, remark.place,
                    remark.text + (count == 1 ? "" : " (" + std::to_string(count) + " times)"));
}

}  // namespace

const std::span<const SettingInfo> linux_import_settings = linux_import_table;

Imported import_linux(const ImportRequest& request, json::Diagnostics& diagnostics) {
  Imported imported;
  Names names;
  linux_tc::CheckOptions options;
  const auto rate = json::parse_data_rate(request.settings["rate"]);
  const auto queues = request.settings.number("queues", 4096);
  if (!rate || !queues || *queues == 0) {
    diagnostics.error({"", 0, 0, ""}, "a setting that cannot be",
                      {"rate=" + request.settings["rate"] + ", queues=" + request.settings["queues"],
                       "a rate such as 1Gbps and a number of queues"});
    return imported;
  }
  options.port_rate = (*rate).bits_per_second;
  options.transmit_queues = static_cast<std::uint32_t>(*queues);

  options.classes_may_stay_closed = request.settings["never-open"] == "accept";

  struct OfDevice {
    const InputFile* first = nullptr;
    linux_tc::Machine machine;
    std::vector<const InputFile*> ptp4l;
    const InputFile* script = nullptr;
  };
  std::vector<std::pair<std::string, OfDevice>> machines;
  for (const InputFile& file : request.files) {
    if (is_names_file(file)) {
      names.read(file, diagnostics);
      continue;
    }
    auto found =
        std::ranges::find(machines, file.device, [](const auto& each) -> const std::string& { return each.first; });
    if (found == machines.end())
      found = machines.insert(machines.end(), {file.device, OfDevice{&file, {}, {}, nullptr}});
    if (const bool is_script = !file.name.ends_with(".conf") && !file.name.ends_with(".json");
        is_script && found->second.script != nullptr)
      imported.remark(RemarkKind::odd, {file.name, 0, 0, ""},
                      "a second file of commands of " + json::quote(file.device) + ": read behind " +
                          found->second.script->name + ", as one machine");
    else if (is_script)
      found->second.script = &file;
    if (file.name.ends_with(".conf")) {
      found->second.ptp4l.push_back(&file);
    } else if (file.name.ends_with(".json")) {
      linux_tc::read_dump(file.text, file.name, found->second.machine, diagnostics);
    } else if (file.name.ends_with(".sh") || file.name.ends_with(".bash") || file.name.ends_with(".batch") ||
               file.name.ends_with(".trace") || file.name.ends_with(".txt")) {
      linux_tc::read_script(file.text, file.name, found->second.machine, diagnostics);
    } else {
      diagnostics.error({file.name, 0, 0, ""}, "a file of unknown kind",
                        {json::quote(file.name),
                         "a name that ends with .sh, .batch or .trace (commands), .json (output of tc -j, ip -j or "
                         "bridge -j) or .conf (ptp4l)"});
    }
  }
  for (const auto& [name, of_device] : machines) linux_tc::check(of_device.machine, options, diagnostics);
  for (const auto& [name, of_device] : machines) remark_once(of_device.machine.remarks, imported);
  if (diagnostics.has_errors()) return imported;
  std::vector<ImportedDevice> devices;
  for (const auto& [name, of_device] : machines) {
    ImportedDevice device =
        linux_tc::device_of(name, {of_device.first->name, 0, 0, ""}, of_device.machine, names, imported, diagnostics);
    for (const InputFile* const file : of_device.ptp4l) linux_tc::read_ptp4l(*file, device, imported, diagnostics);
    devices.push_back(std::move(device));
  }
  if (!diagnostics.has_errors()) build_scenario(std::move(devices), request, names, imported, diagnostics);
  return imported;
}

}  // namespace takt::interchange
