// SPDX-License-Identifier: Apache-2.0
// The generator leaves nothing out: every key of the schema, every word, every pair of features that may meet.
#include <gtest/gtest.h>

#include <map>

#include "json/document.hpp"
#include "tests/generator/generated.hpp"
#include "tests/generator/maker.hpp"

namespace takt::generator {
namespace {

std::string lines(const auto& texts) {
  std::string all;
  for (const auto& each : texts) all += "  " + std::string(each) + "\n";
  return all;
}

TEST(Generator, KnowsEveryKey) {
  EXPECT_EQ(lines(RuleBook::get().strays), "") << "rules for keys that the schema does not have";
  EXPECT_EQ(lines(keys_without_rule()), "") << "add a rule for these keys, in tests/generator/rules_*.cpp";
}

TEST(Generator, IsDeterministic) {
  for (const std::uint64_t number : {0ULL, 1ULL, 17ULL, 1'000'000'007ULL})
    EXPECT_EQ(generate(number).text, generate(number).text) << number;
}

TEST(Generator, UsesEveryKeyAndEveryPairOfFeatures) {
  Keys missing = all_keys();
  std::set<std::pair<Feature, Feature>> apart;
  for (const auto& pair : pairs()) apart.insert(pair);
  const std::size_t tries = 3 * pairs().size();
  std::size_t refused = 0, repaired = 0;
  std::map<std::string, std::pair<int, std::string>> reasons;
  for (std::uint64_t number = 0; number < tries; ++number) {
    const Generated made = generate(number);
    if (!made.first_refusal.empty()) {
      ++repaired;
      const std::size_t error = made.first_refusal.find("error at ");
      const std::string line = made.first_refusal.substr(error, made.first_refusal.find('\n', error) - error);
      const std::size_t colon = line.find(": ");
      auto& [count, example] = reasons[line.substr(colon + 2, line.find(':', colon + 2) - colon - 2)];
      ++count;
      example = std::to_string(number) + ": " + line;
    }
    if (!made.resolved) {
      ++refused;
      ADD_FAILURE() << number << ": " << made.problem << made.text;
      continue;
    }
    json::Diagnostics diagnostics;
    const Keys keys = keys_of(json::parse(made.text, "s.json", diagnostics)->root());
    for (const std::string& key : keys) missing.erase(key);
    std::vector<Feature> met;
    for (const FeatureEntry& each : features())
      if (has(keys, each)) met.push_back(each.feature);
    for (std::size_t a = 0; a < met.size(); ++a)
      for (std::size_t b = a + 1; b < met.size(); ++b) apart.erase({met[a], met[b]});
  }
  EXPECT_EQ(lines(missing), "") << "never generated";
  std::string pairs_apart;
  for (const auto& [a, b] : apart)
    pairs_apart += "  " + std::string(entry_of(a).name) + " and " + std::string(entry_of(b).name) + "\n";
  EXPECT_EQ(pairs_apart, "") << "never met";
  std::string all_reasons;
  for (const auto& [reason, found] : reasons)
    all_reasons += "  " + std::to_string(found.first) + " times " + reason + ", such as " + found.second + "\n";
  RecordProperty("refused_as_drawn", std::to_string(repaired));
  EXPECT_LT(repaired, tries * 3 / 10) << "too many are refused as they are drawn:\n" << all_reasons;
}

}  // namespace
}  // namespace takt::generator
