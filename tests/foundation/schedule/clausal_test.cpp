// SPDX-License-Identifier: Apache-2.0
// Proofs by clauses: they exist where there is no schedule, name no stream too many, and none is taken for one where
// there is a schedule.
#include "schedule/clausal.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "schedule/decide.hpp"
#include "schedule/refute.hpp"
#include "schedule/sat.hpp"
#include "schedule_check/instance_check.hpp"
#include "sim/random.hpp"
#include "small_problem.hpp"

namespace takt::schedule::clausal_test {
namespace {

constexpr Ps half_us = us / 2;

std::vector<StreamIndex> all_of(const Problem& problem) {
  std::vector<StreamIndex> streams(problem.streams.size());
  std::iota(streams.begin(), streams.end(), 0u);
  return streams;
}

std::optional<Certificate> refuted(const Problem& problem) {
  ClausalEffort effort;
  effort.most_thresholds = 100'000;
  return refute_streams(problem, all_of(problem), effort);
}

/// Streams that may not wait, over five links; bridges take 1 us.
void add_hurried(Problem& problem, Ps length_us, Ps period) {
  Stream& stream = add_stream(problem, "h0", "h3", length_us, period);
  stream.latency = 5 * (length_us * us - 96'000) + 4 * us;
}

// As in Refute.PairsThatCannotPassEachOther a frame of 1 us and one of 10 us, five links long, forbid each other 47 us
// of phases, ends excluded. Of a period of P that leaves P - 47 us and both ends for the short one; two short ones must
// be 1 us apart in that. So below 48 us three have no place, though each two have one.
Problem three(Ps period) {
  Problem problem = line(4, 0, us);
  problem.model.is_strict = true;
  add_hurried(problem, 1, period);
  add_hurried(problem, 10, period);
  add_hurried(problem, 1, period);
  return problem;
}

TEST(Clausal, ThreeThatPassEachOtherInPairsOnly) {
  if (!has_sat_solver()) GTEST_SKIP() << "no solver";
  const Problem problem = three(47 * us + half_us);
  EXPECT_FALSE(refute(problem)) << "no simple proof";
  const auto certificate = refuted(problem);
  ASSERT_TRUE(certificate);
  EXPECT_EQ(certificate->kind, Certificate::Kind::clausal);
  EXPECT_EQ(certificate->streams.size(), 3u);
  EXPECT_EQ(schedule_check::why_not_proved(problem, *certificate), "");
  const Decision decision = decide(problem, {});
  EXPECT_EQ(decision.verdict, Decision::Verdict::infeasible);
  EXPECT_FALSE(refuted(three(48 * us)));
  EXPECT_EQ(decide(three(48 * us), {}).verdict, Decision::Verdict::scheduled);
}

// A long frame loses 9 us a link against a short one. Who starts behind it waits on each link for what it has caught
// up, so with 3 us for waits the period must be 47 - 3 us at least. But on each link alone all 3 us are there, and then
// the phases that it forbids leave gaps.
TEST(Clausal, WaitsOfALinkAreNotHadOnTheNext) {
  if (!has_sat_solver()) GTEST_SKIP() << "no solver";
  Problem problem = line(4, 0, us);
  problem.model.is_strict = true;
  add_hurried(problem, 1, 43 * us + half_us);
  add_hurried(problem, 10, 43 * us + half_us);
  *problem.streams[0].latency += 3 * us;
  EXPECT_FALSE(refute(problem)) << "no simple proof";
  const auto certificate = refuted(problem);
  ASSERT_TRUE(certificate);
  EXPECT_EQ(schedule_check::why_not_proved(problem, *certificate), "");
  *problem.streams[0].latency += half_us;
  EXPECT_FALSE(refuted(problem));
  EXPECT_EQ(decide(problem, {}).verdict, Decision::Verdict::scheduled);
  EXPECT_NE(schedule_check::why_not_proved(problem, *certificate), "");
}

TEST(Clausal, DeadlinesBindToInstants) {
  if (!has_sat_solver()) GTEST_SKIP() << "no solver";
  // Two that must start within 9 us of each other, and one of 10 us between them in each order.
  Problem problem = three(100 * us);
  for (Stream& stream : problem.streams) {
    stream.deadline = *stream.latency + 20 * us;
    stream.latency.reset();
  }
  const auto certificate = refuted(problem);
  const Decision decision = decide(problem, {});
  EXPECT_EQ(certificate.has_value(), decision.verdict == Decision::Verdict::infeasible);
  for (Stream& stream : problem.streams) *stream.deadline -= 20 * us;
  const auto tight = refuted(problem);
  ASSERT_TRUE(tight) << "all must start at 0";
  EXPECT_EQ(tight->clauses.anchor, std::nullopt);
  EXPECT_EQ(schedule_check::why_not_proved(problem, *tight), "");
  EXPECT_EQ(tight->streams.size(), 2u);
}

// The core is planted among streams that have room enough, in any order.
TEST(Clausal, PlantedCoresAreFoundMinimal) {
  if (!has_sat_solver()) GTEST_SKIP() << "no solver";
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    sim::RandomStream random(seed, "planted", "core");
    Problem problem = three(47 * us + half_us);
    for (Stream& stream : problem.streams) stream.name = "core " + stream.name;
    const std::size_t others = 4 + random.below(8);
    for (std::size_t i = 0; i < others; ++i) {
      const std::size_t from = random.below(4), to = (from + 1 + random.below(3)) % 4;
      Stream& stream = add_stream(problem, "h" + std::to_string(from), "h" + std::to_string(to), 1,
                                  (47 * us + half_us) * static_cast<Ps>(10 << random.below(2)));
      stream.latency = 400 * us;
    }
    for (std::size_t i = problem.streams.size(); i > 1; --i)
      std::swap(problem.streams[i - 1], problem.streams[random.below(i)]);
    const Decision decision = decide(problem, {});
    ASSERT_TRUE(decision.certificate) << "seed " << seed;
    EXPECT_EQ(schedule_check::why_not_proved(problem, *decision.certificate), "");
    std::size_t planted = 0;
    for (const StreamIndex s : decision.certificate->streams) planted += problem.streams[s].name.starts_with("core");
    EXPECT_EQ(planted, 3u) << "seed " << seed;
    EXPECT_EQ(decision.certificate->streams.size(), 3u) << "seed " << seed;
  }
}

// A certificate that the judge rejects is no proof: the search goes on until it has another one, or is stopped.
TEST(Clausal, WhatTheJudgeRejectsIsNotProved) {
  if (!has_sat_solver()) GTEST_SKIP() << "no solver";
  const Problem problem = three(47 * us + half_us);
  SearchOptions options;
  std::size_t asked = 0;
  options.judge = [&](const Problem&, const Certificate&) { return ++asked < 3 ? "no" : ""; };
  Decision decision = decide(problem, options);
  EXPECT_EQ(decision.verdict, Decision::Verdict::infeasible);
  EXPECT_EQ(decision.rejected, (std::vector<std::string>{"no", "no"}));
  EXPECT_TRUE(decision.certificate);
  options.judge = [](const Problem&, const Certificate&) { return "never"; };
  decision = decide(problem, options);
  EXPECT_EQ(decision.verdict, Decision::Verdict::undecided);
  EXPECT_FALSE(decision.certificate);
  EXPECT_FALSE(decision.rejected.empty());
}

TEST(Clausal, SameForAnyNumberOfJobs) {
  if (!has_sat_solver()) GTEST_SKIP() << "no solver";
  const Problem problem = three(47 * us + half_us);
  SearchOptions options;
  const auto one = decide(problem, options);
  options.jobs = 3;
  const auto several = decide(problem, options);
  ASSERT_TRUE(one.certificate && several.certificate);
  EXPECT_EQ(one.certificate->clauses.axioms, several.certificate->clauses.axioms);
  EXPECT_EQ(one.certificate->clauses.steps, several.certificate->clauses.steps);
}

/// Something about the certificate is changed.
void spoil(Certificate& certificate, sim::RandomStream& random) {
  ClausalProof& proof = certificate.clauses;
  switch (random.below(9)) {
    case 0:
      proof.steps.pop_back();
      break;
    case 1:
      certificate.streams.erase(certificate.streams.begin() +
                                static_cast<std::ptrdiff_t>(random.below(certificate.streams.size())));
      break;
    case 2: {
      Clause& clause = proof.axioms[random.below(proof.axioms.size())];
      std::int32_t& literal = clause[random.below(clause.size())];
      literal = -literal;
      break;
    }
    case 3: {
      Clause& clause = proof.axioms[random.below(proof.axioms.size())];
      clause.erase(clause.begin() + static_cast<std::ptrdiff_t>(random.below(clause.size())));
      break;
    }
    case 4:
      proof.thresholds[random.below(proof.thresholds.size())].at += static_cast<Ps>(random.below(3 * us)) - us;
      break;
    case 5:
      proof.thresholds[random.below(proof.thresholds.size())].modulus = static_cast<Ps>(random.below(100)) * half_us;
      break;
    case 6:
      proof.thresholds[random.below(proof.thresholds.size())].stream = static_cast<StreamIndex>(random.below(4));
      break;
    case 7:
      proof.thresholds[random.below(proof.thresholds.size())].link = static_cast<LinkIndex>(random.below(20));
      break;
    default: {
      auto& from = proof.steps[random.below(proof.steps.size())].from;
      if (!from.empty())
        from[random.below(from.size())] =
            static_cast<std::uint32_t>(random.below(proof.axioms.size() + proof.steps.size() + 2));
    }
  }
}

// Of a problem that has a schedule nothing is proved, whatever the certificate of another one is made.
TEST(Clausal, NothingProvesWhatIsFalse) {
  if (!has_sat_solver()) GTEST_SKIP() << "no solver";
  const Problem infeasible = three(47 * us + half_us), feasible = three(48 * us);
  const auto good = refuted(infeasible);
  ASSERT_TRUE(good);
  EXPECT_NE(schedule_check::why_not_proved(feasible, *good), "");
  sim::RandomStream random(1, "spoil", "certificate");
  int refused = 0;
  constexpr int rounds = 400;
  for (int i = 0; i < rounds; ++i) {
    Certificate bad = *good;
    spoil(bad, random);
    if (i % 2 == 1) spoil(bad, random);
    EXPECT_NE(schedule_check::why_not_proved(feasible, bad), "");
    refused += schedule_check::why_not_proved(infeasible, bad) != "" ? 1 : 0;
  }
  // A threshold or a reason may be another one and the proof still be one; most are none any more.
  EXPECT_GT(refused, rounds * 3 / 4);
}

// Small problems whose streams cannot wait, against all starts on the grid that periods and lengths leave. Frames have
// neither preamble nor gap here, so all is whole us.
TEST(Clausal, AgreesWithAllStartsTriedOut) {
  if (!has_sat_solver()) GTEST_SKIP() << "no solver";
  const std::vector<std::vector<const char*>> paths = {
      {"h0>b0", "b0>b1", "b1>b2", "b2>h2"}, {"h1>b1", "b1>b2", "b2>h2"}, {"h0>b0", "b0>b1", "b1>h1"}};
  int impossible = 0, possible = 0;
  for (std::uint64_t seed = 1; seed <= 150; ++seed) {
    sim::RandomStream random(seed, "grid", "problem");
    Problem problem = line(3, 0, us);
    problem.model.is_strict = true;
    problem.model.preamble = problem.model.gap = 0;
    const Ps base = 4 + static_cast<Ps>(random.below(4));
    struct Passage {
      LinkIndex link;
      Ps lag, work;
    };
    std::vector<std::vector<Passage>> passages;
    for (int i = 0; i < 3; ++i) {
      const auto& path = paths[random.below(paths.size())];
      const Ps period = base * static_cast<Ps>(1 + random.below(3)) * us, length = 1 + static_cast<Ps>(random.below(3));
      Stream& stream = add_stream(problem, std::string(path.front(), 2), std::string(path.back() + 3, 2), 1, period);
      stream.octets = static_cast<std::uint32_t>(125 * length);
      const Ps links = static_cast<Ps>(path.size());
      stream.latency = (links * length + links - 1) * us;
      passages.emplace_back();
      for (Ps hop = 0; hop < links; ++hop)
        passages.back().push_back(
            {link_of(problem, path[static_cast<std::size_t>(hop)]), hop * (length + 1) * us, length * us});
    }
    const auto meet = [&](std::size_t a, Ps start_a, std::size_t b, Ps start_b) {
      const Ps every = std::gcd(problem.streams[a].period, problem.streams[b].period);
      for (const Passage& x : passages[a])
        for (const Passage& y : passages[b]) {
          const Ps apart = ((start_b + y.lag - start_a - x.lag) % every + every) % every;
          if (x.link == y.link && (apart < x.work || every - apart < y.work)) return true;
        }
      return false;
    };
    bool any = false;
    for (Ps a = 0; a < problem.streams[0].period && !any; a += us)
      for (Ps b = 0; b < problem.streams[1].period && !any; b += us)
        for (Ps c = 0; c < problem.streams[2].period && !any; c += us)
          any = !meet(0, a, 1, b) && !meet(0, a, 2, c) && !meet(1, b, 2, c);
    const auto certificate = refuted(problem);
    EXPECT_EQ(certificate.has_value(), !any) << "seed " << seed;
    if (certificate) {
      EXPECT_EQ(schedule_check::why_not_proved(problem, *certificate), "") << "seed " << seed;
    }
    (any ? possible : impossible) += 1;
  }
  EXPECT_GT(possible, 20);
  EXPECT_GT(impossible, 20);
}

TEST(Clausal, RefutesNothingThatHasASchedule) {
  if (!has_sat_solver()) GTEST_SKIP() << "no solver";
  int tried = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    Problem problem = random_problem(seed);
    problem.model.is_strict = true;
    for (Stream& stream : problem.streams) stream.listeners.resize(1);
    if (decide(problem, {}).verdict != Decision::Verdict::scheduled) continue;
    std::erase_if(problem.streams, [](const Stream& stream) { return !stream.latency && !stream.deadline; });
    if (problem.streams.size() < 2) continue;
    ++tried;
    ClausalEffort effort;
    EXPECT_FALSE(refute_streams(problem, all_of(problem), effort)) << "seed " << seed;
  }
  EXPECT_GT(tried, 20);
}

}  // namespace
}  // namespace takt::schedule::clausal_test
