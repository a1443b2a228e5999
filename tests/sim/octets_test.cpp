// SPDX-License-Identifier: Apache-2.0
// The bounded reader and writer, in both byte orders, whether a message tells its order or not.
#include "sim/octets.hpp"

#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace takt::sim {
namespace {

std::vector<int> numbers(OctetSpan octets) {
  std::vector<int> made;
  for (const std::byte octet : octets) made.push_back(std::to_integer<int>(octet));
  return made;
}

template <class Order>
std::vector<int> written(Order order) {
  std::array<std::byte, 16> buffer{};
  OctetWriter<Order> out(buffer, order);
  out.put(std::uint8_t{0x01});
  out.put(std::uint16_t{0x0203});
  out.put(std::int32_t{-2});
  out.put(1.0F);  // 0x3F800000
  return numbers(out.finished());
}

TEST(OctetWriter, WritesBothByteOrders) {
  const std::vector<int> little = {0x01, 0x03, 0x02, 0xFE, 0xFF, 0xFF, 0xFF, 0x00, 0x00, 0x80, 0x3F};
  const std::vector<int> big = {0x01, 0x02, 0x03, 0xFF, 0xFF, 0xFF, 0xFE, 0x3F, 0x80, 0x00, 0x00};
  EXPECT_EQ(written(LittleEndian()), little);
  EXPECT_EQ(written(ByteOrder::little), little);
  EXPECT_EQ(written(BigEndian()), big);
  EXPECT_EQ(written(ByteOrder::big), big);
}

TEST(OctetWriter, WritesNothingThatDoesNotFitUntilThatIsTakenBack) {
  std::array<std::byte, 5> buffer{};
  OctetWriter<BigEndian> out(buffer);
  out.put(std::uint32_t{1});
  const std::size_t begin = out.position();
  out.put(std::uint16_t{2});
  out.put(std::uint8_t{3});  // would fit
  EXPECT_TRUE(out.overflowed());
  EXPECT_TRUE(out.finished().empty());
  out.rewind_to(begin);
  out.put(std::uint8_t{4});
  EXPECT_EQ(numbers(out.finished()), (std::vector<int>{0, 0, 0, 1, 4}));
  out.patch(0, std::uint16_t{0x0506});
  EXPECT_EQ(numbers(out.finished()), (std::vector<int>{5, 6, 0, 1, 4}));
}

TEST(OctetReader, ReadsWhatIsThereAndFailsForGoodBehindIt) {
  const std::array<std::byte, 7> octets = {std::byte{1},    std::byte{2},    std::byte{3},   std::byte{0xFF},
                                           std::byte{0xFF}, std::byte{0xFF}, std::byte{0xFE}};
  OctetReader<BigEndian> in(octets);
  EXPECT_EQ(in.get<std::uint8_t>(), 1);
  EXPECT_EQ(in.get<std::uint16_t>(), 0x0203);
  EXPECT_EQ(in.left(), 4u);
  OctetReader<ByteOrder> little(in.rest(), ByteOrder::little);
  EXPECT_EQ(in.get<std::int32_t>(), -2);
  EXPECT_EQ(little.get<std::uint32_t>(), 0xFEFF'FFFFU);
  EXPECT_EQ(in.get<std::uint8_t>(), 0);
  EXPECT_TRUE(in.failed());
  EXPECT_TRUE(in.take(0).empty());
  EXPECT_TRUE(in.failed());
}

// The reader counts from its beginning; the writer from where it is told, as CDR does from behind the encapsulation.
TEST(OctetCursors, AlignFromTheirOrigins) {
  std::array<std::byte, 16> buffer{};
  OctetWriter<LittleEndian> out(buffer);
  out.put(std::uint8_t{9});
  out.align(4, 1);
  EXPECT_EQ(out.position(), 1u);
  out.put(std::uint8_t{9});
  out.align(4, 1);
  EXPECT_EQ(out.position(), 5u);
  OctetReader<LittleEndian> in(out.finished());
  in.get<std::uint8_t>();
  in.align(4);
  EXPECT_EQ(in.position(), 4u);
  in.get<std::uint8_t>();
  in.align(4);
  EXPECT_TRUE(in.failed()) << "octets that are not there are not skipped";
}

}  // namespace
}  // namespace takt::sim
