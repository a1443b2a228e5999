// SPDX-License-Identifier: Apache-2.0
#include "models/ethernet/sizes.hpp"

#include <gtest/gtest.h>

namespace takt::models {
namespace {

// IEEE 802.3 clause 3: DA 6, SA 6, type 2, payload, FCS 4, at least 64; the tag is 4 more and counts towards the 64.
TEST(Sizes, EveryPayload) {
  for (std::uint32_t payload = 0; payload <= 1500; ++payload) {
    const std::uint32_t untagged = payload <= 46 ? 64 : payload + 18;
    const std::uint32_t tagged = payload <= 42 ? 64 : payload + 22;
    ASSERT_EQ(frame_length(Octets{payload}, false).count, untagged) << payload;
    ASSERT_EQ(frame_length(Octets{payload}, true).count, tagged) << payload;
    ASSERT_EQ(wire_length(Octets{untagged}).count, untagged + 20) << payload;
  }
}

TEST(Sizes, PublishedFrames) {
  EXPECT_EQ(frame_length(Octets{1500}, false).count, 1518u);
  EXPECT_EQ(frame_length(Octets{1500}, true).count, 1522u);
  EXPECT_EQ(wire_length(Octets{64}).count, 84u);
  EXPECT_EQ(wire_length(Octets{1522}).count, 1542u);
}

// IPv4 header 20 and UDP header 8: 18 octets of user data fill the minimum frame, 1472 the largest.
TEST(Sizes, Udp) {
  const auto udp_frame = [](std::uint32_t data, bool tagged) {
    return frame_length(ipv4_and_udp_headers + Octets{data}, tagged).count;
  };
  EXPECT_EQ(udp_frame(0, false), 64u);
  EXPECT_EQ(udp_frame(18, false), 64u);
  EXPECT_EQ(udp_frame(19, false), 65u);
  EXPECT_EQ(udp_frame(14, true), 64u);
  EXPECT_EQ(udp_frame(15, true), 65u);
  EXPECT_EQ(udp_frame(100, false), 146u);
  EXPECT_EQ(udp_frame(1000, false), 1046u);
  EXPECT_EQ(udp_frame(1200, false), 1246u);
  EXPECT_EQ(udp_frame(1472, false), 1518u);
  EXPECT_EQ(udp_frame(1472, true), 1522u);
}

// The usual table: wire time of 64 and 1522 octets.
TEST(Sizes, WireTimes) {
  struct Row {
    std::uint64_t rate;
    std::int64_t ps_of_64;
    std::int64_t ps_of_1522;
  };
  constexpr Row rows[] = {{10'000'000, 67'200'000, 1'233'600'000},
                          {100'000'000, 6'720'000, 123'360'000},
                          {1'000'000'000, 672'000, 12'336'000},
                          {2'500'000'000, 268'800, 4'934'400},
                          {10'000'000'000, 67'200, 1'233'600}};
  for (const Row& row : rows) {
    const sim::Duration octet = sim::DataRate{row.rate}.octet_time();
    EXPECT_EQ((octet * wire_length(Octets{64}).count).ps(), row.ps_of_64);
    EXPECT_EQ((octet * wire_length(Octets{1522}).count).ps(), row.ps_of_1522);
  }
}

}  // namespace
}  // namespace takt::models
