// SPDX-License-Identifier: Apache-2.0
// Sizes of fragments, where a frame may be cut, and the numbers between preamble and data (IEEE 802.3, clause 99).
#include "models/egress/preemption.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace takt::models {
namespace {

using sim::operator""_B;

TEST(Preemption, SizesForEachAddFragSize) {
  struct Row {
    std::uint8_t add_frag_size;
    Octets fragment_data, fragment_with_mcrc, uninterruptible, express_wait;
  };
  for (const Row& row : {Row{0, 60_B, 64_B, 123_B, 143_B}, Row{1, 124_B, 128_B, 187_B, 207_B},
                         Row{2, 188_B, 192_B, 251_B, 271_B}, Row{3, 252_B, 256_B, 315_B, 335_B}}) {
    const AddFragSize size(row.add_frag_size);
    EXPECT_EQ(minimum_fragment_data(size), row.fragment_data);
    EXPECT_EQ(minimum_fragment_data(size) + mcrc, row.fragment_with_mcrc);
    EXPECT_EQ(longest_uninterruptible(size), row.uninterruptible);
    EXPECT_EQ(longest_express_wait(size), row.express_wait);
    // The longest that can't be cut, and one octet more.
    EXPECT_EQ(earliest_cut(0_B, row.uninterruptible, size), std::nullopt);
    EXPECT_EQ(earliest_cut(0_B, row.uninterruptible + 1_B, size), row.fragment_data);
  }
}

// 143 octets: 11.44 us at 100 Mb/s, 1.144 us at 1 Gb/s.
TEST(Preemption, TheWaitOfAnExpressFrame) {
  const std::int64_t octets = longest_express_wait(AddFragSize(0)).count;
  EXPECT_EQ((octets * sim::DataRate{100'000'000}.octet_time()).ps(), 11'440'000);
  EXPECT_EQ((octets * sim::DataRate{1'000'000'000}.octet_time()).ps(), 1'144'000);
}

TEST(Preemption, ACutNeedsEnoughBeforeAndBehindIt) {
  const AddFragSize none;
  EXPECT_EQ(earliest_cut(0_B, 1522_B, none), 60_B);
  EXPECT_EQ(earliest_cut(59_B, 1463_B, none), 1_B);
  EXPECT_EQ(earliest_cut(60_B, 1462_B, none), 0_B);
  EXPECT_EQ(earliest_cut(700_B, 822_B, none), 0_B);
  EXPECT_EQ(earliest_cut(1458_B, 64_B, none), 0_B);
  EXPECT_EQ(earliest_cut(1459_B, 63_B, none), std::nullopt);
  EXPECT_EQ(earliest_cut(60_B, 64_B, none), 0_B);
  EXPECT_EQ(earliest_cut(59_B, 64_B, none), std::nullopt);
  EXPECT_EQ(earliest_cut(100_B, 200_B, AddFragSize(2)), 88_B);
  EXPECT_EQ(earliest_cut(100_B, 151_B, AddFragSize(2)), std::nullopt);
}

// The preamble's 8 octets are no data; an octet under way counts.
TEST(Preemption, ACutCountedFromThePreamble) {
  EXPECT_EQ(cut_after(0_B, 1522_B, AddFragSize(0)), 60_B);
  EXPECT_EQ(cut_after(8_B, 1522_B, AddFragSize(0)), 60_B);
  EXPECT_EQ(cut_after(68_B, 1522_B, AddFragSize(0)), 60_B);
  EXPECT_EQ(cut_after(69_B, 1522_B, AddFragSize(0)), 61_B);
  EXPECT_EQ(cut_after(1466_B, 1522_B, AddFragSize(0)), 1458_B);
  EXPECT_EQ(cut_after(1467_B, 1522_B, AddFragSize(0)), std::nullopt);
  EXPECT_EQ(cut_after(1542_B, 1522_B, AddFragSize(0)), std::nullopt);  // in the gap
  EXPECT_EQ(cut_after(8_B, 123_B, AddFragSize(0)), std::nullopt);
}

// A frame of 1522 octets cut after 60 octets each time: 60 octets go out as 8 + 64 + 12 = 84 octets of the medium. 24
// cuts leave 82 octets, too few for another. Each cut costs 24 octets: 1542 + 24 * 24.
TEST(Preemption, EachCutCosts24Octets) {
  Octets remaining = 1522_B, on_the_wire = 0_B;
  std::uint32_t cuts = 0;
  for (; const auto data = earliest_cut(0_B, remaining, AddFragSize(0)); ++cuts) {
    on_the_wire = on_the_wire + wire_length_of_cut_fragment(*data);
    remaining = remaining - *data;
  }
  EXPECT_EQ(cuts, 24u);
  EXPECT_EQ(remaining, 82_B);
  EXPECT_EQ(wire_length_of_cut_fragment(60_B), 84_B);
  on_the_wire = on_the_wire + wire_length_of_last_fragment(remaining);
  EXPECT_EQ(on_the_wire, Octets{1542 + 24 * 24});
  EXPECT_EQ(overhead_of_a_cut, 24_B);
}

// From any instant, what an express frame waits for stays within longest_express_wait, and a frame that is cut is cut
// legally.
TEST(Preemption, AnyRequestEndsTheFragmentInTime) {
  for (std::uint8_t a = 0; a <= 3; ++a) {
    const AddFragSize size(a);
    std::uint32_t longest = 0;
    for (std::uint32_t length = 64; length <= 1522; ++length) {
      for (std::uint32_t wire = 0; wire <= length + 8; ++wire) {
        const auto cut = cut_after({wire}, {length}, size);
        const Octets end = cut ? wire_length_of_cut_fragment(*cut) : wire_length_of_last_fragment({length});
        longest = std::max(longest, end.count - wire);
        if (!cut) continue;
        ASSERT_GE(cut->count + mcrc.count, 64u * (1u + a));
        ASSERT_GE(length - cut->count, 64u);
        ASSERT_GE(cut->count + 8, wire);
      }
    }
    EXPECT_EQ(longest, longest_express_wait(size).count);
  }
}

TEST(Preemption, FramesAndContinuationsAreNumberedModulo4) {
  FragmentSequence sequence;
  const std::vector<std::uint8_t> starts = {0xE6, 0x4C, 0x7F, 0xB3, 0xE6},
                                  continuations = {0x61, 0x52, 0x9E, 0x2A, 0x61};
  const std::vector<std::uint8_t> counts = {0xE6, 0x4C, 0x7F, 0xB3, 0xE6, 0x4C};
  for (std::size_t frame = 0; frame < starts.size(); ++frame) {
    EXPECT_EQ(sequence.start_frame(), (FragmentHeader{starts[frame], std::nullopt}));
    for (const std::uint8_t count : counts)
      EXPECT_EQ(sequence.continue_frame(), (FragmentHeader{continuations[frame], count}));
  }
}

// CRC-32 of "123456789" is 0xCBF43926.
TEST(Preemption, TheMcrcDiffersFromTheCrcInHalfOfItsBits) { EXPECT_EQ(mcrc_of(0xCBF4'3926u), 0xCBF4'C6D9u); }

static_assert(smd_e == 0xD5 && smd_v == 0x07 && smd_r == 0x19);

}  // namespace
}  // namespace takt::models
