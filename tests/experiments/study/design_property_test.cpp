// SPDX-License-Identifier: Apache-2.0
// Designs whatever the factors: counts, strata, constraints, seeds, shards.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <functional>
#include <map>
#include <set>

#include "sim/random.hpp"
#include "study/design.hpp"
#include "study/runner.hpp"
#include "support.hpp"

namespace takt::study {
namespace {

/// Factors f0, f1 ... with the levels 0 .. n-1, or a range of them.
std::string factors_text(const std::vector<int>& sizes) {
  std::string text = "\"factors\": [";
  for (std::size_t f = 0; f < sizes.size(); ++f) {
    text += (f == 0 ? "" : ", ") + std::string("{\"name\": \"f") + std::to_string(f) + "\", \"set\": [\"/x" +
            std::to_string(f) + "\"], ";
    // A single level has to be a value; others are written both ways.
    if (sizes[f] > 1 && f % 2 == 0) {
      text += "\"range\": {\"from\": 0, \"to\": " + std::to_string(sizes[f] - 1) + "}}";
    } else {
      text += "\"values\": [";
      for (int level = 0; level < sizes[f]; ++level) text += (level == 0 ? "" : ", ") + std::to_string(level);
      text += "]}";
    }
  }
  return text + "]";
}

using Point = std::vector<int>;

Point numbers_of(const Plan& plan, const Variant& variant) {
  Point numbers;
  for (std::size_t f = 0; f < variant.size(); ++f)
    numbers.push_back(static_cast<int>(*plan.level_of(variant, f).number));
  return numbers;
}

std::multiset<Point> points_of(const Plan& plan) {
  std::multiset<Point> points;
  for (const Variant& variant : plan.variants) points.insert(numbers_of(plan, variant));
  return points;
}

/// Every combination, one way or the other.
std::vector<Point> everything(const std::vector<int>& sizes) {
  std::vector<Point> all = {{}};
  for (const int size : sizes) {
    std::vector<Point> longer;
    for (const Point& point : all)
      for (int level = 0; level < size; ++level) {
        longer.push_back(point);
        longer.back().push_back(level);
      }
    all = std::move(longer);
  }
  return all;
}

/// Whatever the size that RapidCheck has come to: small ones have all small sizes else.
template <class T>
T in_range(T from, T to) {
  return *rc::gen::resize(100, rc::gen::inRange<T>(from, to));
}

/// A condition as the study says it, and as the test does.
struct Condition {
  std::string text;
  std::function<bool(const Point&)> holds;
};

Condition some_condition(std::size_t factors) {
  const auto a = in_range<std::size_t>(0, factors);
  const auto b = in_range<std::size_t>(0, factors);
  const int k = in_range(0, 6);
  const std::string fa = "f" + std::to_string(a);
  const std::string fb = "f" + std::to_string(b);
  const std::string number = std::to_string(k);
  switch (in_range(0, 5)) {
    case 0:
      return {fa + " + " + fb + " <= " + number, [=](const Point& p) { return p[a] + p[b] <= k; }};
    case 1:
      return {fa + " * 2 >= " + fb, [=](const Point& p) { return p[a] * 2 >= p[b]; }};
    case 2:
      return {fa + " != " + number, [=](const Point& p) { return p[a] != k; }};
    case 3:
      return {fa + " < " + number + " || " + fb + " == " + number,
              [=](const Point& p) { return p[a] < k || p[b] == k; }};
    default:
      return {"!(" + fa + " > " + number + " && " + fb + " > " + number + ")",
              [=](const Point& p) { return !(p[a] > k && p[b] > k); }};
  }
}

std::vector<int> some_sizes() {
  std::vector<int> sizes(in_range<std::size_t>(1, 5));
  for (int& size : sizes) size = in_range(1, 6);
  return sizes;
}

/// The plan, or nothing where no combination is left.
std::unique_ptr<Plan> planned(const Folder& folder, const std::string& members) {
  std::string problems;
  auto plan = plan_of(folder, members, &problems);
  if (!plan && problems.find("no combination of levels is left") == std::string::npos) RC_FAIL(problems);
  return plan;
}

std::string constraints_text(const std::vector<Condition>& conditions) {
  std::string text = ", \"constraints\": [";
  for (std::size_t i = 0; i < conditions.size(); ++i) text += (i == 0 ? "\"" : ", \"") + conditions[i].text + "\"";
  return text + "]";
}

TEST(DesignProperty, AGridIsTheProductOfItsLevels) {
  const Folder folder;
  EXPECT_TRUE(rc::check("grid = product", [&] {
    const std::vector<int> sizes = some_sizes();
    const auto plan = planned(folder, factors_text(sizes));
    const std::vector<Point> all = everything(sizes);
    RC_ASSERT(plan->variants.size() == all.size());
    RC_ASSERT(points_of(*plan) == std::multiset<Point>(all.begin(), all.end()));
  }));
}

TEST(DesignProperty, ConstraintsLeaveWhatKeepsThem) {
  const Folder folder;
  std::size_t some_left = 0;
  EXPECT_TRUE(rc::check("constraints filter", [&] {
    const std::vector<int> sizes = some_sizes();
    std::vector<Condition> conditions = {some_condition(sizes.size())};
    if (in_range(0, 2) == 1) conditions.push_back(some_condition(sizes.size()));
    std::multiset<Point> expected;
    const std::vector<Point> all = everything(sizes);
    for (const Point& point : all)
      if (std::all_of(conditions.begin(), conditions.end(),
                      [&](const Condition& condition) { return condition.holds(point); }))
        expected.insert(point);
    const auto plan = planned(folder, factors_text(sizes) + constraints_text(conditions));
    RC_ASSERT((plan != nullptr) == !expected.empty());
    if (!plan) return;
    RC_ASSERT(points_of(*plan) == expected);
    some_left += expected.size() < all.size() ? 1 : 0;
  }));
  EXPECT_GT(some_left, 20u) << "the conditions exclude something";
}

TEST(DesignProperty, OneAtATime) {
  const Folder folder;
  EXPECT_TRUE(rc::check("one at a time", [&] {
    const std::vector<int> sizes = some_sizes();
    const auto plan = planned(folder, factors_text(sizes) + R"(, "design": "one-at-a-time")");
    std::size_t expected = 1;
    for (const int size : sizes) expected += static_cast<std::size_t>(size - 1);
    RC_ASSERT(plan->variants.size() == expected);
    const Point base = numbers_of(*plan, plan->variants[0]);
    std::vector<std::set<int>> seen(sizes.size());
    for (const Variant& variant : plan->variants) {
      const Point point = numbers_of(*plan, variant);
      std::size_t changed = 0;
      for (std::size_t f = 0; f < sizes.size(); ++f) {
        changed += point[f] != base[f] ? 1 : 0;
        seen[f].insert(point[f]);
      }
      RC_ASSERT(changed <= 1u);
    }
    for (std::size_t f = 0; f < sizes.size(); ++f) RC_ASSERT(seen[f].size() == static_cast<std::size_t>(sizes[f]));
    RC_ASSERT(points_of(*plan).size() == [&] {
      const auto points = points_of(*plan);
      return std::set<Point>(points.begin(), points.end()).size();
    }());
  }));
}

// A factor with k times as many levels as points: each stratum of k levels has one point.
TEST(DesignProperty, ALatinHypercubeHasEachStratumOnce) {
  const Folder folder;
  EXPECT_TRUE(rc::check("strata once", [&] {
    const int points = in_range(2, 40);
    std::vector<int> sizes;
    for (int f = in_range(1, 4); f > 0; --f) sizes.push_back(points * in_range(1, 6));
    const auto seed = in_range<std::uint32_t>(1, 1'000'000);
    const auto plan = planned(folder, factors_text(sizes) + R"(, "design": {"kind": "latin-hypercube", "points": )" +
                                          std::to_string(points) + ", \"seed\": " + std::to_string(seed) + "}");
    RC_ASSERT(plan->variants.size() == static_cast<std::size_t>(points));
    for (std::size_t f = 0; f < sizes.size(); ++f) {
      std::set<int> strata;
      for (const Variant& variant : plan->variants) strata.insert(numbers_of(*plan, variant)[f] / (sizes[f] / points));
      RC_ASSERT(strata.size() == static_cast<std::size_t>(points));
      RC_ASSERT(*strata.begin() == 0);
      RC_ASSERT(*strata.rbegin() == points - 1);
    }
  }));
}

TEST(DesignProperty, ARandomDesignDrawsWithoutRepetition) {
  const Folder folder;
  EXPECT_TRUE(rc::check("random", [&] {
    const std::vector<int> sizes = some_sizes();
    std::size_t space = 1;
    for (const int size : sizes) space *= static_cast<std::size_t>(size);
    const auto wanted = in_range<std::size_t>(1, 30);
    const Condition condition = some_condition(sizes.size());
    const bool is_constrained = in_range(0, 2) == 1;
    const std::string text = factors_text(sizes) + R"(, "design": {"kind": "random", "points": )" +
                             std::to_string(wanted) + ", \"seed\": " + std::to_string(in_range(1, 1'000'000)) + "}" +
                             (is_constrained ? constraints_text({condition}) : "");
    const auto plan = planned(folder, text);
    if (!plan) return;
    const std::multiset<Point> points = points_of(*plan);
    RC_ASSERT(std::set<Point>(points.begin(), points.end()).size() == points.size());
    RC_ASSERT(points.size() <= std::min(wanted, space));
    // A hundred draws for each point find half a space for sure (to 2^-100).
    if (!is_constrained && 2 * wanted <= space) RC_ASSERT(points.size() == wanted);
    for (const Point& point : points) RC_ASSERT(!is_constrained || condition.holds(point));
    RC_ASSERT(planned(folder, text)->variants == plan->variants);
  }));
}

// All variants run with the same seeds, and each point is one variant with one of them.
TEST(DesignProperty, SeedsAreReplications) {
  const Folder folder;
  EXPECT_TRUE(rc::check("seeds", [&] {
    const std::vector<int> sizes = some_sizes();
    const auto count = in_range<std::uint64_t>(1, 8);
    const auto first = in_range<std::uint64_t>(1, 1'000'000);
    const auto plan = planned(folder, factors_text(sizes) + ", \"replications\": {\"count\": " + std::to_string(count) +
                                          ", \"first_seed\": " + std::to_string(first) + "}");
    RC_ASSERT(plan->points() == plan->variants.size() * count);
    std::map<std::size_t, std::set<std::uint64_t>> seeds;
    for (std::uint64_t point = 0; point < plan->points(); ++point)
      RC_ASSERT(seeds[plan->variant_of(point)].insert(plan->seed_of(point)).second);
    RC_ASSERT(seeds.size() == plan->variants.size());
    for (const auto& [variant, of_variant] : seeds) {
      RC_ASSERT(of_variant.size() == count);
      RC_ASSERT(*of_variant.begin() == first);
      RC_ASSERT(*of_variant.rbegin() == first + count - 1);
    }
  }));
}

// Every point belongs to one shard, and the shards are about equal.
TEST(DesignProperty, ShardsAreDisjointAndWhole) {
  EXPECT_TRUE(rc::check("shards", [] {
    const auto points = in_range<std::uint64_t>(0, 500);
    const auto count = in_range<std::uint64_t>(1, 60);
    std::vector<std::uint64_t> sizes(count, 0);
    for (std::uint64_t point = 0; point < points; ++point) {
      std::size_t owners = 0;
      for (std::uint64_t index = 1; index <= count; ++index)
        if (Shard{index, count}.has(point)) {
          ++owners;
          ++sizes[index - 1];
        }
      RC_ASSERT(owners == 1u);
    }
    RC_ASSERT(*std::max_element(sizes.begin(), sizes.end()) - *std::min_element(sizes.begin(), sizes.end()) <= 1u);
  }));
}

/// The rows of a store, and how many.
std::pair<std::uint64_t, std::uint64_t> digest_of(const Store& store) {
  std::uint64_t digest = 0;
  std::uint64_t count = 0;
  EXPECT_EQ(store.results_digest(digest, count), "");
  return {digest, count};
}

std::pair<std::uint64_t, std::uint64_t> run_to(const Plan& plan, const std::string& path, unsigned jobs, Shard shard) {
  std::string problem;
  const auto store = Store::create(path, plan, problem);
  EXPECT_EQ(problem, "");
  const RunOptions options{.jobs = jobs, .shard = shard, .progress = {}, .interrupted = {}};
  EXPECT_EQ(run_study(plan, *store, options, std::vector<bool>(plan.points(), false)).problem, "");
  return digest_of(*store);
}

// The union of the shards, each with its own number of jobs, is the whole.
TEST(DesignProperty, ResultsDoNotDependOnJobsAndShards) {
  // Each case runs processes: few of them.
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const Folder folder;
    sim::RandomStream chance(seed, "shards", "test");
    const auto plan = plan_of(
        folder,
        R"("replications": 2, "factors": [{"name": "size", "set": ["/streams/0/payload"], "values": ["100B", "200B", "300B"]},
        {"name": "every", "set": ["/streams/0/exponential"], "range": {"from": "20us", "to": "90us"}}], "design": {"kind": "latin-hypercube", "points": )" +
            std::to_string(3 + chance.below(6)) + ", \"seed\": " + std::to_string(seed) + "}");
    ASSERT_TRUE(plan);
    const auto whole = run_to(*plan, folder.file("whole"), 1, {});
    EXPECT_EQ(whole.second, plan->points());
    const std::uint64_t count = 2 + chance.below(4);
    std::vector<std::string> parts;
    std::uint64_t rows = 0;
    for (std::uint64_t index = 1; index <= count; ++index) {
      parts.push_back(folder.file("part" + std::to_string(index)));
      rows += run_to(*plan, parts.back(), 1 + static_cast<unsigned>(chance.below(3)), {index, count}).second;
    }
    EXPECT_EQ(rows, whole.second);
    ASSERT_EQ(merge_stores(folder.file("all"), parts), "");
    std::string problem;
    EXPECT_EQ(digest_of(*Store::open(folder.file("all"), problem)), whole);
  }
}

}  // namespace
}  // namespace takt::study
