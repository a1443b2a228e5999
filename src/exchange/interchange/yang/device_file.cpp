// SPDX-License-Identifier: Apache-2.0
// From instance data to a file with a type of device.
#include "interchange/device_import.hpp"
#include "interchange/yang/device_type.hpp"
#include "interchange/yang/yang.hpp"

namespace takt::interchange {

Imported import_device(const ImportRequest& request, json::Diagnostics& diagnostics) {
  Imported imported;
  std::vector<yang::Data> read;
  std::string name;
  yang::DataReader reader(imported, diagnostics);
  for (const InputFile& file : request.files) {
    if (name.empty()) name = file.device;
    if (file.device != name)
      diagnostics.error(
          {file.name, 0, 0, ""}, "a second device",
          {json::quote(file.device) + " beside " + json::quote(name), "files of one bridge; NAME=FILE says of which"});
    const auto dialect = reader.dialect_of(file);
    if (!dialect) continue;
    if (auto data = reader.read(file, *dialect)) read.push_back(std::move(*data));
  }
  if (diagnostics.has_errors()) return imported;
  std::vector<const yang::Data*> files;
  for (const yang::Data& data : read) files.push_back(&data);
  const auto device = yang::device_type_of(files, name, imported, diagnostics);
  if (diagnostics.has_errors()) return imported;
  if (!device) {
    diagnostics.error({request.files.front().name, 0, 0, ""}, "a bridge that announces nothing",
                      {"no state that a type of device has", "delays, PHYs, gates, queues or features"});
    return imported;
  }
  imported.device = yang::device_text(*device);
  return imported;
}

}  // namespace takt::interchange
