// SPDX-License-Identifier: Apache-2.0
// Proofs of a solver that are made easy to check: each step follows from what it names, read as the judge reads it.
#include "schedule/trim.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "schedule/sat.hpp"
#include "sim/random.hpp"

namespace takt::schedule::trim_test {
namespace {

/// Whether none of the literals of the step can hold: each clause in turn leaves one literal, and the last one none.
bool follows(const ClausalProof& proof, std::size_t index) {
  const auto& [clause, from] = proof.steps[index];
  std::set<std::int32_t> is_false(clause.begin(), clause.end());
  for (const std::uint32_t each : from) {
    const std::size_t axioms = proof.axioms.size();
    if (each >= axioms + index) return false;
    const Clause& reason = each < axioms ? proof.axioms[each] : proof.steps[each - axioms].clause;
    std::set<std::int32_t> left;
    for (const std::int32_t literal : reason)
      if (!is_false.contains(literal)) left.insert(literal);
    if (left.empty()) return true;
    if (left.size() > 1 || is_false.contains(-*left.begin())) return false;
    is_false.insert(-*left.begin());
  }
  return false;
}

void expect_proof(const std::vector<Clause>& axioms, std::size_t variables, const std::string& text) {
  const auto trimmed = trim(axioms, std::vector<Threshold>(variables), text);
  ASSERT_TRUE(trimmed);
  for (std::size_t i = 0; i < trimmed->proof.steps.size(); ++i) EXPECT_TRUE(follows(trimmed->proof, i)) << "step " << i;
  const ClausalProof& proof = trimmed->proof;
  EXPECT_TRUE((proof.steps.empty() ? proof.axioms.back() : proof.steps.back().clause).empty());
}

// The unit {-1} makes a literal of the step {1, 2} false, as the step itself does when it is assumed not to hold.
TEST(Trim, AStepMayHoldALiteralThatAUnitMakesFalse) {
  expect_proof({{-1}, {1, 2, 3}, {1, 2, -3}, {-2, 4, 5}, {-2, 4, -5}, {-4, 6}, {-4, -6}}, 6, "1 2 0\n4 1 0\n0\n");
}

TEST(Trim, StepsOfRandomProofsFollow) {
  if (!has_sat_solver()) GTEST_SKIP() << "no solver";
  constexpr std::size_t variables = 40;
  int refuted = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    sim::RandomStream random(seed, "random", "clauses");
    const auto literal = [&] {
      const auto variable = static_cast<std::int32_t>(1 + random.below(variables));
      return random.below(2) == 0 ? variable : -variable;
    };
    std::vector<Clause> axioms;
    for (int i = 0; i < 210; ++i) {
      std::set<std::int32_t> clause;
      const std::size_t size = i % 60 == 0 ? 1 : 3;
      while (clause.size() < size)
        if (const std::int32_t next = literal(); !clause.contains(-next)) clause.insert(next);
      axioms.emplace_back(clause.begin(), clause.end());
    }
    const SatAnswer answer = solve(axioms, variables, 100'000, [] { return false; });
    if (answer.verdict != SatAnswer::Verdict::unsatisfiable) continue;
    ++refuted;
    if (trim(axioms, std::vector<Threshold>(variables), answer.proof)) expect_proof(axioms, variables, answer.proof);
  }
  EXPECT_GT(refuted, 50);
}

}  // namespace
}  // namespace takt::schedule::trim_test
