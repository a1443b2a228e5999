// SPDX-License-Identifier: Apache-2.0
// What the tests of scenarios share: loading texts, running them, and small scenarios to start from.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "scenario/resolve.hpp"
#include "scenario/run/run.hpp"

namespace takt::scenario::test {

/// A scenario and what was said about it.
struct Loaded {
  std::unique_ptr<Resolved> resolved;
  json::Diagnostics diagnostics;
};

inline Loaded load(std::string_view text, const std::vector<std::string>& overrides = {}) {
  Loaded loaded;
  loaded.resolved = load_text(text, "s.json", overrides, loaded.diagnostics);
  return loaded;
}

/// A scenario that must be sound. Never null: a test cannot go on without it.
inline std::unique_ptr<Resolved> sound(std::string_view text, const std::vector<std::string>& overrides = {}) {
  Loaded loaded = load(text, overrides);
  if (!loaded.resolved) throw std::runtime_error("refused:\n" + loaded.diagnostics.to_text());
  return std::move(loaded.resolved);
}

inline std::string shipped_path(const std::string& name) {
  return std::string(TAKT_SOURCE_DIR) + "/scenarios/" + name + ".json";
}

/// Every scenario of the folder and of those below, such as "robot-arm", by name.
inline std::vector<std::string> shipped_names() {
  namespace fs = std::filesystem;
  const fs::path folder = fs::path(TAKT_SOURCE_DIR) / "scenarios";
  std::vector<std::string> names;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
    const fs::path& path = entry.path();
    if (path.extension() != ".json" || path.filename() == "takt.schema.json") continue;
    if (path.lexically_relative(folder).generic_string().starts_with("studies/"))
      continue;  // they are studies, not scenarios
    names.push_back(path.lexically_relative(folder).replace_extension().generic_string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

/// A shipped scenario, cut to `duration` unless that is empty.
inline std::unique_ptr<Resolved> shipped(const std::string& name, const std::string& duration = {}) {
  json::Diagnostics diagnostics;
  auto resolved =
      load_file(shipped_path(name),
                duration.empty() ? std::vector<std::string>{} : std::vector{"/duration=" + duration}, diagnostics);
  if (!resolved) throw std::runtime_error("refused:\n" + diagnostics.to_text());
  return resolved;
}

using LiveRun = Run;  // within a test, Run is a function of GoogleTest

/// The digest after the whole duration.
inline std::uint64_t digest_of(const Resolved& resolved, std::uint64_t tie_shuffle = 0) {
  Run run(resolved, tie_shuffle);
  run.advance();
  return run.simulation().digest().value();
}

/// A node by its name; the name must be known.
inline std::uint32_t node(const Resolved& resolved, std::string_view name) {
  return resolved.topology.find(name).value();
}

/// Two hosts, `a` and `b`, and a switch `sw` between them; `more` are further members of the scenario with a leading
/// comma.
inline std::string over_one_switch(const std::string& more) {
  return R"({"name": "t", "duration": "10ms", "network": {"nodes": {"a": {"kind": "host"}, "b": {"kind": "host"}, "sw": {"kind": "switch"}},
 "links": [{"ends": ["a", "sw"]}, {"ends": ["b", "sw"]}]})" +
         more + "}";
}

/// A network of one generator.
inline std::string generated(const std::string& generator, const std::string& more = {}) {
  return R"({"name": "t", "duration": "1ms", "network": {"generate": [{)" + generator + "}]}" + more + "}";
}

}  // namespace takt::scenario::test
