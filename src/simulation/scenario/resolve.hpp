// SPDX-License-Identifier: Apache-2.0
// From a description to a checked, resolved scenario.
#pragma once

#include <memory>

#include "json/document.hpp"
#include "scenario/resolved/resolved.hpp"

namespace takt::scenario {

/// Checks all that the tables cannot: names, paths, sizes, loads, times that belong together. All mistakes go to
/// `diagnostics`; if there is an error, the result is null. Warnings do not prevent a result.
std::unique_ptr<Resolved> resolve(Scenario scenario, json::Diagnostics& diagnostics);

/// Reads, applies the overrides ("pointer=value"), decodes and resolves. `text` is the content of `file_name`.
std::unique_ptr<Resolved> load_text(std::string_view text, const std::string& file_name,
                                    const std::vector<std::string>& overrides, json::Diagnostics& diagnostics);
std::unique_ptr<Resolved> load_file(const std::string& path, const std::vector<std::string>& overrides,
                                    json::Diagnostics& diagnostics);

}  // namespace takt::scenario
