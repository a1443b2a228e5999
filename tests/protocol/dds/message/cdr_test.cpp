// SPDX-License-Identifier: Apache-2.0
// CDR: octets by hand, and round trips of whatever is drawn.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "dds/message/cdr_reader.hpp"
#include "dds/message/cdr_writer.hpp"
#include "dds/octets.hpp"

namespace takt::dds {
namespace {

using namespace test;

constexpr std::array<Encapsulation, 4> plain{Encapsulation::cdr_be, Encapsulation::cdr_le, Encapsulation::cdr2_be,
                                             Encapsulation::cdr2_le};

template <class Put>
std::string hex(Encapsulation encapsulation, Put put) {
  std::vector<std::byte> buffer(256);
  CdrWriter writer(buffer, encapsulation);
  put(writer);
  return hex_of(writer.finish());
}

// XCDR1 aligns a double to 8, XCDR2 to 4, both from behind the encapsulation header; the options tell the octets that
// fill up.
TEST(Cdr, AlignsFromBehindTheHeader) {
  const auto put = [](CdrWriter& writer) {
    writer.put(std::uint32_t{0x01020304});
    writer.put(1.0);
    writer.put(std::uint8_t{5});
  };
  EXPECT_EQ(hex(Encapsulation::cdr_le, put),
            "00010003"
            "04030201"
            "00000000"
            "000000000000f03f"
            "05000000");
  EXPECT_EQ(hex(Encapsulation::cdr_be, put),
            "00000003"
            "01020304"
            "00000000"
            "3ff0000000000000"
            "05000000");
  EXPECT_EQ(hex(Encapsulation::cdr2_le, put),
            "00070003"
            "04030201"
            "000000000000f03f"
            "05000000");
}

TEST(Cdr, StringsAndSequences) {
  const std::array<std::uint16_t, 3> numbers{1, 2, 3};
  const auto put = [&](CdrWriter& writer) {
    writer.put(std::string_view("ab"));
    writer.put(true);
    writer.put_sequence(std::span<const std::uint16_t>(numbers));
    writer.put_array(std::span<const std::uint16_t>(numbers));
  };
  EXPECT_EQ(hex(Encapsulation::cdr_le, put),
            "00010000"
            "03000000"
            "616200"
            "01"
            "03000000"
            "010002000300"
            "010002000300");
  EXPECT_EQ(hex(Encapsulation::cdr_le, [](CdrWriter& writer) { writer.put(std::string_view()); }),
            "00010003"
            "01000000"
            "00000000");
}

TEST(Cdr, WhatDoesNotFitGivesNothing) {
  std::array<std::byte, 10> buffer;
  CdrWriter writer(buffer);
  writer.put(std::uint32_t{1});
  writer.put(std::uint32_t{1});
  EXPECT_TRUE(writer.finish().empty());
}

TEST(Cdr, ReadsBothByteOrdersAndVersions) {
  for (const Encapsulation encapsulation : plain) {
    const std::vector<std::byte> octets = octets_of(hex(encapsulation, [](CdrWriter& writer) {
      writer.put(std::uint8_t{1});
      writer.put(std::int64_t{-2});
      writer.put(std::string_view("text"));
      writer.put(2.5F);
      writer.put(true);
    }));
    CdrReader reader(octets);
    EXPECT_EQ(reader.get<std::uint8_t>(), 1);
    EXPECT_EQ(reader.get<std::int64_t>(), -2);
    EXPECT_EQ(reader.get_string(), "text");
    EXPECT_EQ(reader.get<float>(), 2.5F);
    EXPECT_TRUE(reader.get_bool());
    EXPECT_FALSE(reader.failed());
    EXPECT_EQ(reader.left(), 0u) << "what fills up belongs to nobody";
    reader.get<std::uint8_t>();
    EXPECT_TRUE(reader.failed());
  }
}

TEST(Cdr, RefusesWhatItDoesNotRead) {
  const auto representation = [](const std::string& hex) {
    const std::vector<std::byte> octets = octets_of(hex);
    CdrReader reader(octets);
    EXPECT_TRUE(reader.failed());
    EXPECT_EQ(reader.get<std::uint32_t>(), 0u);
    return name_of(reader.representation());
  };
  EXPECT_EQ(representation("00030000"
                           "01000000"),
            "PL_CDR");
  EXPECT_EQ(representation("00090000"
                           "01000000"),
            "D_CDR2");
  EXPECT_EQ(representation("000b0000"
                           "01000000"),
            "PL_CDR2");
  EXPECT_EQ(representation("00040000"
                           "01000000"),
            "unknown representation");
  EXPECT_EQ(representation("80000000"
                           "01000000"),
            "unknown representation");
  EXPECT_EQ(representation("0001"), "truncated");
}

TEST(Cdr, RefusesWhatContradictsItself) {
  const auto string = [](const std::string& hex) {
    const std::vector<std::byte> octets = octets_of("00010000" + hex);
    CdrReader reader(octets);
    const std::string text(reader.get_string());
    return reader.failed() ? "failed" : text;
  };
  EXPECT_EQ(string("02000000"
                   "6100"),
            "a");
  EXPECT_EQ(string("00000000"), "");
  EXPECT_EQ(string("02000000"
                   "6162"),
            "failed")
      << "no end";
  EXPECT_EQ(string("03000000"
                   "610000"),
            "failed")
      << "two ends";
  EXPECT_EQ(string("ffffffff"
                   "6100"),
            "failed");
  const std::vector<std::byte> octets = octets_of(
      "00010000"
      "ffffff7f"
      "00000000");
  CdrReader reader(octets);
  EXPECT_TRUE(reader.get_sequence<std::uint64_t>().empty());
  EXPECT_TRUE(reader.failed());
  const std::vector<std::byte> two = octets_of(
      "00010000"
      "02");
  CdrReader boolean(two);
  boolean.get_bool();
  EXPECT_TRUE(boolean.failed());
}

TEST(Cdr, RoundTripOfWhateverIsDrawn) {
  EXPECT_TRUE(rc::check("values survive", [](std::uint8_t a, std::int16_t b, std::uint64_t c,
                                             std::vector<std::int32_t> d, std::vector<std::int64_t> e, bool f) {
    const auto text = *rc::gen::container<std::string>(rc::gen::inRange<char>(1, 127));
    for (const Encapsulation encapsulation : plain) {
      std::vector<std::byte> buffer(8192);
      CdrWriter writer(buffer, encapsulation);
      writer.put(a);
      writer.put(c);
      writer.put(b);
      writer.put(std::string_view(text));
      writer.put_sequence(std::span<const std::int64_t>(e));
      writer.put(f);
      writer.put_sequence(std::span<const std::int32_t>(d));
      const Octets octets = writer.finish();
      RC_ASSERT(octets.size() % 4 == 0 && !octets.empty());
      CdrReader reader(octets);
      RC_ASSERT(reader.get<std::uint8_t>() == a);
      RC_ASSERT(reader.get<std::uint64_t>() == c);
      RC_ASSERT(reader.get<std::int16_t>() == b);
      RC_ASSERT(reader.get_string() == text);
      RC_ASSERT(reader.get_sequence<std::int64_t>() == e);
      RC_ASSERT(reader.get_bool() == f);
      RC_ASSERT(reader.get_sequence<std::int32_t>() == d);
      RC_ASSERT(!reader.failed() && reader.left() == 0);
    }
  }));
}

}  // namespace
}  // namespace takt::dds
