// SPDX-License-Identifier: Apache-2.0
// What the decoder refuses, and that nothing makes it read beyond its input, loop or allocate by a length.
#include <gtest/gtest.h>

#include <string>

#include "uadp/message_json.hpp"

namespace takt::uadp {
namespace {

DecodeStatus verdict_of(const std::string& hex) {
  const std::vector<std::byte> octets = octets_of(hex);
  NetworkMessage message;
  return decode(octets, message);
}

TEST(Malformed, NetworkMessages) {
  EXPECT_EQ(verdict_of(""), DecodeStatus::truncated);
  EXPECT_EQ(verdict_of("00"), DecodeStatus::version);
  EXPECT_EQ(verdict_of("02"), DecodeStatus::version);
  EXPECT_EQ(verdict_of("01"), DecodeStatus::ok) << "no PublisherId, no header, an empty payload";
  EXPECT_EQ(verdict_of("9105"), DecodeStatus::reserved) << "type 5 of PublisherId";
  EXPECT_EQ(verdict_of("8101"), DecodeStatus::ok) << "a type without a PublisherId says nothing";
  EXPECT_EQ(verdict_of("8107"), DecodeStatus::ok) << "not even one that is reserved";
  EXPECT_EQ(verdict_of("9107"), DecodeStatus::reserved);
  EXPECT_EQ(verdict_of("2110"), DecodeStatus::reserved) << "bit 4 of GroupFlags";
  EXPECT_EQ(verdict_of("2101"), DecodeStatus::truncated) << "no WriterGroupId";
  EXPECT_EQ(verdict_of("4100"), DecodeStatus::malformed) << "no DataSetMessage";
  EXPECT_EQ(verdict_of("41020100"), DecodeStatus::truncated);
  EXPECT_EQ(verdict_of("4102010002000100020001"), DecodeStatus::truncated) << "sizes 1 + 2, one octet is there";
  EXPECT_EQ(verdict_of("41020100020001000200010101"), DecodeStatus::ok);
  EXPECT_EQ(verdict_of("818040"), DecodeStatus::reserved) << "bit 6 of ExtendedFlags2";
  EXPECT_EQ(verdict_of("81800c"), DecodeStatus::reserved) << "message type 3";
  EXPECT_EQ(verdict_of("81800203000101"), DecodeStatus::truncated) << "three octets of promoted fields, two are there";
  EXPECT_EQ(verdict_of("8180020200"
                       "01ff"),
            DecodeStatus::ok);
  EXPECT_EQ(verdict_of("8180020200"
                       "3f00"),
            DecodeStatus::malformed)
      << "no type 63";
  EXPECT_EQ(verdict_of("9104ffffff7f"), DecodeStatus::truncated) << "a PublisherId of 2 GiB";
  EXPECT_EQ(verdict_of("9104feffffff"), DecodeStatus::truncated) << "a length of -2";
}

// Beginnings of what open62541 1.5 sends with PublisherId off: the type bits are those of the PublisherId that it does
// not send.
TEST(Malformed, StrangersWithoutAPublisherId) {
  for (const std::string hex : {"8101e11000",
                                "e10101640001"
                                "0100"
                                "01000000"}) {
    const std::vector<std::byte> octets = octets_of(hex);
    NetworkMessage message;
    EXPECT_EQ(decode(octets, message), DecodeStatus::ok) << hex;
    EXPECT_FALSE(message.header.publisher_id) << hex;
  }
  const std::vector<std::byte> octets = octets_of(
      "e101016400010100"
      "01000000");
  NetworkMessage message;
  ASSERT_EQ(decode(octets, message), DecodeStatus::ok);
  EXPECT_EQ(message.header.group->writer_group_id, 100);
  EXPECT_EQ(message.count(), 1u);
  EXPECT_EQ(message.writer_id(0), 1);
}

TEST(Malformed, WhatIsNotSupportedIsToldByName) {
  NetworkMessage message;
  const std::vector<std::byte> secured = octets_of("b131640009010000010000000000000000010500000008deadbeef4d000000");
  EXPECT_EQ(decode(secured, message), DecodeStatus::secured);
  EXPECT_EQ(message.header.publisher_id, PublisherId::uint16(100));
  ASSERT_TRUE(message.security);
  EXPECT_EQ(message.security->token_id, 5u);
  EXPECT_EQ(message.security->nonce.size(), 8u);
  EXPECT_EQ(verdict_of("9191046400"
                       "00"),
            DecodeStatus::discovery);
  EXPECT_EQ(verdict_of("9191086400"
                       "00"),
            DecodeStatus::discovery);
  EXPECT_EQ(verdict_of("d18101640001"), DecodeStatus::chunked);
  EXPECT_EQ(verdict_of("d18120640001"), DecodeStatus::action);
}

TEST(Malformed, DataSetMessages) {
  const auto verdict = [](const std::string& hex) {
    const std::vector<std::byte> octets = octets_of(hex);
    DataSetMessage message;
    return decode(octets, message);
  };
  EXPECT_EQ(verdict(""), DecodeStatus::truncated);
  EXPECT_EQ(verdict("00"), DecodeStatus::ok) << "not valid: nothing else counts";
  EXPECT_EQ(verdict("06"), DecodeStatus::ok);
  EXPECT_EQ(verdict("07"), DecodeStatus::reserved) << "field encoding 3";
  EXPECT_EQ(verdict("8104"), DecodeStatus::reserved) << "message type 4";
  EXPECT_EQ(verdict("8140"), DecodeStatus::reserved) << "bit 6 of DataSetFlags2";
  EXPECT_EQ(verdict("0901"), DecodeStatus::truncated) << "half a sequence number";
  EXPECT_EQ(verdict("8301"), DecodeStatus::malformed) << "a delta frame of RawData";
  EXPECT_EQ(verdict("8502"), DecodeStatus::malformed) << "an event of DataValues";
}

TEST(Malformed, Bodies) {
  const auto well_formed = [](const std::string& hex) {
    const std::vector<std::byte> octets = octets_of(hex);
    DataSetMessage message;
    EXPECT_EQ(decode(octets, message), DecodeStatus::ok);
    return is_well_formed(message);
  };
  EXPECT_TRUE(
      well_formed("01010006"
                  "01000000"));
  EXPECT_FALSE(
      well_formed("01010006"
                  "010000"));
  EXPECT_FALSE(well_formed("0101001a")) << "type 26";
  EXPECT_FALSE(
      well_formed("010100"
                  "86ffffff7f"))
      << "an array of 2^31 - 1";
  EXPECT_FALSE(
      well_formed("010100"
                  "80ffffff7f"))
      << "an array of nothing, without end";
  EXPECT_TRUE(
      well_formed("010100"
                  "86ffffffff"))
      << "a null array";
  EXPECT_FALSE(
      well_formed("010100"
                  "86feffffff"));
  EXPECT_FALSE(
      well_formed("010100"
                  "4601000000"))
      << "dimensions of a scalar";
  EXPECT_FALSE(
      well_formed("010100"
                  "18"
                  "0101"))
      << "a Variant in a Variant";
  EXPECT_TRUE(
      well_formed("010100"
                  "98"
                  "01000000"
                  "0101"))
      << "an array of Variants";
  EXPECT_FALSE(
      well_formed("010100"
                  "c3"
                  "04000000"
                  "01020304"
                  "02000000"
                  "02000000"
                  "03000000"))
      << "2 x 3 is not 4";
  EXPECT_TRUE(
      well_formed("010100"
                  "c3"
                  "04000000"
                  "01020304"
                  "02000000"
                  "02000000"
                  "02000000"));
  EXPECT_FALSE(
      well_formed("050100"
                  "40"))
      << "bit 6 of a DataValue's mask";
  std::string nested;
  for (int i = 0; i < 40; ++i) nested += "9801000000";
  EXPECT_FALSE(well_formed("010100" + nested + "0101")) << "40 levels";
}

/// Reads all that there is to read.
std::size_t read_all(Octets octets) {
  NetworkMessage message;
  if (decode(octets, message) != DecodeStatus::ok) return 0;
  std::size_t fields = 0;
  for (std::size_t i = 0; i < message.count(); ++i) {
    DataSetMessage each;
    if (decode(message.data_set_message(i), each) != DecodeStatus::ok) continue;
    FieldReader reader(each);
    while (const auto field = reader.next()) {
      ++fields;
      if (field->value.value && field->value.value->type == BuiltInType::String) {
        const auto& variant = *field->value.value;
        for (std::size_t k = 0; k < variant.size(); ++k) fields += variant.at<std::string_view>(k).value_or("").size();
      }
    }
  }
  return fields;
}

// Two hundred thousand small damages of sound messages, and noise. The generator is a fixed linear congruence.
TEST(Malformed, DamageIsHarmless) {
  const std::vector<std::string> seeds = {
      "f101ba08016400020100020035001e0001060006feffffff0b00000000000000400b00000000000008400b00000000000010400b00000000"
      "00001440"
      "0b000000000000184001030000010101010101",
      "f169ba08000000000000000000000000000000000f64004d0000000100000001010000000000000000000000f9100000d5e9ef416f79dd01"
      "0000b814"
      "641c4512641c010006feffffff",
      "f101ba08016400010100010300"
      "8c0200000001000000780200000079798b0200000000000000000000000000000000000000"
      "1104010001020304050607080910111213141516",
      "f101ba080164000101000501003f0b000000000000f83f0000004000c083ed8a49da01780039f083ed8a49da015401"};
  std::uint64_t state = 1;
  const auto draw = [&] { return (state = state * 6364136223846793005U + 1442695040888963407U) >> 33; };
  std::size_t read = 0;
  for (int i = 0; i < 200'000; ++i) {
    std::vector<std::byte> octets = octets_of(seeds[draw() % seeds.size()]);
    const auto damages = draw() % 4;
    for (std::uint64_t k = 0; k < damages; ++k) octets[draw() % octets.size()] = static_cast<std::byte>(draw() & 0xFF);
    if (draw() % 4 == 0) octets.resize(draw() % octets.size());
    octets.shrink_to_fit();
    read += read_all(octets);
  }
  EXPECT_GT(read, 100'000u) << "some survive";
}

TEST(Verdicts, AreCounted) {
  DecodeStatusCounts counts;
  counts.count(DecodeStatus::ok);
  counts.count(DecodeStatus::secured);
  counts.count(DecodeStatus::secured);
  EXPECT_EQ(counts[DecodeStatus::secured], 2u);
  EXPECT_EQ(counts.dropped(), 2u);
  EXPECT_EQ(name_of(DecodeStatus::action), "action");
}

}  // namespace
}  // namespace takt::uadp
