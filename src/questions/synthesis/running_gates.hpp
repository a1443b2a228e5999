// SPDX-License-Identifier: Apache-2.0
// What the gates of a scheduled scenario were laid for: its copy has the lists alone.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scenario/resolved/resolved.hpp"

namespace takt::synthesis {

/// A scheduled scenario with the automatic gates whose lists it has.
struct RunningGates {
  scenario::NetworkGates gates;                  ///< automatic, with margin, classes and guard
  std::unique_ptr<scenario::Resolved> resolved;  ///< the scenario with them: windows and lists
};

/// `asked`: the gates of the plant, if they are known; a margin "auto" is not. Whatever is not known is guessed from
/// the lists; then gates are laid anew, and every list must be the one that runs. `coming`: streams whose classes are
/// taken for scheduled where that changes no list. Nothing, with a diagnostic, if there are no listed gates or no such
/// gates have these lists.
std::optional<RunningGates> gates_of_running(const scenario::Scenario& running,
                                             const std::optional<scenario::NetworkGates>& asked,
                                             const std::vector<scenario::Stream>& coming,
                                             json::Diagnostics& diagnostics);

}  // namespace takt::synthesis
