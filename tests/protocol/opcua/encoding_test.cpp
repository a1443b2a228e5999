// SPDX-License-Identifier: Apache-2.0
// OPC UA Binary against octets that were derived by hand from OPC 10000-6, 5.2, and what is refused.
#include <gtest/gtest.h>

#include "opcua/encoding/decoder.hpp"
#include "transcript.hpp"

namespace takt::opcua {
namespace {

using test::hexadecimal;
using test::octets_of;

template <class T>
std::string written(const T& value) {
  Encoder encoder;
  encode(encoder, value);
  return hexadecimal(encoder.octets());
}

template <class T>
StatusCode read(const std::string& octets, T& value, const DecodingLimits& limits = {}) {
  const auto source = octets_of(octets);
  Decoder decoder(source, limits);
  decode(decoder, value);
  return decoder.status();
}

template <class T>
void expect_both_ways(const T& value, const std::string& octets) {
  EXPECT_EQ(written(value), octets);
  T again;
  EXPECT_EQ(read(octets, again), StatusCode::Good) << octets;
  EXPECT_EQ(again, value) << octets;
}

TEST(Encoding, NodeIdsInTheirShortestForm) {
  expect_both_ways(NodeId(), "0000");
  expect_both_ways(NodeId(72), "0048");            // example of 5.2.2.9
  expect_both_ways(NodeId(5, 1025u), "01050104");  // example of 5.2.2.9
  expect_both_ways(NodeId(0, 70'000u), "02000070110100");
  expect_both_ways(NodeId(1, "Hot"), "03010003000000486f74");
}

TEST(Encoding, NamesAndTexts) {
  expect_both_ways(QualifiedName{1, Text("ab")}, "0100020000006162");
  expect_both_ways(LocalizedText("en", "x"), "0302000000656e0100000078");
  expect_both_ways(LocalizedText(), "00");
  EXPECT_EQ(written(Text()), "ffffffff");
  EXPECT_EQ(written(Text("")), "00000000");
}

TEST(Encoding, Variants) {
  expect_both_ways(Variant(std::int32_t{5}), "0605000000");
  expect_both_ways(Variant(true), "0101");
  expect_both_ways(Variant::array<std::uint8_t>({1, 2}), "83020000000102");
  expect_both_ways(Variant(Text("a")), "0c0100000061");
  expect_both_ways(Variant(NodeId(2402)), "1101006209");
  Variant matrix = Variant::array<std::uint8_t>({1, 2});
  matrix.dimensions = {2, 1};
  expect_both_ways(matrix,
                   "c30200000001020200000002000000"
                   "01000000");
}

TEST(Encoding, DataValuesKeepTheOrderOfTheStream) {
  DataValue value;
  value.value = Variant(std::uint8_t{7});
  value.status = StatusCode::BadInvalidState;
  value.source_time = DateTime{1};
  value.server_time = DateTime{2};
  value.source_picoseconds = std::uint16_t{3};
  expect_both_ways(value, "1f03070000af80010000000000000003000200000000000000");
}

TEST(Encoding, WhatIsNotSoundIsRefused) {
  Variant variant;
  for (const char* const octets : {"18", "06", "0605", "c6", "4605000000", "80", "86fdffffff", "8605000000", "3f",
                                   "1800", "c30200000001020100000003000000"})  // dimensions that are not the count
    EXPECT_NE(read(octets, variant), StatusCode::Good) << octets;
  NodeId id;
  for (const char* const octets : {"", "06", "7f", "0300", "030100ffffff7f", "030100feffffff"})
    EXPECT_EQ(read(octets, id), StatusCode::BadDecodingError) << octets;
  LocalizedText text;
  EXPECT_EQ(read("04", text), StatusCode::BadDecodingError);
}

TEST(Encoding, LimitsBoundWhatIsKept) {
  DecodingLimits limits;
  limits.text_octets = 2;
  limits.array_elements = 3;
  limits.elements = 4;
  Text text;
  EXPECT_EQ(read("0300000061626364", text, limits), StatusCode::BadEncodingLimitsExceeded);
  EXPECT_EQ(read("0200000061626364", text, limits), StatusCode::Good);
  List<std::uint8_t> list;
  EXPECT_EQ(read("0400000001020304", list, limits), StatusCode::BadEncodingLimitsExceeded);
  EXPECT_EQ(read("03000000010203", list, limits), StatusCode::Good);
  // Two arrays of three are more than four elements in all: an array of two arrays of Bytes.
  Variant nested;
  EXPECT_EQ(read("9802000000"
                 "8302000000"
                 "0102"
                 "8301000000"
                 "01",
                 nested, limits),
            StatusCode::BadEncodingLimitsExceeded);
}

// Values in values in values: an array of one Variant, of one Variant, and so on.
TEST(Encoding, DepthIsBounded) {
  const auto nested = [](int depth) {
    std::string octets;
    for (int i = 0; i < depth; ++i) octets += "9801000000";
    return octets + "0101";
  };
  Variant value;
  EXPECT_EQ(read(nested(7), value), StatusCode::Good);
  EXPECT_EQ(read(nested(8), value), StatusCode::BadEncodingLimitsExceeded);
  EXPECT_EQ(read(nested(10'000), value), StatusCode::BadEncodingLimitsExceeded);
  DiagnosticInfo info;
  std::string diagnostics;
  for (int i = 0; i < 100; ++i) diagnostics += "40";
  EXPECT_EQ(read(diagnostics + "00", info), StatusCode::BadEncodingLimitsExceeded);
}

TEST(Encoding, AnEncoderStopsAtItsLimit) {
  Encoder encoder(5);
  encode(encoder, std::uint32_t{1});
  EXPECT_FALSE(encoder.overflowed());
  encode(encoder, std::uint16_t{1});
  EXPECT_TRUE(encoder.overflowed());
  EXPECT_EQ(encoder.position(), 4u);
}

}  // namespace
}  // namespace takt::opcua
