// SPDX-License-Identifier: Apache-2.0
// The least of a scenario that still does something.
#pragma once

#include <functional>
#include <string>

namespace takt::generator {

/// Leaves out items of arrays and members of objects, great ones first, as long as `still` says so, and makes the run
/// shorter. `text` is JSON for which `still` holds. What is left: no single part can be left out. At most so many
/// questions.
std::string shrink(const std::string& text, const std::function<bool(const std::string& text)>& still,
                   unsigned most_questions = 600);

}  // namespace takt::generator
