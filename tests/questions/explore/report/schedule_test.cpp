// SPDX-License-Identifier: Apache-2.0
// The shipped findings: `takt run` sees in each what the explorer has found, named at the end of the file's name.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "../ask.hpp"
#include "scenario/resolve.hpp"
#include "scenario/run/run.hpp"

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
      {"paper-missed-halt-L1", {PublishedState::Ready, PublishedState::Ready}},         // after a Start
      {"paper-reset-restarts-L1", {PublishedState::Running, PublishedState::Running}},  // after a Reset
      {"paper-silence-F1", {PublishedState::Running, PublishedState::Running}},         // the master is down
      {"paper-suspend-resume-livelock-L1", {}},
  };
  return all;
}

void expect_end(const std::string& name, const scenario::Run& run) {
  for (const End& end : ends()) {
    if (name != end.name) continue;
    if (end.states.empty()) {
      EXPECT_GT(run.monitor(0).changes(), 400U) << "two changes in each of more than 200 cycles";
    }
    for (std::size_t i = name.ends_with("F1") ? 1 : 0; i < end.states.size(); ++i)
      EXPECT_EQ(run.state(0, i), end.states[i]) << name << " " << i;
    return;
  }
  ADD_FAILURE() << name << ": say in schedule_test.cpp where it ends";
}

TEST(Findings, AreSeenByARun) {
  std::size_t seen = 0;
  for (const auto& entry : std::filesystem::directory_iterator(std::string(TAKT_SOURCE_DIR) + "/scenarios/findings")) {
    if (entry.path().extension() != ".json") continue;
    const std::string name = entry.path().stem().string();
    json::Diagnostics diagnostics;
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
    for (const scenario::ViolationRecord& each : run.monitor(0).violations())
      found = found || handshake::name_of(each.violation.invariant) == property;
    EXPECT_TRUE(found) << name;
  }
  EXPECT_GE(seen, 9U);
}

/// One line of the table in scenarios/findings/README.md.
struct Row {
  std::string scenario;
  std::string property;
  Query query;
};

std::vector<Row> table() {
  std::vector<Row> rows;
  std::ifstream file(std::string(TAKT_SOURCE_DIR) + "/scenarios/findings/README.md");
  for (std::string line; std::getline(file, line);) {
    if (!line.starts_with("| `")) continue;
    Row row;
    row.scenario = line.substr(3, line.find('`', 3) - 3);
    std::istringstream rest(line.substr(line.find('|', 3) + 1));
    std::string bar;
    rest >> row.property >> bar;
    row.query.variant = handshake::Variant::paper;
    row.query.finishes = false;
    for (std::string word; rest >> word && word != "|";) {
      std::string value;
      rest >> value;
      if (word.ends_with("--slaves")) row.query.slaves = static_cast<std::uint8_t>(std::stoi(value));
      if (word.ends_with("--calls")) row.query.commands = static_cast<std::uint32_t>(std::stoi(value));
      if (word.ends_with("--faults") && value.starts_with("crash")) row.query.faults.insert(Fault::crash);
    }
    rows.push_back(row);
  }
  return rows;
}

// Each row has its scenario and each scenario its row, and the explorer still finds it with the options that stand
// there.
TEST(Findings, StandInTheTable) {
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(std::string(TAKT_SOURCE_DIR) + "/scenarios/findings"))
    files += entry.path().extension() == ".json" ? 1U : 0U;
  const std::vector<Row> rows = table();
  EXPECT_EQ(rows.size(), files);
  for (const Row& row : rows) {
    SCOPED_TRACE(row.scenario);
    EXPECT_TRUE(
        std::filesystem::exists(std::string(TAKT_SOURCE_DIR) + "/scenarios/findings/" + row.scenario + ".json"));
    EXPECT_TRUE(row.scenario.ends_with(row.property));
    const SearchResult result = ask(row.query);
    for (std::size_t p = 0; p < property_count; ++p)
      if (property_names[p] == row.property) {
        EXPECT_EQ(result.verdicts[p], PropertyVerdict::violated);
      }
  }
}

}  // namespace
}  // namespace takt::explore
