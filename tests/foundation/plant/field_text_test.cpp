// SPDX-License-Identifier: Apache-2.0
// Values that files write as text, by hand.
#include "plant/field_text.hpp"

#include <gtest/gtest.h>

namespace takt::plant {
namespace {

using Octets = std::vector<std::byte>;

Octets octets(std::initializer_list<int> values) {
  Octets all;
  for (const int each : values) all.push_back(static_cast<std::byte>(each));
  return all;
}

// 1601-01-01 is 0; a day is 864 * 10^9 ticks of 100 ns, and 0xC92A69C000 that; 1970 is 0x019DB1DED53E8000.
TEST(FieldText, Times) {
  EXPECT_EQ(octets_of_text(TopicType::date_time, "1601-01-01T00:00:00Z"), octets({0, 0, 0, 0, 0, 0, 0, 0}));
  EXPECT_EQ(octets_of_text(TopicType::date_time, "1601-01-02T00:00:00Z"),
            octets({0x00, 0xC0, 0x69, 0x2A, 0xC9, 0, 0, 0}));
  EXPECT_EQ(octets_of_text(TopicType::date_time, "1970-01-01T00:00:00Z"),
            octets({0x00, 0x80, 0x3E, 0xD5, 0xDE, 0xB1, 0x9D, 0x01}));
  EXPECT_EQ(octets_of_text(TopicType::date_time, "1601-01-01T00:00:00.5Z"), octets({0x40, 0x4B, 0x4C, 0, 0, 0, 0, 0}));
  for (const char* const wrong :
       {"", "1601-01-01", "1601-01-01T00:00:00", "1600-12-31T00:00:00Z", "2023-02-29T00:00:00Z", "2024-01-01T24:00:00Z",
        "2024-01-01T00:60:00Z", "2024-01-01T00:00:00.Z", "2024-01-01T00:00:00.12345678Z", "2024-01-01T00:00:0xZ",
        "2024-01-01 00:00:00Z", "2024-01-01T00:00:00+01Z"})
    EXPECT_FALSE(octets_of_text(TopicType::date_time, wrong)) << wrong;
  EXPECT_TRUE(octets_of_text(TopicType::date_time, "2024-02-29T23:59:59.1234567Z"));
}

TEST(FieldText, GuidsAndTexts) {
  EXPECT_EQ(octets_of_text(TopicType::guid, "00112233-4455-6677-8899-aAbBcCdDeEfF"),
            octets({0x33, 0x22, 0x11, 0, 0x55, 0x44, 0x77, 0x66, 0x88, 0x99, 0xAA, 0xBB, 0xCC, 0xDD, 0xEE, 0xFF}));
  for (const char* const wrong : {"", "00112233-4455-6677-8899-aabbccddeef", "00112233x4455-6677-8899-aabbccddeeff",
                                  "00112233-4455-6677-8899-aabbccddeefg", "0011223-34455-6677-8899-aabbccddeeff"})
    EXPECT_FALSE(octets_of_text(TopicType::guid, wrong)) << wrong;
  EXPECT_EQ(octets_of_text(TopicType::string, "ab"), octets({2, 0, 0, 0, 'a', 'b'}));
  EXPECT_EQ(octets_of_text(TopicType::string, ""), octets({0, 0, 0, 0}));
  EXPECT_EQ(octets_of_text(TopicType::byte_string, "0aFF"), octets({2, 0, 0, 0, 0x0A, 0xFF}));
  EXPECT_FALSE(octets_of_text(TopicType::byte_string, "0"));
  EXPECT_FALSE(octets_of_text(TopicType::byte_string, "0g"));
  EXPECT_FALSE(octets_of_text(TopicType::int32, "1"));
}

}  // namespace
}  // namespace takt::plant
