// SPDX-License-Identifier: Apache-2.0
// What follows from runs and proofs, with each of them made by hand: no scenario of takt shows a proof that is wrong.
#include <gtest/gtest.h>

#include "verify/report.hpp"
#include "verify/verification.hpp"

namespace takt::verify::conclusions_test {
namespace {

using analysis::Assumption;
using analysis::Standing;
using sim::Duration;
using namespace sim::literals;  // NOLINT

/// A latency of at most 10 us: the worst run takes `seen`, the bound is `bound`.
struct Case {
  Search found;
  std::vector<Proof> proofs{1};
  analysis::AssumptionLedger ledger;

  explicit Case(std::optional<Duration> seen, std::optional<Duration> bound) {
    Finding finding;
    finding.requirement.kind = results::RequirementKind::latency;
    finding.requirement.text = "stream s latency at most 10us";
    finding.requirement.limit = 10_us;
    finding.simulated = finding.worst.measured = finding.longest.measured = seen;
    finding.worst.failed = !seen || *seen > 10_us;
    Ground ground;
    ground.whole.name = "worst";
    finding.worst.run = {std::make_shared<const Ground>(ground), std::make_shared<const Choice>()};
    found.findings.push_back(finding);
    proofs[0].time = bound;
    proofs[0].holds = bound && *bound <= 10_us;
    proofs[0].assumptions.add(Assumption::no_disturbance);
    ledger.discharge(Assumption::no_disturbance, "the test");
  }
  Verification concluded() const { return conclude(found, proofs, ledger); }
};

TEST(Conclusions, PassWithAProofThatStands) {
  const Verification found = Case(8_us, 9_us).concluded();
  EXPECT_EQ(found.lines[0].verdict, Conclusion::pass);
  EXPECT_EQ(found.lines[0].bound, 9_us);
  EXPECT_EQ(found.verdict(), Conclusion::pass);
  EXPECT_NEAR(*found.lines[0].tightness(), 8.0 / 9, 1e-9);
}

TEST(Conclusions, UndecidedWithoutOne) {
  const Verification beyond = Case(8_us, 11_us).concluded();
  EXPECT_EQ(beyond.lines[0].verdict, Conclusion::undecided);
  EXPECT_EQ(beyond.lines[0].reason, "no run that was found exceeds the limit, but the bound does");
  EXPECT_EQ(beyond.verdict(), Conclusion::undecided);
  EXPECT_EQ(Case(8_us, {}).concluded().lines[0].verdict, Conclusion::undecided);
}

// Open, violated by the scenario, from later on than the requirement counts, or violated in a run: no bound is shown,
// nothing is proved.
TEST(Conclusions, UndecidedWithAProofThatDoesNotStand) {
  std::vector<Case> cases(4, Case(8_us, 9_us));
  cases[0].ledger.leave_open(Assumption::no_disturbance, "nobody knows");
  cases[1].ledger.violate(Assumption::no_disturbance, "the scenario");
  cases[2].ledger.state(Assumption::no_disturbance, "calm", 5_ms);
  cases[3].found.violations.push_back({Assumption::no_disturbance, "a run"});
  const char* const reasons[] = {"which is not proved: nobody knows", "which is refuted: the scenario",
                                 "which is so from 5ms on", "which is refuted: a run"};
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const Verification found = cases[i].concluded();
    EXPECT_EQ(found.lines[0].verdict, Conclusion::undecided) << i;
    EXPECT_FALSE(found.lines[0].bound) << i;
    EXPECT_NE(found.lines[0].reason.find(reasons[i]), std::string::npos) << found.lines[0].reason;
    EXPECT_FALSE(found.contradiction) << i;
  }
  EXPECT_EQ(cases[3].concluded().ledger[Assumption::no_disturbance].standing, Standing::violated);
}

TEST(Conclusions, RefutedByARun) {
  const Verification found = Case(12_us, 13_us).concluded();
  EXPECT_EQ(found.lines[0].verdict, Conclusion::refuted);
  EXPECT_EQ(found.lines[0].reason, "a run exceeds the limit");
  EXPECT_FALSE(found.contradiction);
  EXPECT_EQ(found.verdict(), Conclusion::refuted);
}

// The proof stands, and a run fails: one of them is wrong.
TEST(Conclusions, AProofThatARunFailsIsAContradiction) {
  Case wrong(12_us, 9_us);
  const Verification found = wrong.concluded();
  ASSERT_TRUE(found.contradiction);
  EXPECT_EQ(found.contradiction->text, "stream s latency at most 10us: a run fails what is proved");
  EXPECT_EQ(found.contradiction->run.name, "worst");
  EXPECT_EQ(found.verdict(), Conclusion::contradiction);
  wrong.ledger.leave_open(Assumption::no_disturbance, "nobody knows");
  EXPECT_FALSE(wrong.concluded().contradiction);
  EXPECT_EQ(wrong.concluded().verdict(), Conclusion::refuted);
}

// It fails since nothing came, of which no bound says anything.
TEST(Conclusions, WantOfAFrameIsNoContradiction) {
  const Verification found = Case({}, 9_us).concluded();
  EXPECT_EQ(found.lines[0].verdict, Conclusion::refuted);
  EXPECT_FALSE(found.contradiction);
}

// Violations that are reported only are no failure, and no proof: how many a run had is said.
TEST(Conclusions, ReportedOnlyIsAVerdictOfItsOwn) {
  Case all(8_us, 9_us);
  Finding finding;
  finding.requirement.kind = results::RequirementKind::invariants;
  finding.requirement.text = "program p keeps S1 to S5 (reported only)";
  finding.broken = 3;
  all.found.findings.push_back(finding);
  all.proofs.emplace_back().is_reported_only = true;
  const Verification found = all.concluded();
  EXPECT_EQ(found.lines[1].verdict, Conclusion::reported);
  EXPECT_EQ(found.lines[1].violations, 3u);
  EXPECT_FALSE(found.lines[0].violations);
  EXPECT_EQ(found.verdict(), Conclusion::pass) << "of what is asked";
  const std::string page = text_report("s", found, {"", ""});
  EXPECT_NE(page.find("1 of 1 requirements proved, 1 reported only"), std::string::npos) << page;
  EXPECT_NE(page.find("reported only: up to 3 violations in a run"), std::string::npos) << page;
  Verification alone = found;
  alone.lines.erase(alone.lines.begin());
  EXPECT_EQ(alone.verdict(), Conclusion::reported);
}

TEST(Conclusions, TheWorstLineIsTheVerdict) {
  Case all(8_us, 9_us);
  const auto add = [&](const Case& other) {
    all.found.findings.push_back(other.found.findings[0]);
    all.proofs.push_back(other.proofs[0]);
  };
  add(Case(8_us, 9_us));
  EXPECT_EQ(all.concluded().verdict(), Conclusion::pass);
  all.found.partial = true;
  EXPECT_EQ(all.concluded().verdict(), Conclusion::undecided) << "interrupted";
  all.found.partial = false;
  add(Case(8_us, 11_us));
  EXPECT_EQ(all.concluded().verdict(), Conclusion::undecided);
  add(Case(12_us, 13_us));
  EXPECT_EQ(all.concluded().verdict(), Conclusion::refuted);
  add(Case(12_us, 9_us));
  EXPECT_EQ(all.concluded().verdict(), Conclusion::contradiction);
}

}  // namespace
}  // namespace takt::verify::conclusions_test
