// SPDX-License-Identifier: Apache-2.0
// RawData: fixed offsets, padded strings and arrays.
#include "uadp/raw_layout.hpp"

#include <gtest/gtest.h>

#include "uadp/message_json.hpp"

namespace takt::uadp {
namespace {

template <class T>
std::vector<std::byte> variant_of(const T& value) {
  std::vector<std::byte> octets(64);
  Writer writer(octets);
  put_variant(writer, value);
  octets.resize(writer.finished().size());
  return octets;
}
Variant read(const std::vector<std::byte>& octets) {
  Reader reader(octets);
  return get_variant(reader);
}

// Int16 at 0; string of 5 at 2 (4 + 5); array of 3 UInt16 at 11 (4 + 6); Boolean at 21; two strings of 2 at 22 (4 + 2 x
// 6).
const RawLayout layout({{BuiltInType::Int16},
                        {BuiltInType::String, false, 0, 5},
                        {BuiltInType::UInt16, true, 3},
                        {BuiltInType::Boolean},
                        {BuiltInType::String, true, 2, 2}});

TEST(RawLayouts, OffsetsAndPadding) {
  EXPECT_EQ(layout.offset(1), 2u);
  EXPECT_EQ(layout.offset(2), 11u);
  EXPECT_EQ(layout.offset(3), 21u);
  EXPECT_EQ(layout.offset(4), 22u);
  EXPECT_EQ(layout.size(), 38u);
  std::vector<std::byte> buffer(38);
  Writer writer(buffer);
  const std::array<std::uint16_t, 2> numbers{1, 2};
  const std::array<std::string_view, 2> texts{"a", "bc"};
  const auto a = variant_of(std::int16_t{-2}), b = variant_of(std::string_view("xyz")), d = variant_of(true);
  const auto c = variant_of(std::span<const std::uint16_t>(numbers)),
             e = variant_of(std::span<const std::string_view>(texts));
  EXPECT_TRUE(layout.put(writer, 0, read(a)));
  EXPECT_TRUE(layout.put(writer, 1, read(b)));
  EXPECT_TRUE(layout.put(writer, 2, read(c)));
  EXPECT_TRUE(layout.put(writer, 3, read(d)));
  EXPECT_TRUE(layout.put(writer, 4, read(e)));
  EXPECT_EQ(hex_of(writer.finished()),
            "feff"
            "0300000078797a0000"
            "02000000010002000000"
            "01"
            "02000000"
            "010000006100"
            "020000006263");

  EXPECT_EQ(layout.at(buffer, 0)->get<std::int16_t>(), -2);
  EXPECT_EQ(layout.at(buffer, 1)->get<std::string_view>(), "xyz");
  EXPECT_EQ(layout.at(buffer, 2)->size(), 2u);
  EXPECT_EQ(layout.at(buffer, 2)->at<std::uint16_t>(1), 2);
  EXPECT_EQ(layout.at(buffer, 4)->at<std::string_view>(0), "a");
  EXPECT_EQ(layout.at(buffer, 4)->at<std::string_view>(1), "bc");
  // A padded array of strings becomes a packed one as a Variant.
  std::vector<std::byte> packed(64);
  Writer again(packed);
  put_variant(again, *layout.at(buffer, 4));
  EXPECT_EQ(hex_of(again.finished()), hex_of(e));
}

TEST(RawLayouts, WhatDoesNotFitBecomesZeros) {
  std::vector<std::byte> buffer(38, std::byte{0xFF});
  Writer writer(buffer);
  const auto number = variant_of(1.5), text = variant_of(std::string_view("longer"));
  EXPECT_FALSE(layout.put(writer, 0, read(number))) << "another type";
  EXPECT_FALSE(layout.put(writer, 1, read(text))) << "six octets, five fit";
  EXPECT_EQ(hex_of(writer.finished()),
            "0000"
            "000000000000000000");
}

TEST(RawLayouts, LengthsInABodyAreNotTrusted) {
  std::vector<std::byte> body(38);
  body[2] = std::byte{6};  // a string of six where five fit
  EXPECT_FALSE(layout.at(body, 1));
  body[2] = std::byte{0};
  EXPECT_TRUE(layout.at(body, 1));
  body[11] = std::byte{4};  // four elements where three fit
  EXPECT_FALSE(layout.at(body, 2));
  body[14] = std::byte{0x80};
  EXPECT_FALSE(layout.at(body, 2));
  EXPECT_FALSE(layout.at(Octets(body).first(37), 4)) << "too short";
}

TEST(RawLayouts, EveryFieldNeedsALength) {
  EXPECT_EQ(RawLayout::problem_of({BuiltInType::Double}), "");
  EXPECT_NE(RawLayout::problem_of({BuiltInType::String}), "");
  EXPECT_NE(RawLayout::problem_of({BuiltInType::Double, true}), "");
  EXPECT_NE(RawLayout::problem_of({BuiltInType::NodeId}), "");
  EXPECT_THROW(RawLayout({{BuiltInType::Variant}}), sim::InvariantBroken);
}

}  // namespace
}  // namespace takt::uadp
