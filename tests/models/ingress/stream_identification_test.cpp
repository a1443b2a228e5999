// SPDX-License-Identifier: Apache-2.0
#include "models/ingress/stream_identification.hpp"

#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace takt::models::stream_identification_test {
namespace {

constexpr MacAddress here{0x02005E000001};
constexpr MacAddress there{0x02005E000002};
constexpr StreamHandle first{7};
constexpr StreamHandle second{8};

constexpr std::array<std::byte, 4> ipv4{std::byte{0x08}, std::byte{0x00}, std::byte{0x45}, std::byte{0xA0}};

constexpr StreamHeader untagged{there, here, 0, false, 0, ipv4};
constexpr StreamHeader priority_tagged{there, here, 0, true, 5, ipv4};
constexpr StreamHeader vlan_5{there, here, 5, true, 5, ipv4};
constexpr StreamHeader vlan_6{there, here, 6, true, 5, ipv4};

TEST(MacAddress, OctetsAndGroups) {
  EXPECT_EQ(mac_address_of({0x012345}, 0x20000).octets(),
            (std::array<std::byte, 6>{std::byte{0x02}, std::byte{0}, std::byte{0x5E}, std::byte{0x01}, std::byte{0x23},
                                      std::byte{0x45}}));
  EXPECT_FALSE(mac_address_of({9}, 10).is_group());
  EXPECT_TRUE(mac_address_of({10}, 10).is_group());
  EXPECT_EQ(mac_address_of({10}, 10).value, 0x03005E00000Au);
}

struct VlanCase {
  Tagged tagged;
  VlanId vlan;
  std::array<bool, 4> matches;  // untagged, priority-tagged, VLAN 5, VLAN 6
};
class VlanMatching : public testing::TestWithParam<VlanCase> {};

// The same table for types 1 and 2.
TEST_P(VlanMatching, FollowsTheTaggedParameter) {
  const VlanCase& each = GetParam();
  const StreamHeader* const headers[] = {&untagged, &priority_tagged, &vlan_5, &vlan_6};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(identifies(NullIdentification{there, each.tagged, each.vlan}, *headers[i]), each.matches[i]) << i;
    EXPECT_EQ(identifies(SourceMacAndVlanIdentification{here, each.tagged, each.vlan}, *headers[i]), each.matches[i])
        << i;
    EXPECT_FALSE(identifies(NullIdentification{here, each.tagged, each.vlan}, *headers[i])) << i;
    EXPECT_FALSE(identifies(SourceMacAndVlanIdentification{there, each.tagged, each.vlan}, *headers[i])) << i;
  }
}
INSTANTIATE_TEST_SUITE_P(All, VlanMatching,
                         testing::Values(VlanCase{Tagged::tagged, 5, {false, false, true, false}},
                                         VlanCase{Tagged::tagged, 0, {false, false, true, true}},
                                         VlanCase{Tagged::priority, 0, {true, true, false, false}},
                                         VlanCase{Tagged::priority, 5, {true, true, false, false}},
                                         VlanCase{Tagged::all, 5, {true, true, true, false}},
                                         VlanCase{Tagged::all, 0, {true, true, true, true}}));

TEST(MaskAndMatch, AddressesUnderAMask) {
  MaskAndMatchIdentification entry;
  EXPECT_TRUE(identifies(entry, vlan_5));  // no mask: everything
  entry.destination_mask = {0xFFFFFF000000};
  entry.destination_match = {0x02005E123456};  // bits outside the mask do not count
  EXPECT_TRUE(identifies(entry, vlan_5));
  entry.source_mask = all_ones_mask;
  entry.source_match = here;
  EXPECT_TRUE(identifies(entry, vlan_5));
  entry.source_match = there;
  EXPECT_FALSE(identifies(entry, vlan_5));
  entry.source_match = here;
  entry.destination_match = {0x03005E000002};
  EXPECT_FALSE(identifies(entry, vlan_5));
}

TEST(MaskAndMatch, MsduOctetsUnderAMask) {
  MaskAndMatchIdentification entry;
  entry.msdu_mask = {std::byte{0xFF}, std::byte{0xFF}, std::byte{0x00}, std::byte{0xE0}};
  entry.msdu_match = {std::byte{0x08}, std::byte{0x00}, std::byte{0x99}, std::byte{0xBF}};  // 0xBF & 0xE0 = 0xA0
  EXPECT_TRUE(identifies(entry, untagged));
  entry.msdu_match[3] = std::byte{0xC0};
  EXPECT_FALSE(identifies(entry, untagged));
}

TEST(MaskAndMatch, AFrameThatIsTooShortDoesNotMatch) {
  MaskAndMatchIdentification entry;
  entry.msdu_mask.resize(5);  // all zeros: would match anything that is there
  entry.msdu_match.resize(5);
  EXPECT_FALSE(identifies(entry, untagged));
  entry.msdu_mask.resize(4);
  entry.msdu_match.resize(4);
  EXPECT_TRUE(identifies(entry, untagged));
}

TEST(StreamIdentityTable, TheFirstMatchWins) {
  StreamIdentityTable table;
  EXPECT_TRUE(table.identify(vlan_5).is_none());
  table.add(first, NullIdentification{there, Tagged::tagged, 5});
  table.add(second, SourceMacAndVlanIdentification{here, Tagged::all, 0});
  table.add(first, MaskAndMatchIdentification{});
  EXPECT_EQ(table.identify(vlan_5), first);
  EXPECT_EQ(table.identify(vlan_6), second);
  StreamHeader other = vlan_6;
  other.source = MacAddress{1};
  EXPECT_EQ(table.identify(other), first);
  EXPECT_EQ(table.entries().size(), 3u);
}

TEST(StreamIdentityTable, RefusesEntriesThatMeanNothing) {
  StreamIdentityTable table;
  EXPECT_THROW(table.add({}, NullIdentification{}), sim::InvariantBroken);
  MaskAndMatchIdentification entry;
  entry.msdu_mask.resize(1);
  EXPECT_THROW(table.add(first, entry), sim::InvariantBroken);
}

}  // namespace
}  // namespace takt::models::stream_identification_test
