// SPDX-License-Identifier: Apache-2.0
// A scenario, out and in again: the same run.
#pragma once

#include "files.hpp"
#include "scenario/resolve.hpp"
#include "scenario/run/run.hpp"

namespace takt::interchange::test {

inline std::unique_ptr<scenario::Resolved> load(const std::string& text, const std::string& name) {
  json::Diagnostics diagnostics;
  auto resolved = scenario::load_text(text, name, {}, diagnostics);
  EXPECT_TRUE(resolved) << name << "\n" << diagnostics.to_text();
  return resolved;
}

/// The digest of the first `duration` of a run.
inline std::uint64_t digest_of(const scenario::Resolved& resolved, sim::Duration duration) {
  scenario::Run run(resolved);
  run.simulation().run(sim::TrueTime() + duration);
  return run.simulation().digest().value();
}

/// The shipped scenarios that are no studies and need no other file.
inline std::vector<std::filesystem::path> shipped() {
  std::vector<std::filesystem::path> files;
  const std::filesystem::path root = std::filesystem::path(TAKT_SOURCE_DIR) / "scenarios";
  for (const char* const folder : {"", "applications", "clocks", "programs", "tsn", "validation"})
    for (const auto& entry : std::filesystem::directory_iterator(root / folder))
      if (entry.path().extension() == ".json" && !entry.path().filename().string().ends_with(".schema.json"))
        files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace takt::interchange::test
