// Key hashes, octet for octet, against ones written out by hand (DDSI-RTPS 2.5, 9.6.4.8).
#include "gateway/key_layout.hpp"

#include <gtest/gtest.h>

namespace takt::gateway {
namespace {

std::vector<std::byte> octets(std::initializer_list<unsigned> values) {
  std::vector<std::byte> all;
  for (const unsigned value : values) all.push_back(static_cast<std::byte>(value));
  return all;
}

/// struct { octet a; @key unsigned long b; double c; @key short d[3]; }
const IdlStruct type{"T", {{"a", IdlKind::octet}, {"b", IdlKind::uint32}, {"c", IdlKind::float64}, {"d", IdlKind::int16, IdlCollection::array, 3}}};
const std::vector<std::string> keys{"d", "b"};  // the order of the declaration counts
constexpr KeyHash hash{1, 2, 3, 4, 5, 6, 7, 8, 9, 10};

TEST(KeyLayout, IsBigEndianWhateverThePayloadIs) {
  const KeyLayout layout(type, keys);
  EXPECT_TRUE(layout.has_key());
  EXPECT_EQ(layout.octets(), 10u);
  EXPECT_EQ(layout.of_data(octets({0, 1, 0, 0, 99, 0, 0, 0, 4, 3, 2, 1, 0, 0, 0, 0, 0, 0, 0, 0, 6, 5, 8, 7, 10, 9})), hash);   // CDR_LE
  EXPECT_EQ(layout.of_data(octets({0, 0, 0, 0, 99, 0, 0, 0, 1, 2, 3, 4, 0, 0, 0, 0, 0, 0, 0, 0, 5, 6, 7, 8, 9, 10})), hash);   // CDR_BE
  EXPECT_EQ(layout.of_key(octets({0, 1, 0, 0, 4, 3, 2, 1, 6, 5, 8, 7, 10, 9})), hash);
  EXPECT_EQ(layout.of_key(octets({0, 0, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10})), hash);
}

TEST(KeyLayout, WhatIsNoPayloadHasNoKey) {
  const KeyLayout layout(type, keys);
  EXPECT_EQ(layout.of_data({}), KeyHash{});
  EXPECT_EQ(layout.of_data(octets({0, 1, 0, 0, 99, 0, 0, 0, 4, 3, 2, 1})), KeyHash{});      // too short
  EXPECT_EQ(layout.of_key(octets({0, 7, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10})), KeyHash{});  // another representation
  EXPECT_FALSE(KeyLayout().has_key());
  EXPECT_EQ(KeyLayout().of_data(octets({0, 1, 0, 0, 1, 2, 3, 4})), KeyHash{});
}

}  // namespace
}  // namespace takt::gateway
