// SPDX-License-Identifier: Apache-2.0
#include "json/quantity.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <limits>
#include <string>
#include <utility>

namespace takt::json {
namespace {

constexpr std::int64_t max_int64 = std::numeric_limits<std::int64_t>::max();

std::int64_t ps(std::string_view text) {
  const auto parsed = parse_duration(text, Sign::any);
  EXPECT_TRUE(static_cast<bool>(parsed)) << text << ": " << parsed.reason().message;
  return parsed ? (*parsed).ps() : -1;
}

template <class T>
std::string reason(const Parsed<T>& parsed) {
  if (parsed) return "a value";
  const auto& [message, expected, suggestion] = parsed.reason();
  return message + "; " + expected + (suggestion.empty() ? "" : "; " + suggestion);
}

TEST(Duration, IsExact) {
  EXPECT_EQ(ps("0s"), 0);
  EXPECT_EQ(ps("1ps"), 1);
  EXPECT_EQ(ps("0.001ns"), 1);
  EXPECT_EQ(ps("200us"), 200'000'000);
  EXPECT_EQ(ps("1.5ms"), 1'500'000'000);
  EXPECT_EQ(ps("10s"), 10'000'000'000'000);
  EXPECT_EQ(ps("3min"), 180'000'000'000'000);
  EXPECT_EQ(ps("1h"), 3'600'000'000'000'000);
  EXPECT_EQ(ps("0.1s"), 100'000'000'000);  // 0.1 has no double
  EXPECT_EQ(ps("0.000000000001s"), 1);
  EXPECT_EQ(ps("9223372.036854775807s"), max_int64);  // 2^63 - 1 ps
  EXPECT_EQ(ps("007.500us"), 7'500'000);
  EXPECT_EQ(ps("0.000000000000000000000000000000000000000000000000us"), 0);
  EXPECT_EQ(ps("0.5min"), 30'000'000'000'000);
  EXPECT_EQ(ps("-20us"), -20'000'000);
}

TEST(Duration, IsRefusedWithAReason) {
  const auto of = [](std::string_view text) { return reason(parse_duration(text)); };
  EXPECT_EQ(of("0.1ps"), "too fine; a duration in whole multiples of 1ps");
  EXPECT_EQ(of("0.0000000000001s"), "too fine; a duration in whole multiples of 1ps");
  EXPECT_EQ(of("0.00000000000000000000000000000000000000000000000001s"),
            "too fine; a duration in whole multiples of 1ps");
  EXPECT_EQ(of("9223372.036854775808s"), "too large; a duration of at most 9223372.036854775807s");
  EXPECT_EQ(of("99999999999999999999999999999999999999999999h"),
            "too large; a duration of at most 9223372.036854775807s");
  EXPECT_EQ(of("1" + std::string(60, '0') + "s"), "too large; a duration of at most 9223372.036854775807s");
  EXPECT_EQ(of("200"), "missing unit; one of the units ps, ns, us, ms, s, min, h");
  EXPECT_EQ(of("200sec"), "unknown unit \"sec\"; one of the units ps, ns, us, ms, s, min, h");
  EXPECT_EQ(of("200uss"), "unknown unit \"uss\"; one of the units ps, ns, us, ms, s, min, h; 200us");
  EXPECT_EQ(of("200\u00b5s"), "unknown unit \"\u00b5s\"; one of the units ps, ns, us, ms, s, min, h; 200us");
  EXPECT_EQ(of("10MS"), "unknown unit \"MS\"; one of the units ps, ns, us, ms, s, min, h; 10ms");
  EXPECT_EQ(of("200 us"), "a space in a quantity; a duration such as \"200us\"; 200us");
  EXPECT_EQ(of("two ms"), "a space in a quantity; a duration such as \"200us\"");
  EXPECT_EQ(of("-1us"), "negative; a duration that is not negative");
  for (const char* text : {"NaN", "inf", "us", ".5us", "5.us", "+5us", "1,5ms", "0x10us", "--1us"})
    EXPECT_NE(of(text), "a value") << text;
  EXPECT_EQ(of("NaN"), "not a number with a unit; a duration such as \"200us\"");
  EXPECT_EQ(of("1e3us"), "an exponent in a quantity; a duration such as \"200us\"");
  EXPECT_EQ(of(""), "an empty text; a duration such as \"200us\"");
  EXPECT_EQ(of(std::string(1'000'000, '1')), "a text that is too long; a duration such as \"200us\"");
}

TEST(DataRate, Units) {
  EXPECT_EQ((*parse_data_rate("1Gbps")).bits_per_second, 1'000'000'000U);
  EXPECT_EQ((*parse_data_rate("100Mbps")).bits_per_second, 100'000'000U);
  EXPECT_EQ((*parse_data_rate("2.5Gbps")).bits_per_second, 2'500'000'000U);
  EXPECT_EQ((*parse_data_rate("64kbps")).bits_per_second, 64'000U);
  EXPECT_EQ((*parse_data_rate("9600bps")).bits_per_second, 9'600U);
  EXPECT_EQ((*parse_data_rate("18446744073709551615bps")).bits_per_second, std::numeric_limits<std::uint64_t>::max());
  EXPECT_EQ(reason(parse_data_rate("1gbps")),
            "unknown unit \"gbps\"; one of the units bps, kbps, Mbps, Gbps, Tbps; 1Gbps");
  EXPECT_EQ(reason(parse_data_rate("0.5bps")), "too fine; a data rate in whole multiples of 1bps");
  EXPECT_EQ(reason(parse_data_rate("-1bps")), "negative; a data rate that is not negative");
}

TEST(Length, Units) {
  EXPECT_EQ((*parse_length("10m")).millimetres, 10'000);
  EXPECT_EQ((*parse_length("1.5km")).millimetres, 1'500'000);
  EXPECT_EQ((*parse_length("20cm")).millimetres, 200);
  EXPECT_EQ((*parse_length("5mm")).millimetres, 5);
  EXPECT_EQ(reason(parse_length("0.5mm")), "too fine; a length in whole multiples of 1mm");
}

TEST(Octets, Units) {
  EXPECT_EQ((*parse_octets("1000B")).count, 1000U);
  EXPECT_EQ((*parse_octets("64KiB")).count, 65'536U);
  EXPECT_EQ((*parse_octets("1kB")).count, 1000U);
  EXPECT_EQ((*parse_octets("0.5KiB")).count, 512U);
  EXPECT_EQ((*parse_octets("4294967295B")).count, 4'294'967'295U);
  EXPECT_EQ(reason(parse_octets("4GiB")), "too large; a size of at most 4294967295B");
  EXPECT_EQ(reason(parse_octets("0.3KiB")), "too fine; a size in whole multiples of 1B");  // 307.2
}

TEST(FrequencyOffset, Units) {
  EXPECT_EQ((*parse_frequency_offset("50ppm")).parts_per_trillion, 50'000'000);
  EXPECT_EQ((*parse_frequency_offset("-50ppm")).parts_per_trillion, -50'000'000);
  EXPECT_EQ((*parse_frequency_offset("+0.5ppb")).parts_per_trillion, 500);
  EXPECT_EQ((*parse_frequency_offset("0.01%")).parts_per_trillion, 100'000'000);
  EXPECT_EQ((*parse_frequency_drift("1ppm/s")).parts_per_trillion_per_second, 1'000'000);
  EXPECT_EQ(reason(parse_frequency_drift("1ppm")),
            "unknown unit \"ppm\"; one of the units ppt/s, ppb/s, ppm/s; 1ppm/s");
}

TEST(Probability, PercentOrNumber) {
  constexpr std::int64_t thousandth = 1'000'000'000'000'000;
  EXPECT_EQ((*parse_probability("0.1%")).parts_per_quintillion, thousandth);
  EXPECT_EQ((*parse_probability("0.001")).parts_per_quintillion, thousandth);
  EXPECT_EQ((*parse_probability("1e-3")).parts_per_quintillion, thousandth);
  EXPECT_EQ((*parse_probability("1E-12")).parts_per_quintillion, 1'000'000);
  EXPECT_EQ((*parse_probability("100%")).parts_per_quintillion, Probability::certain);
  EXPECT_EQ((*parse_probability("1")).parts_per_quintillion, Probability::certain);
  EXPECT_EQ((*parse_probability("0")).parts_per_quintillion, 0);
  EXPECT_EQ((*parse_probability("0.01e2")).parts_per_quintillion, Probability::certain);
  EXPECT_EQ(reason(parse_probability("1.5")), "too large; a probability from 0 to 1 of at most 1");
  EXPECT_EQ(reason(parse_probability("1e99999999999")), "too large; a probability from 0 to 1 of at most 1");
  EXPECT_EQ(reason(parse_probability("1e-19")), "too fine; a probability from 0 to 1 in whole multiples of 1e-18");
  EXPECT_EQ(reason(parse_probability("-0.5")), "negative; a probability from 0 to 1 that is not negative");
  EXPECT_EQ((*parse_probability("0.25")).as_double(), 0.25);
}

TEST(Text, ChoosesTheBestUnit) {
  const auto duration = [](std::int64_t value) { return to_text(sim::Duration::from_ps(value)); };
  EXPECT_EQ(duration(0), "0s");
  EXPECT_EQ(duration(500), "500ps");
  EXPECT_EQ(duration(1'500), "1.5ns");
  EXPECT_EQ(duration(200'000'000), "200us");
  EXPECT_EQ(duration(1'000'125'000), "1.000125ms");
  EXPECT_EQ(duration(10'000'000'000'000), "10s");
  EXPECT_EQ(duration(90'000'000'000'000), "90s");
  EXPECT_EQ(duration(120'000'000'000'000), "2min");
  EXPECT_EQ(duration(7'200'000'000'000'000), "2h");
  EXPECT_EQ(duration(-1'500'000), "-1.5us");
  EXPECT_EQ(to_text(sim::DataRate{2'500'000'000}), "2.5Gbps");
  EXPECT_EQ(to_text(sim::DataRate{100'000'000}), "100Mbps");
  EXPECT_EQ(to_text(sim::DataRate{0}), "0bps");
  EXPECT_EQ(to_text(sim::Length{10'000}), "10m");
  EXPECT_EQ(to_text(sim::Length{200}), "20cm");
  EXPECT_EQ(to_text(sim::Length{1'500'000}), "1.5km");
  EXPECT_EQ(to_text(sim::Octets{1000}), "1000B");
  EXPECT_EQ(to_text(sim::Octets{65'536}), "64KiB");
  EXPECT_EQ(to_text(sim::Octets{1'518}), "1518B");
  EXPECT_EQ(to_text(sim::Octets{3'000'000}), "3MB");
  EXPECT_EQ(to_text(sim::FrequencyOffset{-50'000'000}), "-50ppm");
  EXPECT_EQ(to_text(sim::FrequencyOffset{1'500}), "1.5ppb");
  EXPECT_EQ(to_text(FrequencyDrift{1'000'000}), "1ppm/s");
  EXPECT_EQ(to_text(Probability{1'000'000'000'000'000}), "0.001");
  EXPECT_EQ(to_text(Probability{1'500'000}), "15e-13");
  EXPECT_EQ(to_text(Probability{Probability::certain / 2}), "0.5");
  EXPECT_EQ(to_text(Probability{Probability::certain}), "1");
}

// Round trips: what is written reads back as the same value, over the whole range.

/// Numbers of all magnitudes: RapidCheck's own are mostly small.
template <class T>
rc::Gen<T> of_all_magnitudes() {
  return rc::gen::map(rc::gen::pair(rc::gen::arbitrary<std::uint64_t>(), rc::gen::inRange(0, 64)),
                      [](const std::pair<std::uint64_t, int>& p) {
                        return static_cast<T>((p.first * 0x9E3779B97F4A7C15ULL) >> p.second);
                      });
}

RC_GTEST_PROP(RoundTrip, Duration, ()) {
  const auto value = *of_all_magnitudes<std::int64_t>();
  RC_PRE(value != std::numeric_limits<std::int64_t>::min());
  RC_ASSERT((*parse_duration(to_text(sim::Duration::from_ps(value)), Sign::any)).ps() == value);
}
RC_GTEST_PROP(RoundTrip, DataRate, ()) {
  const auto value = *of_all_magnitudes<std::uint64_t>();
  RC_ASSERT((*parse_data_rate(to_text(sim::DataRate{value}))).bits_per_second == value);
}
RC_GTEST_PROP(RoundTrip, Length, ()) {
  const auto value = static_cast<std::int64_t>(*of_all_magnitudes<std::uint64_t>() >> 1);
  RC_ASSERT((*parse_length(to_text(sim::Length{value}))).millimetres == value);
}
RC_GTEST_PROP(RoundTrip, Octets, ()) {
  const auto value = *of_all_magnitudes<std::uint32_t>();
  RC_ASSERT((*parse_octets(to_text(sim::Octets{value}))).count == value);
}
RC_GTEST_PROP(RoundTrip, FrequencyOffset, ()) {
  const auto value = *of_all_magnitudes<std::int64_t>();
  RC_PRE(value != std::numeric_limits<std::int64_t>::min());
  RC_ASSERT((*parse_frequency_offset(to_text(sim::FrequencyOffset{value}))).parts_per_trillion == value);
  RC_ASSERT((*parse_frequency_drift(to_text(FrequencyDrift{value}))).parts_per_trillion_per_second == value);
}
RC_GTEST_PROP(RoundTrip, Probability, ()) {
  const auto value = static_cast<std::int64_t>(*of_all_magnitudes<std::uint64_t>() % (Probability::certain + 1));
  RC_ASSERT((*parse_probability(to_text(Probability{value}))).parts_per_quintillion == value);
}
RC_GTEST_PROP(Parsing, NeverRounds, ()) {
  // The digits of a number of ps, with a decimal point put anywhere that the unit us allows: 6 decimals.
  const auto value = static_cast<std::int64_t>(*of_all_magnitudes<std::uint64_t>() >> 1);
  const std::string whole = std::to_string(value / 1'000'000);
  const std::string fraction = std::to_string(1'000'000 + value % 1'000'000).substr(1);
  RC_ASSERT((*parse_duration(whole + "." + fraction + "us")).ps() == value);
  RC_ASSERT(!parse_duration(whole + "." + fraction + "5us"));
}

}  // namespace
}  // namespace takt::json
