// SPDX-License-Identifier: Apache-2.0
// Published figures: how tables are read, how figures are judged.
#include "papers/validation/validation.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "papers/validation/report.hpp"

namespace takt::papers::validation {
namespace {

/// A folder with one table.
class Tables {
 public:
  explicit Tables(const std::string& text)
      : folder_(std::filesystem::path(::testing::TempDir()) /
                ::testing::UnitTest::GetInstance()->current_test_info()->name()) {
    std::filesystem::create_directories(folder_);
    std::ofstream(folder_ / "table.json") << text;
  }
  ~Tables() { std::filesystem::remove_all(folder_); }
  Tables(const Tables&) = delete;
  Tables& operator=(const Tables&) = delete;

  std::optional<Validation> validate(bool is_short = false) {
    Options options;
    options.tables = folder_.string();
    options.is_short = is_short;
    options.jobs = 2;
    json::Diagnostics diagnostics;
    auto made = validation::validate(options, diagnostics);
    problem_ = diagnostics.to_text();
    return made;
  }
  const std::string& problem() const { return problem_; }

 private:
  std::filesystem::path folder_;
  std::string problem_;
};

// 100 octets of payload are 146 untagged and 154 with preamble: 12.32 us at 100 Mb/s, and 50 ns of cable.
constexpr const char* cable =
    R"("cable": {"name": "cable", "duration": "10ms", "network": {"nodes": {"a": {"kind": "host"}, "b": {"kind": "host"}},
  "links": [{"ends": ["a", "b"], "rate": "100Mbps", "delay": "50ns"}]}, "streams": [{"name": "s", "from": "a", "to": "b", "payload": "100B", "every": "1ms"}]})";
// One server of rate 10 after 10, two flows of burst 25 and rate 5: 10 + 50 / 10 = 15.
constexpr const char* server =
    R"("server": {"servers": {"s": {"rate": 10, "latency": 10}}, "flows": {"f": {"path": ["s"], "rate": 5, "burst": 25}, "g": {"path": ["s"], "rate": 5, "burst": 25}}})";

std::string table(const std::string& figures) {
  return std::string(R"({"source": "source", "reference": "r", "templates": {)") + cable + ", " + server + "}, " +
         figures + "}";
}

Agreement verdict_of(const std::string& figure) {
  Tables tables(table(R"("figures": [{"what": "w", )" + figure + "}]"));
  const auto made = tables.validate();
  EXPECT_TRUE(made) << tables.problem();
  return made ? made->figures.at(0).verdict : Agreement::missed;
}

TEST(Judge, EqualWithinAndOneSided) {
  const std::string of = R"("scenario": "cable", "figure": "latency.s.max", )";
  EXPECT_EQ(verdict_of(of + R"("published": 12.37)"), Agreement::met);
  EXPECT_EQ(verdict_of(of + R"("published": 12.371)"), Agreement::missed);
  EXPECT_EQ(verdict_of(of + R"("published": 12.371, "within": 0.001)"), Agreement::met);
  EXPECT_EQ(verdict_of(of + R"("published": 12.371, "within": 0.0009)"), Agreement::missed);
  EXPECT_EQ(verdict_of(of + R"("published": 13, "percent": 5)"), Agreement::met);  // 0.63 of 0.65
  EXPECT_EQ(verdict_of(of + R"("published": 13, "percent": 4)"), Agreement::missed);
  EXPECT_EQ(verdict_of(of + R"("published": 12, "must_be": "at_least")"), Agreement::met);
  EXPECT_EQ(verdict_of(of + R"("published": 12, "must_be": "at_most")"), Agreement::missed);
  EXPECT_EQ(verdict_of(of + R"("published": 13, "must_be": "at_most")"), Agreement::met);
  EXPECT_EQ(verdict_of(of + R"("published": 13, "must_be": "at_least")"), Agreement::missed);
  EXPECT_EQ(verdict_of(of + R"("published": 13, "must_be": "at_least", "percent": 5)"), Agreement::met);
  EXPECT_EQ(verdict_of(of + R"("published": 12.32, "shift": 0.05)"), Agreement::met);
  EXPECT_EQ(verdict_of(of + R"("published": 12370, "unit": "ns")"), Agreement::met);
}

TEST(Judge, WhatIsKnownToDifferAndWhatWasFitted) {
  const std::string of = R"("scenario": "cable", "figure": "latency.s.max", )";
  EXPECT_EQ(verdict_of(of + R"("published": 13, "differs": "why")"), Agreement::differs);
  EXPECT_EQ(verdict_of(of + R"("published": 12.37, "differs": "why")"), Agreement::met_after_all);
  EXPECT_EQ(verdict_of(of + R"("published": 12.37, "differs": "")"), Agreement::met);
  EXPECT_EQ(verdict_of(of + R"("published": 12.37, "is_calibrated": true)"), Agreement::calibrated);
  EXPECT_EQ(verdict_of(of + R"("published": 13, "is_calibrated": true)"), Agreement::missed);
}

TEST(Judge, BoundsAndTheWorstRun) {
  EXPECT_EQ(verdict_of(R"("scenario": "cable", "bound": "s", "published": 12.37)"), Agreement::met);
  EXPECT_EQ(verdict_of(R"("scenario": "cable", "fastest": "s", "published": 12.37)"), Agreement::met);
  EXPECT_EQ(verdict_of(R"("scenario": "cable", "worst": "s", "published": 12.37)"), Agreement::met);
  // Random gaps have no bound: that is no answer unless the source has none either.
  const std::string unbounded =
      R"("scenario": "cable", "set": {"/streams/0": {"name": "s", "from": "a", "to": "b", "payload": "100B", "exponential": "1ms"}}, "bound": "s", )";
  EXPECT_EQ(verdict_of(unbounded + R"("published": 12.37, "must_be": "at_least")"), Agreement::missed);
  EXPECT_EQ(verdict_of(unbounded + R"("published": 12.37, "must_be": "at_least", "may_be_unbounded": true)"),
            Agreement::met);
  EXPECT_EQ(verdict_of(unbounded + R"("published": "unbounded")"), Agreement::met);
  EXPECT_EQ(verdict_of(R"("scenario": "cable", "bound": "s", "published": "unbounded")"), Agreement::missed);
}

TEST(Judge, NetworksOfServersAreExact) {
  EXPECT_EQ(verdict_of(R"("scenario": "server", "flow": "f", "unit": "", "published": "15")"), Agreement::met);
  EXPECT_EQ(verdict_of(R"("scenario": "server", "flow": "f", "unit": "", "published": ["14", "15"])"), Agreement::met);
  EXPECT_EQ(verdict_of(R"("scenario": "server", "flow": "f", "unit": "", "published": "150000001/10000000")"),
            Agreement::missed);
  EXPECT_EQ(verdict_of(R"("scenario": "server", "flow": "f", "of": "backlog", "unit": "", "published": "150")"),
            Agreement::met);  // 50 + 10 * 10
}

constexpr const char* family =
    R"("families": [{"columns": ["octets", "delay", "known"], "factors": {"octets": {"100": {}, "200": {"/streams/0/payload": "200B"}}},
  "figures": [{"what": "{octets} octets", "scenario": "cable", "figure": "latency.s.max", "published": "{delay}"},
              {"what": "{octets} octets again", "scenario": "cable", "figure": "latency.s.min", "published": "{delay}"}],
  "when": [{}, {"known": true}], "short_every": 2, "rows": [[100, 12.37, true], [200, 20.37, false]]}])";

TEST(Tables, FamiliesBecomeFigures) {
  Tables tables(table(family));
  const auto made = tables.validate();
  ASSERT_TRUE(made) << tables.problem();
  ASSERT_EQ(made->figures.size(), 3u);
  EXPECT_EQ(made->figures[0].what, "100 octets");
  EXPECT_EQ(made->figures[1].what, "100 octets again");
  EXPECT_EQ(made->figures[2].takt, "20.37");
  EXPECT_EQ(made->count(Agreement::met), 3u);
  EXPECT_TRUE(made->holds());
  EXPECT_NE(markdown_report(*made).find("| 200 octets | 20.37 us | 20.37 us | 0 | equal | met |  |"),
            std::string::npos);
  EXPECT_EQ(tables.validate(true)->figures.size(), 2u);
}

TEST(Tables, MistakesAreSaid) {
  const auto problem_of = [](const std::string& figures) {
    Tables tables(table(figures));
    EXPECT_FALSE(tables.validate());
    return tables.problem();
  };
  EXPECT_NE(problem_of(R"("figures": [{"what": "w", "scenario": "none.json", "bound": "s", "published": 1}])")
                .find("none.json"),
            std::string::npos);
  EXPECT_NE(problem_of(R"("figures": [{"what": "w", "scenario": "cable", "bound": "t", "published": 1}])")
                .find("unknown stream"),
            std::string::npos);
  EXPECT_NE(problem_of(R"("figures": [{"what": "w", "scenario": "server", "flow": "t", "published": 1}])")
                .find("unknown flow"),
            std::string::npos);
  EXPECT_NE(problem_of(R"("figures": [{"what": "w", "scenario": "cable", "figure": "latncy.s.max", "published": 1}])")
                .find("latncy"),
            std::string::npos);
  EXPECT_NE(problem_of(R"("figures": [{"what": "w", "scenario": "cable", "published": 1}])").find("figure"),
            std::string::npos);
  std::string wrong = family;
  wrong.replace(wrong.find("[200, 20.37, false]"), 19, "[200, 20.37]");
  EXPECT_NE(problem_of(wrong).find("not a value for each column"), std::string::npos);
  wrong = family;
  wrong.replace(wrong.find("[200, 20.37, false]"), 19, "[300, 20.37, false]");
  EXPECT_NE(problem_of(wrong).find("a value that no factor knows"), std::string::npos);
}

}  // namespace
}  // namespace takt::papers::validation
