// SPDX-License-Identifier: Apache-2.0
// The scenarios of a folder here.
#pragma once

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

namespace takt::regression {

inline std::vector<std::string> files_of(const std::string& folder) {
  std::vector<std::string> files;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::string(TAKT_SOURCE_DIR) + "/tests/regression/" + folder))
    if (entry.path().extension() == ".json") files.push_back(entry.path().string());
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace takt::regression
