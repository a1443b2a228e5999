// SPDX-License-Identifier: Apache-2.0
// The kinds of files of `takt` itself.
#include <array>

#include "analysis/report_record.hpp"
#include "cli/commands.hpp"
#include "cli/file_kinds.hpp"
#include "explain/explanation.hpp"
#include "explore/report/report.hpp"
#include "profile/profile.hpp"
#include "results/run_result.hpp"
#include "scenario/description/device.hpp"
#include "verify/report_record.hpp"

namespace takt::cli {

namespace {

constexpr std::array core_kinds{
    read_as<scenario::Scenario>("scenario", "takt scenario"),
    written_as<results::RunResult>("result", "takt run: result.json"),
    written_as<analysis::BoundReport>("bound", "takt bound --format json"),
    written_as<verify::Report>("verify", "takt verify --format json"),
    written_as<explain::Explanation>("explain", "takt explain --format json"),
    written_as<explore::Exploration>("explore", "takt explore --format json"),
    written_as<profile::Report>("profile", "takt check --profile PROFILE --format json"),
    read_as<scenario::Device>("device", "a type of device"),
};

}  // namespace

void add_schema_command(Command app, ExitStatus& status) { add_schema_command(app, status, core_kinds); }

}  // namespace takt::cli
