#include <algorithm>
#include <map>

#include "interchange/linux/linux.hpp"
#include "interchange/linux/meaning.hpp"
#include "interchange/linux/script.hpp"

namespace takt::interchange {
namespace {

constexpr SettingInfo linux_import_table[] = {
    {"rate", "a rate such as 1Gbps", "1Gbps", "of ports that no shaper and no base says it of; the shortest interval of a gate list follows from it"},
    {"never-open", "refuse|accept", "refuse", "gate lists that never open a class: usually a mistake"},
    {"queues", "a whole number", "8", "transmit queues of the interfaces"},
};

}  // namespace

const std::span<const SettingInfo> linux_import_settings = linux_import_table;

Imported import_linux(const ImportRequest& request, json::Diagnostics& diagnostics) {
  Imported imported;
  Names names;
  linux_tc::CheckOptions options;
  const auto rate = json::parse_data_rate(request.settings["rate"]);
  const auto queues = request.settings.number("queues", 4096);
  if (!rate || !queues || *queues == 0) {
    diagnostics.error({"", 0, 0, ""}, "a setting that cannot be", {"rate=" + request.settings["rate"] + ", queues=" + request.settings["queues"], "a rate such as 1Gbps and a number of queues"});
    return imported;
  }
  options.port_rate = (*rate).bits_per_second;
  options.transmit_queues = static_cast<std::uint32_t>(*queues);

  options.classes_may_stay_closed = request.settings["never-open"] == "accept";

  struct OfDevice {
    const InputFile* first = nullptr;
    linux_tc::Machine machine;
    std::vector<const InputFile*> ptp4l;
    bool has_commands = false;
  };
  std::vector<std::pair<std::string, OfDevice>> machines;
  for (const InputFile& file : request.files) {
    if (is_names_file(file)) {
      names.read(file, diagnostics);
      continue;
    }
    auto found = std::ranges::find(machines, file.device, [](const auto& each) -> const std::string& { return each.first; });
    if (found == machines.end()) found = machines.insert(machines.end(), {file.device, OfDevice{&file, {}, {}, false}});
    if (file.name.ends_with(".conf")) {
      found->second.ptp4l.push_back(&file);
    } else if (file.name.ends_with(".json")) {
      found->second.has_commands = true;
      linux_tc::read_dump(file.text, file.name, found->second.machine, diagnostics);
    } else if (file.name.ends_with(".sh")) {
      found->second.has_commands = true;
      linux_tc::read_script(file.text, file.name, found->second.machine, diagnostics);
    } else {
      diagnostics.error({file.name, 0, 0, ""}, "a file of unknown kind", {json::quote(file.name), "a name that ends with .sh (commands), .json (output of tc -j, ip -j or bridge -j) or .conf (ptp4l)"});
    }
  }
  for (const auto& [name, of_device] : machines) linux_tc::check(of_device.machine, options, diagnostics);
  if (diagnostics.has_errors()) return imported;
  std::vector<ImportedDevice> devices;
  for (const auto& [name, of_device] : machines) {
    ImportedDevice device = linux_tc::device_of(name, {of_device.first->name, 0, 0, ""}, of_device.machine, names, imported, diagnostics);
    for (const InputFile* const file : of_device.ptp4l) linux_tc::read_ptp4l(*file, device, imported, diagnostics);
    devices.push_back(std::move(device));
  }
  if (!diagnostics.has_errors()) build_scenario(std::move(devices), request, imported, diagnostics);
  return imported;
}

}  // namespace takt::interchange
