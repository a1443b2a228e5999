// SPDX-License-Identifier: Apache-2.0
#include "sim/units.hpp"

#include <gtest/gtest.h>

#include <type_traits>

namespace takt::sim {
namespace {

template <class A, class B>
concept Mix = requires(A a, B b) {
  a + b;
}
|| requires(A a, B b) { a - b; }
|| requires(A a, B b) { a < b; }
|| requires(A a, B b) { a == b; };
static_assert(Mix<Octets, Octets>);
static_assert(!Mix<Octets, DataRate> && !Mix<Octets, Length> && !Mix<Octets, Duration> && !Mix<Octets, std::uint32_t>);
static_assert(!Mix<DataRate, Length> && !Mix<DataRate, FrequencyOffset> && !Mix<DataRate, std::uint64_t>);
static_assert(!Mix<Length, Duration> && !Mix<Length, FrequencyOffset> && !Mix<FrequencyOffset, std::int64_t>);
static_assert(!std::is_convertible_v<int, Octets> && !std::is_convertible_v<Octets, std::uint32_t>);
static_assert(!std::is_convertible_v<std::uint64_t, DataRate>);

TEST(Units, Octets) {
  EXPECT_EQ((64_B + 20_B).count, 84u);
  EXPECT_EQ((64_B - 4_B).count, 60u);
  EXPECT_LT(64_B, 65_B);
}

TEST(Units, OctetTimeOfEthernetRates) {
  struct Row {
    DataRate rate;
    Duration octet;
  };
  // 8 bit / rate: 8e12 ps / 10e6 = 800 000 ps, and so on.
  constexpr Row rows[] = {{10_Mbps, 800_ns},  {100_Mbps, 80_ns}, {1_Gbps, 8_ns},    {DataRate{2'500'000'000}, 3'200_ps},
                          {5_Gbps, 1'600_ps}, {10_Gbps, 800_ps}, {25_Gbps, 320_ps}, {40_Gbps, 200_ps},
                          {100_Gbps, 80_ps},  {400_Gbps, 20_ps}};
  for (const Row& row : rows) {
    EXPECT_TRUE(row.rate.has_exact_octet_time()) << row.rate.bits_per_second;
    EXPECT_EQ(row.rate.octet_time(), row.octet) << row.rate.bits_per_second;
  }
}

TEST(Units, OctetTimeIsRoundedUpWhereItIsNotExact) {
  // 8e12 / 3e9 = 2666.67 ps.
  EXPECT_FALSE((3_Gbps).has_exact_octet_time());
  EXPECT_EQ((3_Gbps).octet_time(), 2'667_ps);
  EXPECT_FALSE(DataRate{0}.has_exact_octet_time());
  EXPECT_EQ(DataRate{1}.octet_time(), 8_s);
}

TEST(Units, Lengths) {
  EXPECT_EQ((100_m).millimetres, 100'000);
  EXPECT_LT(2_m, 3_m);
  EXPECT_LT(FrequencyOffset{-1}, FrequencyOffset{0});
}

}  // namespace
}  // namespace takt::sim
