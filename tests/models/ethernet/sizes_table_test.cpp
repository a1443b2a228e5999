// SPDX-License-Identifier: Apache-2.0
// What one frame occupies, byte-exact and as one table: frame with VLAN tag and R-TAG, its fragments when it is cut,
// gaps.
#include <gtest/gtest.h>

#include "models/egress/preemption.hpp"
#include "models/ethernet/sizes.hpp"

namespace takt::models {
namespace {

// IEEE 802.3 3.1.1: header 14 (DA 6, SA 6, EtherType 2), FCS 4, at least 64 in all. VLAN tag 4 (802.1Q 9.6), R-TAG 6
// (802.1CB 7.8): both stand before the data and count towards the 64. On the medium: preamble and SFD 8, inter-packet
// gap 12.
struct SizeRow {
  std::uint32_t msdu;
  std::uint32_t plain, tagged, r_tagged, both;  // DA to FCS
  std::uint32_t wire_of_both;                   // with preamble and gap
};
constexpr SizeRow size_rows[] = {
    {0, 64, 64, 64, 64, 84},
    {36, 64, 64, 64, 64, 84},  // 14 + 4 + 6 + 36 + 4 = 64, nothing to pad with both tags
    {37, 64, 64, 64, 65, 85},
    {40, 64, 64, 64, 68, 88},
    {41, 64, 64, 65, 69, 89},  // 14 + 6 + 41 + 4 = 65
    {42, 64, 64, 66, 70, 90},
    {43, 64, 65, 67, 71, 91},
    {46, 64, 68, 70, 74, 94},
    {47, 65, 69, 71, 75, 95},
    {100, 118, 122, 124, 128, 148},
    {128, 146, 150, 152, 156, 176},  // 100 octets of user data and 28 of IPv4 and UDP
    {1228, 1246, 1250, 1252, 1256, 1276},
    {1500, 1518, 1522, 1524, 1528, 1548},
};

TEST(SizesTable, FramesWithTheirTags) {
  for (const SizeRow& row : size_rows) {
    EXPECT_EQ(frame_length(Octets{row.msdu}, false).count, row.plain) << row.msdu;
    EXPECT_EQ(frame_length(Octets{row.msdu}, true).count, row.tagged) << row.msdu;
    EXPECT_EQ(frame_length(Octets{row.msdu}, false, true).count, row.r_tagged) << row.msdu;
    EXPECT_EQ(frame_length(Octets{row.msdu}, true, true).count, row.both) << row.msdu;
    EXPECT_EQ(wire_length(frame_length(Octets{row.msdu}, true, true)).count, row.wire_of_both) << row.msdu;
  }
}

// Every payload, as sums.
TEST(SizesTable, TagsOfEveryPayload) {
  for (std::uint32_t msdu = 0; msdu <= maximum_msdu.count; ++msdu) {
    ASSERT_EQ(frame_length(Octets{msdu}, false, true).count, msdu <= 40 ? 64 : msdu + 24) << msdu;
    ASSERT_EQ(frame_length(Octets{msdu}, true, true).count, msdu <= 36 ? 64 : msdu + 28) << msdu;
  }
}

TEST(SizesTable, Parts) {
  EXPECT_EQ(preamble_and_sfd.count, 8u);
  EXPECT_EQ(mac_header.count, 14u);
  EXPECT_EQ(vlan_tag.count, 4u);
  EXPECT_EQ(r_tag.count, 6u);
  EXPECT_EQ(ipv4_and_udp_headers.count, 28u);
  EXPECT_EQ(frame_check_sequence.count, 4u);
  EXPECT_EQ(mcrc.count, 4u);
  EXPECT_EQ(inter_packet_gap.count, 12u);
  EXPECT_EQ(minimum_frame.count, 64u);
  EXPECT_EQ(minimum_final_fragment.count, 64u);
}

// A frame that is cut once: `data` octets, then the rest. Preamble 8, mCRC 4 and gap 12 around the first part, preamble
// 8 and gap 12 around the second, which ends with the frame's own FCS. The cut costs 8 + 4 + 12 = 24 octets whatever
// its place.
struct CutRow {
  std::uint8_t add_frag_size;
  std::uint32_t frame;       // DA to FCS
  std::uint32_t wire;        // octets since the start of the preamble when the express frame asks
  std::uint32_t data;        // of the frame in the first fragment; 0: it is not cut
  std::uint32_t first_wire;  // what the first fragment takes of the medium
  std::uint32_t last_wire;   // what the rest takes
};
constexpr CutRow cut_rows[] = {
    {0, 1522, 0, 60, 84, 1482},   // at once: the least fragment, 60 + 4 = 64 octets on the medium between preamble and
                                  // gap
    {0, 1522, 68, 60, 84, 1482},  // 8 + 60 octets are out
    {0, 1522, 125, 117, 141, 1425},                            // scenarios/validation/preemption.json
    {0, 1522, 1466, 1458, 1482, 84},                           // the latest cut: 64 octets are left
    {0, 1522, 1467, 0, 1542, 0},     {0, 124, 0, 60, 84, 84},  // the shortest frame that can be cut
    {0, 123, 0, 0, 143, 0},          {0, 64, 0, 0, 84, 0},
    {1, 1522, 0, 124, 148, 1418},    {1, 188, 0, 124, 148, 84},
    {1, 187, 0, 0, 207, 0},          {2, 1522, 0, 188, 212, 1354},
    {2, 252, 0, 188, 212, 84},       {2, 251, 0, 0, 271, 0},
    {3, 1522, 0, 252, 276, 1290},    {3, 316, 0, 252, 276, 84},
    {3, 315, 0, 0, 335, 0},          {3, 1528, 1000, 992, 1016, 556},  // with VLAN tag and R-TAG
};

TEST(SizesTable, Fragments) {
  for (const CutRow& row : cut_rows) {
    SCOPED_TRACE(testing::Message() << "addFragSize " << int{row.add_frag_size} << ", " << row.frame
                                    << " octets, asked at " << row.wire);
    const auto data = cut_after(Octets{row.wire}, Octets{row.frame}, AddFragSize(row.add_frag_size));
    EXPECT_EQ(data.value_or(Octets{0}).count, row.data);
    if (!data) {
      EXPECT_EQ(wire_length_of_last_fragment(Octets{row.frame}).count, row.first_wire);
      continue;
    }
    const Octets first = wire_length_of_cut_fragment(*data);
    const Octets last = wire_length_of_last_fragment(Octets{row.frame} - *data);
    EXPECT_EQ(first.count, row.first_wire);
    EXPECT_EQ(last.count, row.last_wire);
    EXPECT_EQ((first + last).count, wire_length(Octets{row.frame}).count + 24);
  }
}

}  // namespace
}  // namespace takt::models
