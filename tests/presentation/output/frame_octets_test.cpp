// SPDX-License-Identifier: Apache-2.0
// Frames byte for byte. The checksums were computed apart, by a script that knows RFC 768 and RFC 791 only.
#include "output/frame_octets.hpp"

#include <gtest/gtest.h>

#include <cctype>
#include <string>
#include <string_view>
#include <vector>

#include "tests/presentation/output/recording.hpp"

namespace takt::output {
namespace {

using models::AddressIndex;
using models::Frame;
using models::StreamIndex;

/// Hexadecimal octets; white space does not count.
std::string hex(std::span<const std::byte> octets) {
  std::string text;
  for (const std::byte octet : octets) {
    constexpr std::string_view digits = "0123456789abcdef";
    text += digits[std::to_integer<std::size_t>(octet) >> 4];
    text += digits[std::to_integer<std::size_t>(octet) & 15];
  }
  return text;
}
std::string hex(std::string_view text) {
  std::string out;
  for (const char c : text)
    if (std::isspace(static_cast<unsigned char>(c)) == 0) out += c;
  return out;
}
std::span<const std::byte> octets_of(std::string_view text) { return std::as_bytes(std::span(text)); }
std::string zeros(std::size_t octets) { return std::string(2 * octets, '0'); }

Frame frame(std::uint16_t length) {
  Frame f;
  f.sequence = 0x10005;
  f.source = AddressIndex{0};
  f.destination = AddressIndex{2};
  f.stream = StreamIndex{1};
  f.length = length;
  return f;
}
FrameEncoding udp(std::string_view payload) {
  FrameEncoding encoding;
  encoding.first_group = 3;
  encoding.headers = models::ipv4_and_udp_headers;
  encoding.payload = octets_of(payload);
  return encoding;
}

// 14 octets in UDP over IPv4 with a VLAN tag: 14 + 4 + 20 + 8 + 14 = 60 octets and the FCS, no padding.
TEST(FrameOctets, TaggedUdp) {
  Frame f = frame(64);
  f.tagged = true;
  f.vlan = 5;
  f.priority = 4;
  FrameBuffer buffer;
  EXPECT_EQ(hex(encode_frame(f, udp("Hello, network"), buffer)),
            hex("02005e000002 02005e000000 8100 8005 0800"
                "45 80 002a 0005 4000 40 11 263b 0a000001 0a000003"
                "c001 c001 0016 d7ff 48656c6c6f2c206e6574776f726b"));
}

// An odd payload: the checksum counts a zero octet that is not sent. 14 + 28 + 15 = 57, padded to 60.
TEST(FrameOctets, UntaggedUdpWithPadding) {
  FrameBuffer buffer;
  buffer.fill(std::byte{0xEE});  // what was there before does not shine through
  EXPECT_EQ(hex(encode_frame(frame(64), udp("Hello, networks"), buffer)),
            hex("02005e000002 02005e000000 0800"
                "45 00 002b 0005 4000 40 11 26ba 0a000001 0a000003"
                "c001 c001 0017 64fd 48656c6c6f2c206e6574776f726b73") +
                zeros(3));
}

// Nobody holds the octets: the pattern fills the frame. To a group: multicast bit, 239.x.
TEST(FrameOctets, UdpToAGroupWithoutOctets) {
  Frame f = frame(64);
  f.sequence = 2;
  f.source = AddressIndex{1};
  f.destination = AddressIndex{0x012345};
  f.stream = StreamIndex{7};
  FrameEncoding encoding = udp("");
  encoding.payload.reset();
  FrameBuffer buffer;
  EXPECT_EQ(hex(encode_frame(f, encoding, buffer)), hex("03005e012345 02005e000001 0800"
                                                        "45 00 002e 0002 4000 40 11 1e75 0a000002 ef012345"
                                                        "c007 c007 001a b3b2 54414b54 00000007 0000000000000002 1011"));
}

// The R-TAG stands after the VLAN tag and before the EtherType; the headers of a stream without IPv4 are zeros.
TEST(FrameOctets, RawWithRTag) {
  Frame f = frame(70);
  f.tagged = true;
  f.vlan = 0x123;
  f.priority = 7;
  FrameEncoding encoding;
  encoding.first_group = 3;
  encoding.headers = {2};
  encoding.payload = octets_of("abc");
  encoding.r_tag = 0xABCD;
  encoding.drop_eligible = true;
  encoding.ether_type = 0xB62C;
  FrameBuffer buffer;
  EXPECT_EQ(hex(encode_frame(f, encoding, buffer)),
            hex("02005e000002 02005e000000 8100 f123 f1c1 0000 abcd b62c 0000 616263") + zeros(37));
}

TEST(FrameOctets, TheLongestFrame) {
  Frame f = frame(1518);
  FrameEncoding encoding;
  encoding.first_group = 3;
  FrameBuffer buffer;
  const std::span<const std::byte> octets = encode_frame(f, encoding, buffer);
  ASSERT_EQ(octets.size(), 1514u);
  EXPECT_EQ(hex(octets.first(32)), hex("02005e000002 02005e000000 88b5 54414b54 00000001 0000000000010005 1011"));
  for (std::size_t i = 16; i < 1500; ++i) ASSERT_EQ(std::to_integer<std::size_t>(octets[14 + i]), i % 256) << i;
}

TEST(FrameOctets, RefusesWhatIsNoFrame) {
  FrameBuffer buffer;
  EXPECT_THROW(encode_frame(frame(63), {}, buffer), sim::InvariantBroken);
  EXPECT_THROW(encode_frame(frame(static_cast<std::uint32_t>(buffer.size()) + 5), {}, buffer), sim::InvariantBroken);
}

// A payload of 0 whose checksum comes out as 0 is sent as 0xFFFF: with two octets of payload equal to the checksum of
// the rest.
TEST(FrameOctets, AChecksumOfZeroIsSentAsOnes) {
  FrameBuffer buffer;
  const std::string_view nothing("\0\0", 2);
  const std::span<const std::byte> first = encode_frame(frame(64), udp(nothing), buffer);
  const std::string rest{static_cast<char>(first[40]), static_cast<char>(first[41])};  // its checksum
  const std::span<const std::byte> second = encode_frame(frame(64), udp(rest), buffer);
  EXPECT_EQ(hex(second.subspan(40, 2)), "ffff");
}

TEST(FrameOctets, OfAFrameUnderWay) {
  test::Plant plant;
  test::NetworkRun run(plant.plan);
  models::Traffic& traffic = run.network->traffic();
  const models::FrameIndex index = traffic.produce(plant.axes, octets_of("0123456789abcd"), sim::TrueTime());
  FrameBuffer buffer;
  const std::string text = hex(encode_frame(*run.network, index, buffer));
  EXPECT_EQ(text.substr(0, 36), hex("02005e000003 02005e000000 8100 8005 0800"));
  EXPECT_EQ(text.substr(text.size() - 28), hex("30313233343536373839616263 64"));
  traffic.release(index);
}

}  // namespace
}  // namespace takt::output
