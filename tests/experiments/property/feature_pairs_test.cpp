// SPDX-License-Identifier: Apache-2.0
// Every pair of features works, and so do triples: the wire checker finds nothing, and the run is a function of
// scenario and seed.
//
// All pairs are tried with a few seeds each; RapidCheck tries triples. TAKT_PAIR_SEEDS=20 and
// RC_PARAMS="max_success=10000" try harder. A scenario that fails is printed: keep it, shortened, under
// tests/regression/scenarios/.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cstdlib>

#include "tests/experiments/property/random_scenario.hpp"
#include "tests/simulation/scenario/support.hpp"
#include "tests/support/case_count.hpp"
#include "tests/wire_checker/verify.hpp"

namespace takt::property {
namespace {

constexpr int feature_count = static_cast<int>(Feature::count);

/// What is wrong with the scenario; "" if nothing is, or if it is refused (with a reason).
std::string fault_of(const std::string& text, bool* refused = nullptr) {
  const scenario::test::Loaded loaded = scenario::test::load(text);
  if (refused != nullptr) *refused = loaded.resolved == nullptr;
  if (!loaded.resolved) return loaded.diagnostics.has_errors() ? "" : "refused without a reason";
  return wire_checker::verify(*loaded.resolved);
}

std::string described(const Wishes& wishes) {
  std::string text;
  for (const Feature feature : wishes.features) text += std::string(name_of(feature)) + " ";
  return text + "with seed " + std::to_string(wishes.seed);
}

TEST(FeaturePairs, EveryPairWorks) {
  const std::uint64_t seeds = support::case_count("TAKT_PAIR_SEEDS", 2);
  int refusals = 0, tries = 0, failures = 0;
  for (int a = 0; a < feature_count; ++a) {
    for (int b = a; b < feature_count; ++b) {
      for (std::uint64_t seed = 0; seed < seeds; ++seed) {
        const std::uint64_t own_seed = seed * 1'000'000 + static_cast<std::uint64_t>(a * 1'000 + b);
        const Wishes wishes{{static_cast<Feature>(a), static_cast<Feature>(b)},
                            1 + own_seed % 4,
                            2 + own_seed % 3,
                            4 + own_seed % 4,
                            own_seed};
        const std::string text = scenario_text(wishes);
        bool refused = false;
        const std::string fault = fault_of(text, &refused);
        ++tries;
        refusals += refused ? 1 : 0;
        if (fault.empty()) continue;
        if (++failures <= 5) ADD_FAILURE() << described(wishes) << "\n" << fault << text;
      }
    }
  }
  EXPECT_EQ(failures, 0) << "of " << tries;
  EXPECT_LT(refusals, tries / 10) << "too many scenarios are refused to say anything";
}

TEST(FeaturePairs, TriplesWork) {
  EXPECT_TRUE(rc::check("a scenario with three features", [] {
    // 0 is no feature, so that a counter-example shrinks to the fewest.
    const auto below = [](int least, int end) {
      return rc::gen::resize(rc::kNominalSize, rc::gen::inRange(least, end));
    };
    Wishes wishes;
    for (int i = 0; i < 3; ++i)
      if (const int feature = *below(0, feature_count + 1).as("feature"); feature > 0)
        wishes.features.push_back(static_cast<Feature>(feature - 1));
    wishes.switches = static_cast<std::size_t>(*below(1, 6).as("switches"));
    wishes.hosts = static_cast<std::size_t>(*below(2, 6).as("hosts"));
    wishes.streams = static_cast<std::size_t>(*below(1, 9).as("streams"));
    wishes.seed = *rc::gen::arbitrary<std::uint64_t>().as("seed of the details");
    const std::string text = scenario_text(wishes);
    bool refused = false;
    const std::string fault = fault_of(text, &refused);
    RC_PRE(!refused);
    if (!fault.empty()) RC_FAIL(fault + text);
  }));
}

}  // namespace
}  // namespace takt::property
