// The shipped findings: `takt run` sees in each what the explorer has found, named at the end of the file's name.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "scenario/resolve.hpp"
#include "scenario/run.hpp"

namespace takt::explore {
namespace {

using handshake::PublishedState;

/// Where a group that does not settle ends. The one that chases itself for ever ends anywhere.
struct End {
  const char* name;
  std::vector<PublishedState> states;
};
const std::vector<End>& ends() {
  static const std::vector<End> all{
      {"paper-half-reset-L1", {PublishedState::Ready, PublishedState::Running, PublishedState::Ready}},
      {"paper-missed-halt-L1", {PublishedState::Ready, PublishedState::Ready}},           // after a Start
      {"paper-reset-restarts-L1", {PublishedState::Running, PublishedState::Running}},    // after a Reset
      {"paper-silence-F1", {PublishedState::Running, PublishedState::Running}},           // the master is down
      {"paper-suspend-resume-chase-L1", {}},
  };
  return all;
}

void expect_end(const std::string& name, const scenario::Run& run) {
  for (const End& end : ends()) {
    if (name != end.name) continue;
    if (end.states.empty()) {
      EXPECT_GT(run.monitor(0).changes(), 400U) << "two changes in each of more than 200 cycles";
    }
    for (std::size_t i = name.ends_with("F1") ? 1 : 0; i < end.states.size(); ++i) EXPECT_EQ(run.state(0, i), end.states[i]) << name << " " << i;
    return;
  }
  ADD_FAILURE() << name << ": say in schedule_test.cpp where it ends";
}

TEST(Findings, AreSeenByARun) {
  std::size_t seen = 0;
  for (const auto& entry : std::filesystem::directory_iterator(std::string(TAKT_SOURCE_DIR) + "/scenarios/findings")) {
    if (entry.path().extension() != ".json") continue;
    const std::string name = entry.path().stem().string();
    scenario::json::Diagnostics diagnostics;
    const auto resolved = scenario::load_file(entry.path().string(), {}, diagnostics);
    ASSERT_NE(resolved, nullptr) << diagnostics.to_text();
    scenario::Run run(*resolved);
    run.advance();
    const std::string property = name.substr(name.size() - 2);
    ++seen;
    if (property[0] != 'S') {
      expect_end(name, run);
      continue;
    }
    bool found = false;
    for (const scenario::ViolationRecord& each : run.monitor(0).violations()) found = found || handshake::name_of(each.violation.invariant) == property;
    EXPECT_TRUE(found) << name;
  }
  EXPECT_GE(seen, 9U);
}

}  // namespace
}  // namespace takt::explore
