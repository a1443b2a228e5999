// SPDX-License-Identifier: Apache-2.0
// Scenarios beside profiles: each rule is met by one and missed by another.
#include "profile/profile.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "scenario/resolve.hpp"

namespace takt::profile::test::profile_test {
namespace {

Report judged(const std::string& name, const std::string& members, const std::string& of_switch = "",
              const std::string& links = R"({"ends": ["a", "s"]}, {"ends": ["b", "s"]})") {
  json::Diagnostics diagnostics;
  const auto resolved = scenario::load_text(
      R"({"name": "t", "duration": "1s", "network": {"nodes": {"a": {"kind": "host"}, "b": {"kind": "host"}, "s": {"kind": "switch")" +
          of_switch + "}}, \"links\": [" + links + "]}" + members + "}",
      "s.json", {}, diagnostics);
  if (!resolved) throw std::runtime_error(diagnostics.to_text());
  return judge(*find_profile(name), *resolved);
}

const Finding& finding(const Report& report, std::string_view rule) {
  const auto found = std::ranges::find(report.findings, rule, &Finding::rule);
  if (found == report.findings.end()) throw std::runtime_error("no rule " + std::string(rule));
  return *found;
}

const std::string slow_gptp = R"(, "clocks": {"all": {"offset": {"from": "-60ppm", "to": "10ppm"}, "drift": "2ppm",
  "granularity": "10ns"}, "gptp": {"log_sync_interval": -4, "processing": "16ms"}}, "require": [{"sync": "2us", "after": "500ms"}])";
const std::string good_gptp = R"(, "clocks": {"all": {"offset": {"from": "-50ppm", "to": "50ppm"}, "drift": "1ppm",
  "granularity": "8ns"}, "gptp": {"log_sync_interval": -3, "log_pdelay_interval": -3, "processing": "15ms",
  "drift_tracking": true}}, "require": [{"sync": "1us", "after": "500ms"}])";

TEST(Profiles, EveryRuleSaysSomething) {
  for (const Profile& profile : profiles()) {
    const Report report = judged(std::string(profile.name), "");
    for (const Rule& rule : profile.rules) EXPECT_EQ(finding(report, rule.name).clause, rule.clause) << profile.name;
  }
}

TEST(Profile60802, SynchronisationIsJudged) {
  const Report missed = judged("60802", slow_gptp);
  const Report met = judged("60802", good_gptp);
  const Report unknown = judged("60802", "");
  for (const char* const rule :
       {"Frequency of clocks", "Drift of clocks", "Granularity of time stamps", "Sync interval", "Pdelay interval",
        "Residence and turn-around time", "Drift tracking", "Working Clock: offset from the grandmaster"}) {
    EXPECT_EQ(finding(missed, rule).verdict, Verdict::missed) << rule << ": " << finding(missed, rule).found;
    EXPECT_EQ(finding(met, rule).verdict, Verdict::met) << rule << ": " << finding(met, rule).found;
    EXPECT_EQ(finding(unknown, rule).verdict, Verdict::unknown) << rule << ": " << finding(unknown, rule).found;
  }
  EXPECT_EQ(missed.verdict, Verdict::missed);
  EXPECT_EQ(finding(missed, "Sync interval").found, "62.5ms");
  EXPECT_EQ(finding(missed, "Sync interval").pointer, "/clocks/gptp/log_sync_interval");
  EXPECT_EQ(finding(met, "Links from a grandmaster to a clock").found, "2 links between the farthest two");
}

TEST(Profile60802, BridgesAreJudged) {
  EXPECT_EQ(finding(judged("60802", "", R"(, "traffic_classes": 3)"), "Traffic classes of bridges").verdict,
            Verdict::missed);
  EXPECT_EQ(finding(judged("60802", "", R"(, "traffic_classes": 4)"), "Traffic classes of bridges").found,
            "class B: s with 4");
  EXPECT_EQ(finding(judged("60802", ""), "Traffic classes of bridges").found, "class A: eight at all bridges");
  EXPECT_EQ(finding(judged("60802", "", R"(, "gates": "none")"), "Scheduled traffic at bridges").verdict,
            Verdict::missed);
  const std::string device = R"(, "device": ")" + std::string(TAKT_SOURCE_DIR) + R"(/devices/conext22-switch.json")";
  const Report known = judged("60802", "", device);
  EXPECT_EQ(finding(known, "Scheduled traffic at bridges").verdict, Verdict::met);
  EXPECT_EQ(finding(known, "Frame preemption at bridges").verdict, Verdict::met);
  EXPECT_EQ(finding(known, "Delays of bridges").verdict, Verdict::met);
}

TEST(ProfileUafx, TheDefaultOfProgramsIsAFinding) {
  const std::string program = R"(, "programs": [{"name": "p", "master": "a", "slaves": ["b"], "cycle": "1ms")";
  const Report six = judged("uafx", program + "}]");
  EXPECT_EQ(finding(six, "Messages of Programs and topics").verdict, Verdict::missed);
  EXPECT_NE(finding(six, "Messages of Programs and topics").found.find("the default of a Program"), std::string::npos);
  EXPECT_EQ(finding(judged("uafx", program + R"(, "pcp": 4}])"), "Messages of Programs and topics").verdict,
            Verdict::met);
  const std::string stream =
      R"(, "streams": [{"name": "x", "from": "a", "to": "b", "payload": "64B", "every": "1ms", "pcp": )";
  EXPECT_EQ(finding(judged("uafx", stream + "7}]"), "Other streams in reserved priorities").verdict, Verdict::missed);
  EXPECT_EQ(finding(judged("uafx", stream + "2}]"), "Other streams in reserved priorities").verdict, Verdict::met);
  EXPECT_EQ(finding(judged("uafx", R"(, "clocks": {"gptp": {}})"), "gPTP").verdict, Verdict::missed);
}

TEST(ProfileAvb, ReservedStreamsNeedShapersAboveAllElse) {
  const std::string streams =
      R"(, "clocks": {"gptp": {}}, "streams": [{"name": "x", "from": "a", "to": "b", "payload": "64B", "every": "1ms", "pcp": 3})";
  const Report bare = judged("802.1BA", streams + "]");
  EXPECT_EQ(finding(bare, "Shapers of classes A and B").verdict, Verdict::missed);
  EXPECT_EQ(finding(bare, "Traffic above classes A and B").verdict, Verdict::met);
  EXPECT_EQ(
      finding(
          judged("802.1BA",
                 streams + R"(, {"name": "y", "from": "a", "to": "b", "payload": "64B", "every": "1ms", "pcp": 6}])"),
          "Traffic above classes A and B")
          .verdict,
      Verdict::missed);
  const std::string shaped = R"(, "egress": [{"shapers": [{"class": 3, "idle_slope": "800Mbps"}]}])";
  const Report greedy = judged("802.1BA", streams + "]", shaped);
  EXPECT_EQ(finding(greedy, "Bandwidth of classes A and B").verdict, Verdict::missed);
  EXPECT_EQ(finding(greedy, "Announce interval").verdict, Verdict::met);
  const Report slow = judged("802.1BA", streams + "]", "",
                             R"({"ends": ["a", "s"], "rate": "10Mbps"}, {"ends": ["b", "s"], "delay": "1us"})");
  EXPECT_EQ(finding(slow, "Links").verdict, Verdict::missed);
  EXPECT_EQ(finding(slow, "Delay of cables").verdict, Verdict::missed);
}

}  // namespace
}  // namespace takt::profile::test::profile_test
