// SPDX-License-Identifier: Apache-2.0
// Where a command is going to write: all commands ask here, before they work.
#pragma once

#include <string>
#include <vector>

namespace takt::cli {

struct Place {
  enum class Kind { file, folder, either };  ///< either: a folder if it ends with a slash
  const char* option;                        ///< "--out"
  const std::string& path;                   ///< empty: nothing is written there
  Kind kind;
};

/// Whether all of them can be written to. What cannot is told as a mistake, on standard error or as JSON on standard
/// output; the exit status is then bad_input, and nothing was written.
[[nodiscard]] bool can_write(const std::vector<Place>& places, bool is_json = false);

}  // namespace takt::cli
