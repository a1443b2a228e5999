// SPDX-License-Identifier: Apache-2.0
#include "interchange/inet/inet.hpp"
#include "interchange/inet/reader.hpp"

namespace takt::interchange {
namespace inet {
namespace {

constexpr SettingInfo inet_import_table[] = {
    {"config", "the name of a section", "General", "of the ini file: that section and what it extends"},
    {"run", "a whole number", "0", "of the runs of its iterations, ${N=1,2,4}"}};

}  // namespace
}  // namespace inet

const std::span<const SettingInfo> inet_import_settings = inet::inet_import_table;

Imported import_inet(const ImportRequest& request, json::Diagnostics& diagnostics) {
  Imported imported;
  inet::InetReader(request, imported, diagnostics).run();
  return imported;
}

}  // namespace takt::interchange
