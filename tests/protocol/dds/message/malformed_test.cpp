// SPDX-License-Identifier: Apache-2.0
// What the decoder refuses, and that nothing makes it read beyond its input, loop or allocate by a length.
#include <gtest/gtest.h>

#include "dds/message/cdr_reader.hpp"
#include "dds/message/decoder.hpp"
#include "dds/message/samples.hpp"

namespace takt::dds {
namespace {

using namespace test;

const std::string header =
    "52545053"
    "0201"
    "0110"
    "0102030405060708090a0b0c";

struct Outcome {
  MessageStatus verdict = MessageStatus::ok;
  std::size_t taken = 0;
  std::uint64_t skipped = 0;
  bool operator==(const Outcome&) const = default;
};
void PrintTo(const Outcome& outcome, std::ostream* out) {
  *out << name_of(outcome.verdict) << ", " << outcome.taken << " taken, " << outcome.skipped << " skipped";
}

Outcome outcome_of(const std::string& hex) {
  const std::vector<std::byte> octets = octets_of(hex);
  MessageDecoder decoder(octets);
  Outcome outcome;
  while (decoder.next()) ++outcome.taken;
  outcome.verdict = decoder.verdict();
  outcome.skipped = decoder.skipped();
  return outcome;
}
MessageStatus verdict_of(const std::string& submessages) { return outcome_of(header + submessages).verdict; }

TEST(Malformed, Headers) {
  EXPECT_EQ(outcome_of("").verdict, MessageStatus::truncated);
  EXPECT_EQ(outcome_of("525450").verdict, MessageStatus::truncated);
  EXPECT_EQ(outcome_of("52545054"
                       "0201"
                       "0110"
                       "0102030405060708090a0b0c")
                .verdict,
            MessageStatus::not_rtps);
  EXPECT_EQ(outcome_of("52545053"
                       "0201"
                       "0110"
                       "0102030405060708090a0b")
                .verdict,
            MessageStatus::truncated);
  EXPECT_EQ(outcome_of("52545053"
                       "0100"
                       "0110"
                       "0102030405060708090a0b0c")
                .verdict,
            MessageStatus::version);
  EXPECT_EQ(outcome_of("52545053"
                       "0300"
                       "0110"
                       "0102030405060708090a0b0c")
                .verdict,
            MessageStatus::version);
  EXPECT_EQ(outcome_of("52545053"
                       "0209"
                       "0110"
                       "0102030405060708090a0b0c")
                .verdict,
            MessageStatus::ok)
      << "a later minor version";
}

TEST(Malformed, WhatIsNotKnownIsPassedOverAndCounted) {
  EXPECT_EQ(outcome_of(header + "80010400"
                                "00000000"
                                "01010000"
                                "40010000"),
            (Outcome{MessageStatus::ok, 1, 2}))
      << "a vendor's, PAD, one without a length";
  EXPECT_EQ(outcome_of(header + "15112000"
                                "00001000"
                                "00000000"
                                "00000002"
                                "0000000001000000"
                                "000100000100000002000000"),
            (Outcome{MessageStatus::ok, 0, 1}))
      << "a payload that is not standard";
}

TEST(Malformed, SecurityIsRefusedByName) {
  for (const char* const id : {"30", "31", "32", "33", "34"})
    EXPECT_EQ(outcome_of(header + "01010000" + id +
                         "010400"
                         "00000000"
                         "01010000"),
              (Outcome{MessageStatus::secured, 1, 0}));
  EXPECT_EQ(name_of(MessageStatus::secured), "secured");
}

TEST(Malformed, LengthsAndPlaces) {
  EXPECT_EQ(verdict_of("010100"), MessageStatus::truncated) << "half a header";
  EXPECT_EQ(verdict_of("01010400"), MessageStatus::truncated);
  EXPECT_EQ(verdict_of("01010200"
                       "0000"
                       "01010000"),
            MessageStatus::malformed)
      << "the next one is not at a multiple of 4";
  EXPECT_EQ(verdict_of("01010200"
                       "0000"),
            MessageStatus::ok)
      << "the last one may end anywhere";
  EXPECT_EQ(verdict_of("0e010000"
                       "0102030405060708090a0b0c"),
            MessageStatus::ok)
      << "0 is to the end";
  EXPECT_EQ(verdict_of("0e010800"
                       "0102030405060708"),
            MessageStatus::truncated);
}

TEST(Malformed, Samples) {
  const std::string ids =
      "00000000"
      "00000002";
  EXPECT_EQ(verdict_of("15052000"
                       "00001000" +
                       ids +
                       "0000000000000000"
                       "000100000100000002000000"),
            MessageStatus::malformed)
      << "sequence number 0";
  EXPECT_EQ(verdict_of("15052000"
                       "00001000" +
                       ids +
                       "ffffffff00000000"
                       "000100000100000002000000"),
            MessageStatus::malformed)
      << "unknown";
  EXPECT_EQ(verdict_of("150d2000"
                       "00001000" +
                       ids +
                       "0000000001000000"
                       "000100000100000002000000"),
            MessageStatus::malformed)
      << "data and key";
  EXPECT_EQ(verdict_of("15052000"
                       "00000f00" +
                       ids +
                       "0000000001000000"
                       "000100000100000002000000"),
            MessageStatus::malformed)
      << "inline QoS within the ids";
  EXPECT_EQ(verdict_of("15052000"
                       "00003000" +
                       ids +
                       "0000000001000000"
                       "000100000100000002000000"),
            MessageStatus::truncated)
      << "inline QoS behind the end";
  EXPECT_EQ(verdict_of("15051400"
                       "00001000" +
                       ids + "0000000001000000"),
            MessageStatus::malformed)
      << "no encapsulation";
  EXPECT_EQ(verdict_of("15031c00"
                       "00001000" +
                       ids +
                       "0000000001000000"
                       "71000400"
                       "00000001"),
            MessageStatus::malformed)
      << "no sentinel";
  EXPECT_EQ(verdict_of("15032400"
                       "00001000" +
                       ids +
                       "0000000001000000"
                       "71000200"
                       "00000001"
                       "01000000"
                       "00000000"),
            MessageStatus::malformed)
      << "a length of 2";
  EXPECT_EQ(outcome_of(header +
                       "15032000"
                       "00001000" +
                       ids +
                       "0000000001000000"
                       "ff3f0400"
                       "00000001"
                       "01000000"),
            (Outcome{MessageStatus::ok, 1, 0}))
      << "passed over";
  EXPECT_EQ(outcome_of(header +
                       "15032000"
                       "00001000" +
                       ids +
                       "0000000001000000"
                       "ff7f0400"
                       "00000001"
                       "01000000"),
            (Outcome{MessageStatus::ok, 0, 1}))
      << "a parameter that must be understood";
}

TEST(Malformed, Fragments) {
  const auto frag = [](const std::string& first, const std::string& count, const std::string& size,
                       const std::string& sample) {
    return verdict_of(
        "16012800"
        "00001c00"
        "00000000"
        "00000002"
        "0000000001000000" +
        first + count + size + sample + "0001000001000000");
  };
  EXPECT_EQ(frag("01000000", "0100", "0800", "10000000"), MessageStatus::ok);
  EXPECT_EQ(frag("00000000", "0100", "0800", "10000000"), MessageStatus::malformed);
  EXPECT_EQ(frag("01000000", "0000", "0800", "10000000"), MessageStatus::malformed);
  EXPECT_EQ(frag("01000000", "0100", "0000", "10000000"), MessageStatus::malformed);
  EXPECT_EQ(frag("03000000", "0100", "0800", "10000000"), MessageStatus::malformed) << "the third of two";
  EXPECT_EQ(frag("ffffffff", "ffff", "0800", "10000000"), MessageStatus::malformed);
  EXPECT_EQ(frag("01000000", "0200", "0800", "10000000"), MessageStatus::truncated) << "two fragments, octets of one";
}

TEST(Malformed, NumbersOfHistories) {
  const std::string ids =
      "00000000"
      "00000002";
  EXPECT_EQ(verdict_of("07011c00" + ids +
                       "0000000000000000"
                       "0000000000000000"
                       "01000000"),
            MessageStatus::malformed)
      << "first 0";
  EXPECT_EQ(verdict_of("07011c00" + ids +
                       "0000000005000000"
                       "0000000003000000"
                       "01000000"),
            MessageStatus::malformed)
      << "last before first";
  EXPECT_EQ(verdict_of("07011c00" + ids +
                       "0000000005000000"
                       "0000000004000000"
                       "01000000"),
            MessageStatus::ok)
      << "nothing there";
  EXPECT_EQ(verdict_of("06011800" + ids +
                       "0000000000000000"
                       "00000000"
                       "01000000"),
            MessageStatus::ok)
      << "some begin so";
  EXPECT_EQ(verdict_of("06011c00" + ids +
                       "0000000000000000"
                       "01000000"
                       "00000080"
                       "01000000"),
            MessageStatus::malformed)
      << "asks for number 0";
  EXPECT_EQ(verdict_of("06011800" + ids +
                       "0000000001000000"
                       "01010000"
                       "01000000"),
            MessageStatus::malformed)
      << "257 bits";
  EXPECT_EQ(verdict_of("06011800" + ids +
                       "0000000001000000"
                       "00010000"
                       "01000000"),
            MessageStatus::truncated)
      << "256 bits, no bitmap";
  EXPECT_EQ(verdict_of("06011800" + ids +
                       "ffffff7fffffffff"
                       "00000000"
                       "01000000"),
            MessageStatus::malformed)
      << "2^63 - 1";
  EXPECT_EQ(verdict_of("08011c00" + ids +
                       "0000000005000000"
                       "0000000004000000"
                       "00000000"),
            MessageStatus::malformed)
      << "ends before it begins";
  EXPECT_EQ(verdict_of("12012000" + ids +
                       "0000000001000000"
                       "ffffffff"
                       "01000000"
                       "00000080"
                       "01000000"),
            MessageStatus::malformed);
  EXPECT_EQ(verdict_of("13011800" + ids +
                       "0000000001000000"
                       "00000000"
                       "01000000"),
            MessageStatus::malformed);
}

TEST(Malformed, LocatorsAreBelievedAsFarAsTheyAreThere) {
  EXPECT_EQ(verdict_of("0f010400"
                       "ffffffff"),
            MessageStatus::truncated);
  EXPECT_EQ(verdict_of("0f010400"
                       "00000000"),
            MessageStatus::ok);
  EXPECT_EQ(outcome_of(header + "0d010800"
                                "0100000a"
                                "f31c0000"),
            (Outcome{MessageStatus::ok, 1, 0}));
}

/// Reads all that there is to read.
std::size_t read_all(Octets octets) {
  MessageDecoder decoder(octets);
  std::size_t sum = 0;
  while (decoder.next()) {
    ++sum;
    const auto* const data = std::get_if<Data>(&decoder.submessage());
    if (data == nullptr || data->payload_kind == PayloadKind::none) continue;
    CdrReader reader(data->payload);
    sum +=
        reader.get_sequence<double>().size() + reader.get_string().size() + reader.get_sequence<std::uint16_t>().size();
  }
  return sum;
}

// Two hundred thousand small damages of sound messages, and noise. The generator is a fixed linear congruence.
TEST(Malformed, DamageIsHarmless) {
  std::vector<std::byte> buffer(4096);
  std::vector<std::vector<std::byte>> seeds;
  for (const ByteOrder order : {ByteOrder::little, ByteOrder::big}) {
    for (const Submessage& each : every_submessage()) {
      MessageEncoder encoder(buffer, some_header, order);
      encoder.add(InfoTimestamp{});
      encoder.add(each);
      encoder.add(Pad{});
      seeds.push_back(copy(encoder.message()));
    }
  }
  std::uint64_t state = 1;
  const auto draw = [&] { return (state = state * 6364136223846793005U + 1442695040888963407U) >> 33; };
  std::size_t read = 0;
  for (int i = 0; i < 200'000; ++i) {
    std::vector<std::byte> octets = seeds[draw() % seeds.size()];
    const auto damages = draw() % 4;
    for (std::uint64_t k = 0; k < damages; ++k)
      octets[20 + draw() % (octets.size() - 20)] = static_cast<std::byte>(draw() & 0xFF);
    if (draw() % 4 == 0) octets.resize(draw() % octets.size());
    octets.shrink_to_fit();
    read += read_all(octets);
  }
  EXPECT_GT(read, 300'000u) << "most survive";
}

TEST(Verdicts, AreCounted) {
  MessageStatusCounts counts;
  counts.count(MessageStatus::ok);
  counts.count(MessageStatus::unknown, 3);
  EXPECT_EQ(counts[MessageStatus::unknown], 3u);
  EXPECT_EQ(name_of(MessageStatus::unknown), "unknown");
}

}  // namespace
}  // namespace takt::dds
