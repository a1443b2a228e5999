// SPDX-License-Identifier: Apache-2.0
// Studies for tests: files in a folder of their own.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <string>

#include "study/plan.hpp"

namespace takt::study {

/// A folder that is removed at the end.
class Folder {
 public:
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "takt-study-XXXXXX").string();
    path_ = ::mkdtemp(name.data());
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::string file(const std::string& name) const { return (path_ / name).string(); }
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(file(name)) << text;
    return file(name);
  }

 private:
  std::filesystem::path path_;
};

/// Two hosts and a switch, a stream between them; 2 ms. Factors and the rest of the study are given as JSON members.
inline std::string small_study(const std::string& members) {
  return R"({"name": "small", "scenario": {"name": "pair", "duration": "2ms",
    "network": {"nodes": {"a": {"kind": "host"}, "b": {"kind": "host"}, "s": {"kind": "switch", "forwarding_delay": "1us"}},
                "links": [{"ends": ["a", "s"]}, {"ends": ["b", "s"]}]},
    "streams": [{"name": "x", "from": "a", "to": "b", "payload": "100B", "exponential": "50us"}]},
    "measures": [{"name": "delay", "of": "latency.x.max", "unit": "us"}], )" +
         members + "}";
}

inline std::unique_ptr<Plan> plan_of(const Folder& folder, const std::string& members,
                                     std::string* problems = nullptr) {
  json::Diagnostics diagnostics;
  auto plan = load_plan(folder.write("study.json", small_study(members)), diagnostics);
  if (problems != nullptr)
    *problems = diagnostics.to_text();
  else
    EXPECT_TRUE(plan) << diagnostics.to_text();
  return plan;
}

}  // namespace takt::study
