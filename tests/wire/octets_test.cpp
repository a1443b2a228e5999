// The bounded reader and writer: little-endian, never past the end.
#include <gtest/gtest.h>

#include <array>

#include "wire/octet_reader.hpp"
#include "wire/octet_writer.hpp"

namespace takt::wire {
namespace {

constexpr std::byte octet(unsigned value) { return static_cast<std::byte>(value); }

TEST(OctetWriter, WritesLittleEndian) {
  std::array<std::byte, 16> buffer{};
  OctetWriter writer(buffer);
  writer.put(std::uint8_t{0x01});
  writer.put(std::uint16_t{0x0302});
  writer.put(std::uint32_t{0x07060504});
  writer.put(std::uint64_t{0x0F0E0D0C0B0A0908});
  ASSERT_EQ(writer.written().size(), 15u);
  for (unsigned i = 0; i < 15; ++i) EXPECT_EQ(buffer[i], octet(i + 1));
  EXPECT_FALSE(writer.overflowed());
}

TEST(OctetWriter, WritesNothingBeyondItsTarget) {
  std::array<std::byte, 4> buffer{};
  OctetWriter writer(std::span<std::byte>(buffer).first(3));
  writer.put(std::uint16_t{0xFFFF});
  writer.put(std::uint16_t{0xFFFF});  // one octet is left
  EXPECT_TRUE(writer.overflowed());
  EXPECT_EQ(writer.written().size(), 2u);
  EXPECT_EQ(buffer[2], octet(0));
  EXPECT_EQ(buffer[3], octet(0));
  writer.put(std::uint8_t{1});
  EXPECT_TRUE(writer.overflowed()) << "for good";
}

TEST(OctetWriter, ZerosStopAtTheEnd) {
  std::array<std::byte, 4> buffer{octet(9), octet(9), octet(9), octet(9)};
  OctetWriter writer(std::span<std::byte>(buffer).first(3));
  writer.put_zeros(2);
  EXPECT_FALSE(writer.overflowed());
  writer.put_zeros(2);
  EXPECT_TRUE(writer.overflowed());
  EXPECT_EQ(buffer[3], octet(9));
}

TEST(OctetReader, ReadsLittleEndian) {
  std::array<std::byte, 15> buffer;
  for (unsigned i = 0; i < 15; ++i) buffer[i] = octet(i + 1);
  OctetReader reader(buffer);
  EXPECT_EQ(reader.get<std::uint8_t>(), 0x01);
  EXPECT_EQ(reader.get<std::uint16_t>(), 0x0302);
  EXPECT_EQ(reader.get<std::uint32_t>(), 0x07060504u);
  EXPECT_EQ(reader.get<std::uint64_t>(), 0x0F0E0D0C0B0A0908u);
  EXPECT_EQ(reader.left(), 0u);
  EXPECT_FALSE(reader.failed());
}

TEST(OctetReader, FailsForGoodAtTheEnd) {
  const std::array<std::byte, 3> buffer{octet(1), octet(2), octet(3)};
  OctetReader reader(buffer);
  EXPECT_EQ(reader.get<std::uint32_t>(), 0u);
  EXPECT_TRUE(reader.failed());
  EXPECT_EQ(reader.get<std::uint16_t>(), 0x0201);  // what is there can still be read
  EXPECT_TRUE(reader.failed());
  EXPECT_EQ(OctetReader({}).get<std::uint8_t>(), 0);
}

}  // namespace
}  // namespace takt::wire
