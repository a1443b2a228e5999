// SPDX-License-Identifier: Apache-2.0
#include "uadp/sequence_number.hpp"

#include <gtest/gtest.h>

namespace takt::uadp {
namespace {

constexpr Sequence compare(unsigned received, unsigned last) {
  return compare_sequence(static_cast<std::uint16_t>(received), static_cast<std::uint16_t>(last));
}

// OPC 10000-14, 7.2.3: d = (65535 + received - last) mod 65536; newer below 16384, older above 49152.
TEST(SequenceNumbers, NewerOlderInvalid) {
  EXPECT_EQ(compare(1, 0), Sequence::newer);
  EXPECT_EQ(compare(0, 65535), Sequence::newer) << "rolls over";
  EXPECT_EQ(compare(0, 0), Sequence::older) << "d = 65535";
  EXPECT_EQ(compare(65535, 0), Sequence::older);
  EXPECT_EQ(compare(16384, 0), Sequence::newer) << "d = 16383";
  EXPECT_EQ(compare(16385, 0), Sequence::invalid) << "d = 16384";
  EXPECT_EQ(compare(49153, 0), Sequence::invalid) << "d = 49152";
  EXPECT_EQ(compare(49154, 0), Sequence::older) << "d = 49153";
  EXPECT_EQ(compare_sequence<std::uint32_t>(1073741824, 0), Sequence::newer);
  EXPECT_EQ(compare_sequence<std::uint32_t>(1073741825, 0), Sequence::invalid);
  EXPECT_EQ(compare_sequence<std::uint32_t>(3221225474U, 0), Sequence::older);
}

TEST(SequenceNumbers, TheWindowRemembersTheLast) {
  SequenceWindow window;
  EXPECT_EQ(window.take(65534), Sequence::newer) << "any number is the first";
  EXPECT_EQ(window.take(65534), Sequence::older);
  EXPECT_EQ(window.take(1), Sequence::newer);
  EXPECT_EQ(window.missed(), 2u) << "65535 and 0";
  EXPECT_EQ(window.take(0), Sequence::older) << "overtaken";
  EXPECT_EQ(window.take(30000), Sequence::invalid);
  EXPECT_EQ(window.last(), 1);
  window.forget();
  EXPECT_EQ(window.take(30000), Sequence::newer);
}

}  // namespace
}  // namespace takt::uadp
