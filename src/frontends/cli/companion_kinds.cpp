// SPDX-License-Identifier: Apache-2.0
// The kinds of files that only companions read or write.
#include <array>

#include "cli/commands.hpp"
#include "cli/file_kinds.hpp"
#include "emulate/emulation.hpp"
#include "schedule_instances/report.hpp"
#include "node/applications/config.hpp"
#include "node/applications/host.hpp"
#include "node/config.hpp"
#include "node/description.hpp"
#include "node/key_service_node.hpp"
#include "node/node_status.hpp"
#include "study/compare.hpp"
#include "study/description.hpp"
#include "synthesis/change_report.hpp"
#include "synthesis/report.hpp"

namespace takt::cli {

namespace {

constexpr std::array kinds{
    read_as<study::Study>("study", "takt study"),
    read_as<node::Config>("node", "takt node: Programs"),
    read_as<node::ApplicationsConfig>("applications", "takt node: applications"),
    read_as<node::KeyServiceNode>("key-service", "takt node: a key service"),
    written_as<schedule_instances::ScheduleReport>("schedule", "takt schedule INSTANCE --format json"),
    written_as<synthesis::ScenarioSchedule>("schedule-scenario", "takt schedule SCENARIO --format json"),
    written_as<synthesis::ChangeSummary>("schedule-change", "takt schedule --to SCENARIO --format json"),
    written_as<study::Comparison>("compare", "takt compare --format json"),
    written_as<node::NodeStatus>("status", "takt ctl NODE status --format json"),
    written_as<node::NodeDescription>("describe", "takt node --describe"),
    written_as<node::ApplicationsReport>("statistics", "takt node: statistics of applications"),
    written_as<emulate::Report>("emulate", "takt emulate --format json"),
};

constexpr bool are_as_listed() {
  if (kinds.size() != std::size(companion_kinds)) return false;
  for (std::size_t k = 0; k < kinds.size(); ++k)
    if (std::string_view(kinds[k].name) != companion_kinds[k]) return false;
  return true;
}
static_assert(are_as_listed(), "takt names every kind that takt-schema has");

}  // namespace

void add_companion_schema_command(Command app, ExitStatus& status) { add_schema_command(app, status, kinds); }

}  // namespace takt::cli
