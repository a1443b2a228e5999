// SPDX-License-Identifier: Apache-2.0
// Key hashes, octet for octet, against ones written out by hand (DDSI-RTPS 2.5, 9.6.4.8).
#include "gateway/key_layout.hpp"

#include <gtest/gtest.h>

#include "gateway/md5.hpp"

namespace takt::gateway::key_layout_test {
namespace {

std::vector<std::byte> octets(std::initializer_list<unsigned> values) {
  std::vector<std::byte> all;
  for (const unsigned value : values) all.push_back(static_cast<std::byte>(value));
  return all;
}

/// struct { octet a; @key unsigned long b; double c; @key short d[3]; }
const IdlStruct type{"T",
                     {{"a", IdlKind::octet},
                      {"b", IdlKind::uint32},
                      {"c", IdlKind::float64},
                      {"d", IdlKind::int16, IdlCollection::array, 3}}};
const std::vector<std::string> keys{"d", "b"};  // the order of the declaration counts
constexpr KeyHash hash{1, 2, 3, 4, 5, 6, 7, 8, 9, 10};

TEST(KeyLayout, IsBigEndianWhateverThePayloadIs) {
  const KeyLayout layout(type, keys);
  EXPECT_TRUE(layout.has_key());
  EXPECT_EQ(layout.octets(), 10u);
  EXPECT_EQ(layout.of_data(octets({0, 1, 0, 0, 99, 0, 0, 0, 4, 3, 2, 1, 0, 0, 0, 0, 0, 0, 0, 0, 6, 5, 8, 7, 10, 9})),
            hash);  // CDR_LE
  EXPECT_EQ(layout.of_data(octets({0, 0, 0, 0, 99, 0, 0, 0, 1, 2, 3, 4, 0, 0, 0, 0, 0, 0, 0, 0, 5, 6, 7, 8, 9, 10})),
            hash);  // CDR_BE
  EXPECT_EQ(layout.of_key(octets({0, 1, 0, 0, 4, 3, 2, 1, 6, 5, 8, 7, 10, 9})), hash);
  EXPECT_EQ(layout.of_key(octets({0, 0, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10})), hash);
}

TEST(KeyLayout, WhatIsNoPayloadHasNoKey) {
  const KeyLayout layout(type, keys);
  EXPECT_EQ(layout.of_data({}), KeyHash{});
  EXPECT_EQ(layout.of_data(octets({0, 1, 0, 0, 99, 0, 0, 0, 4, 3, 2, 1})), KeyHash{});       // too short
  EXPECT_EQ(layout.of_key(octets({0, 7, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10})), KeyHash{});  // another representation
  EXPECT_FALSE(KeyLayout().has_key());
  EXPECT_EQ(KeyLayout().of_data(octets({0, 1, 0, 0, 1, 2, 3, 4})), KeyHash{});
}

std::string hex(const std::array<std::uint8_t, 16>& digest) {
  std::string text;
  for (const std::uint8_t octet : digest) {
    text += "0123456789abcdef"[octet >> 4];
    text += "0123456789abcdef"[octet & 15];
  }
  return text;
}
std::string md5_of(std::string_view text) {
  return hex(md5(std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size())));
}

// The test suite of RFC 1321, A.5.
TEST(Md5, TestSuite) {
  EXPECT_EQ(md5_of(""), "d41d8cd98f00b204e9800998ecf8427e");
  EXPECT_EQ(md5_of("a"), "0cc175b9c0f1b6a831c399e269772661");
  EXPECT_EQ(md5_of("abc"), "900150983cd24fb0d6963f7d28e17f72");
  EXPECT_EQ(md5_of("message digest"), "f96b697d7cb7938d525a2f31aaf161d0");
  EXPECT_EQ(md5_of("abcdefghijklmnopqrstuvwxyz"), "c3fcd3d76192e4007dfb496cca67e13b");
  EXPECT_EQ(md5_of("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789"),
            "d174ab98d277d9f5a5611c2c9f419d9f");
  EXPECT_EQ(md5_of("12345678901234567890123456789012345678901234567890123456789012345678901234567890"),
            "57edf4a22be3c955ac49da2e2107b67a");
}

// struct { @key unsigned long long a[3]; octet v; }: 24 octets of key, whatever the byte order of the payload.
TEST(KeyLayout, ALongKeyIsHashed) {
  const IdlStruct longer{"L", {{"a", IdlKind::uint64, IdlCollection::array, 3}, {"v", IdlKind::octet}}};
  const KeyLayout layout(longer, std::vector<std::string>{"a"});
  EXPECT_FALSE(layout.is_in_hash());
  const std::vector<std::uint8_t> key{0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 3};
  const auto little = octets({0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 3, 0, 0, 0, 0, 0, 0, 0, 9});
  const auto big = octets({0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 3, 9});
  EXPECT_EQ(layout.of_data(little), md5(key));
  EXPECT_EQ(layout.of_data(big), md5(key));
  EXPECT_EQ(layout.of_key(octets({0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 3})),
            md5(key));
  EXPECT_EQ(layout.key_in_data(little), key);
  EXPECT_EQ(layout.of_data(octets({0, 1, 0, 0, 1, 0})), KeyHash{});
}

}  // namespace
}  // namespace takt::gateway::key_layout_test
