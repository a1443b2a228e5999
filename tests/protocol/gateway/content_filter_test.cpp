// SPDX-License-Identifier: Apache-2.0
// Content filters of DDS: the grammar of Annex B as far as numbers go, against values by hand and against a second
// evaluation of random expressions.
#include "gateway/content_filter.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cstring>

#include "sim/random.hpp"

namespace takt::gateway::content_filter_test {
namespace {

const IdlStruct sample{"Sample",
                       {{"flag", IdlKind::boolean},
                        {"level", IdlKind::int32},
                        {"small", IdlKind::int8},
                        {"big", IdlKind::uint64},
                        {"axis", IdlKind::float32, IdlCollection::array, 3},
                        {"speed", IdlKind::float64}}};

struct Values {
  bool flag = false;
  std::int32_t level = 0;
  std::int8_t small = 0;
  std::uint64_t big = 0;
  float axis[3] = {};
  double speed = 0;
};

/// Offsets behind the header by hand: flag 0, level 4, small 8, big 16, axis 24, speed 40.
std::vector<std::byte> payload_of(const Values& values, bool is_little = true) {
  std::vector<std::byte> made(4 + 48);
  made[1] = std::byte{is_little ? std::uint8_t{1} : std::uint8_t{0}};
  const auto put = [&](std::size_t at, const auto& value) {
    std::memcpy(made.data() + 4 + at, &value, sizeof(value));
    if (!is_little)
      std::reverse(made.begin() + 4 + static_cast<std::ptrdiff_t>(at),
                   made.begin() + 4 + static_cast<std::ptrdiff_t>(at + sizeof(value)));
  };
  put(0, static_cast<std::uint8_t>(values.flag));
  put(4, values.level);
  put(8, values.small);
  put(16, values.big);
  for (std::size_t i = 0; i < 3; ++i) put(24 + 4 * i, values.axis[i]);
  put(40, values.speed);
  return made;
}

ContentFilter filter(std::string_view text) {
  FilterMistake mistake;
  auto made = ContentFilter::parse(text, sample, mistake);
  EXPECT_TRUE(made) << text << ": at " << mistake.at << " " << mistake.found << ", expected " << mistake.expected;
  return made.value_or(ContentFilter());
}
bool passes(std::string_view text, const Values& values) {
  const bool little = filter(text).passes(payload_of(values));
  EXPECT_EQ(filter(text).passes(payload_of(values, false)), little) << text;
  return little;
}

TEST(ContentFilter, ComparesFieldsWithNumbersAndFields) {
  const Values values{true, -7, -128, 18'446'744'073'709'551'615U, {0.5F, -2, 3}, 2.5};
  for (const char* const yes : {"level = -7",
                                "level <> 7",
                                "level < -6",
                                "-8 < level",
                                "level <= -7",
                                "level >= -7",
                                "level > small",
                                "small=-128",
                                "big > 9223372036854775807",
                                "axis[0] = 0.5",
                                "axis[1] < -1.5e0",
                                "axis[2] > speed",
                                "speed = 2.5",
                                "flag = TRUE",
                                "flag = 1",
                                "NOT flag = false",
                                "level BETWEEN -7 AND 0",
                                "level not between -6 and 0",
                                "big > level",
                                "speed > level"})
    EXPECT_TRUE(passes(yes, values)) << yes;
  for (const char* const no :
       {"level = 7", "level <> -7", "level < -7", "level > -7", "level BETWEEN -6 AND 0", "level NOT BETWEEN -7 AND -7",
        "axis[2] < axis[1]", "big < 0", "flag <> TRUE", "level = big"})
    EXPECT_FALSE(passes(no, values)) << no;
}

// NOT binds before AND, AND before OR; words in any case, spaces where they are needed.
TEST(ContentFilter, JoinsThem) {
  const Values values{.level = 1, .speed = 2};
  EXPECT_TRUE(passes("level = 1 OR level = 2 AND speed = 3", values));
  EXPECT_FALSE(passes("(level = 1 OR level = 2) AND speed = 3", values));
  EXPECT_TRUE(passes("NOT level = 2 AND speed = 2", values));
  EXPECT_FALSE(passes("NOT (level = 1 AND speed = 2)", values));
  EXPECT_TRUE(passes("not(not(level=1))and(speed>1 or speed<0)", values));
}

TEST(ContentFilter, NoNumberIsNotANumber) {
  const Values values{.speed = std::bit_cast<double>(0x7FF8'0000'0000'0000U)};
  EXPECT_FALSE(passes("speed = speed", values));
  EXPECT_TRUE(passes("speed <> speed", values));
  EXPECT_FALSE(passes("speed < 0 OR speed >= 0", values));
}

TEST(ContentFilter, WhatIsNoSampleDoesNotPass) {
  const ContentFilter all = filter("level = level");
  std::vector<std::byte> payload = payload_of({});
  EXPECT_TRUE(all.passes(payload));
  EXPECT_FALSE(all.passes(std::span(payload).first(payload.size() - 1)));
  EXPECT_FALSE(all.passes({}));
  payload[1] = std::byte{3};  // a parameter list
  EXPECT_FALSE(all.passes(payload));
}

TEST(ContentFilter, MistakesAreSaidWhereTheyAre) {
  const struct {
    std::string text;
    std::size_t at;
    std::string found;
    std::string expected;
  } cases[] = {{"", 0, "the end", "a field, a number, NOT or ("},
               {"lever = 1", 0, "lever", "one of the fields axis, big, flag, level, small, speed"},
               {"level 1", 6, "1", "=, <>, <, <=, >, >= or BETWEEN"},
               {"level == 1", 7, "=", "a field or a number"},
               {"level = 1 level = 2", 10, "level", "AND, OR or the end"},
               {"(level = 1", 10, "the end", "AND, OR or )"},
               {"axis = 1", 5, "=", "[ and an index, for axis is an array"},
               {"axis[3] = 1", 5, "3", "an index from 0 to 2"},
               {"level BETWEEN 1", 15, "the end", "AND"},
               {"level LIKE 'a'", 6, "LIKE", "=, <>, <, <=, >, >= or BETWEEN"},
               {"level = %0", 8, "%", "a field or a number"},
               {"1 = 2", 4, "two numbers", "a field on one side"},
               {"level = 1x", 8, "1x", "a number"}};
  for (const auto& each : cases) {
    FilterMistake mistake;
    EXPECT_FALSE(ContentFilter::parse(each.text, sample, mistake)) << each.text;
    EXPECT_EQ(mistake.at, each.at) << each.text;
    EXPECT_EQ(mistake.found, each.found) << each.text;
    EXPECT_EQ(mistake.expected, each.expected) << each.text;
  }
}

TEST(ContentFilter, NestingAndLengthHaveLimits) {
  FilterMistake mistake;
  EXPECT_TRUE(ContentFilter::parse(std::string(31, '(') + "level = 1" + std::string(31, ')'), sample, mistake));
  EXPECT_FALSE(ContentFilter::parse(std::string(32, '(') + "level = 1" + std::string(32, ')'), sample, mistake));
  EXPECT_FALSE(ContentFilter::parse(std::string(100'000, '('), sample, mistake));
  std::string many = "level = 1";
  for (int i = 0; i < 499; ++i) many += " OR level = 1";
  EXPECT_TRUE(ContentFilter::parse(many, sample, mistake));
  EXPECT_FALSE(ContentFilter::parse(many + " OR level = 1", sample, mistake));
  // The deepest that waits: an OR, an AND and a range at each depth.
  std::string deep;
  for (int i = 0; i < 31; ++i) deep += "level = 1 OR level = 0 AND (";
  deep += "level = 1 OR level = 0 AND level BETWEEN 0 AND 2" + std::string(31, ')');
  EXPECT_TRUE(passes(deep, {.level = 0}));
}

/// A random expression, and what it says of the level, worked out beside it.
struct Random {
  sim::RandomStream chance;
  std::int32_t level;

  std::pair<std::string, bool> comparison() {
    const auto number = static_cast<std::int32_t>(chance.below(7)) - 3;
    const std::string n = std::to_string(number);
    switch (chance.below(7)) {
      case 0:
        return {"level = " + n, level == number};
      case 1:
        return {"level <> " + n, level != number};
      case 2:
        return {"level < " + n, level < number};
      case 3:
        return {n + " >= level", number >= level};
      case 4:
        return {"level > " + n, level > number};
      case 5:
        return {"level between " + n + " and 2", level >= number && level <= 2};
      default:
        return {"level NOT BETWEEN -1 AND " + n, !(level >= -1 && level <= number)};
    }
  }
  std::pair<std::string, bool> expression(std::size_t depth) {
    if (depth == 0) return comparison();
    const auto [a, is_a] = expression(depth - 1);
    const auto [b, is_b] = expression(depth - 1);
    switch (chance.below(4)) {
      case 0:
        return {"(" + a + ") AND (" + b + ")", is_a && is_b};
      case 1:
        return {"(" + a + ") OR (" + b + ")", is_a || is_b};
      case 2:
        return {"NOT (" + a + ")", !is_a};
      default:
        return {a, is_a};
    }
  }
};

TEST(ContentFilter, RandomExpressionsSayWhatTheyMean) {
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    Random random{sim::RandomStream(seed, "filter", "test"), static_cast<std::int32_t>(seed % 7) - 3};
    const auto [text, expected] = random.expression(4);
    EXPECT_EQ(passes(text, {.level = random.level}), expected) << text << " of " << random.level;
  }
}

}  // namespace
}  // namespace takt::gateway::content_filter_test
