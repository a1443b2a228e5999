// SPDX-License-Identifier: Apache-2.0
// Messages of Programs: the exact octets, round trips, the general decoder as a second opinion, and whatever else
// arrives.
#include "wire/program_format.hpp"

#include <gtest/gtest.h>

#include <array>
#include <limits>

#include "support.hpp"
#include "uadp/data_set_message.hpp"
#include "uadp/network_message.hpp"

namespace takt::wire {
namespace {

using test::shape;
using Buffer = std::array<std::byte, 1500>;

StateMessage sample() {
  StateMessage message;
  message.sender = 2;
  message.sequence = 0xBEEF;
  message.word.incarnation = 0x01020304;
  message.word.state = handshake::PublishedState::Suspended;
  message.word.intent.number = 0x11223344;
  message.word.intent.kind = handshake::IntentKind::Suspend;
  message.word.intent.origin = 1;
  message.word.intent.run = 0x55667788;
  message.word.run = 0x99AABBCC;
  return message;
}

/// The same as a participant of three can say it: whoever is Suspended is in the run of the suspend.
StateMessage sound() {
  StateMessage message = sample();
  message.word.run = message.word.intent.run;
  return message;
}

std::vector<unsigned> numbers(uadp::Octets octets) {
  std::vector<unsigned> all;
  for (const std::byte octet : octets) all.push_back(std::to_integer<unsigned>(octet));
  return all;
}

/// The 20 octets before the fields.
std::vector<unsigned> head(std::uint32_t version, unsigned publisher, unsigned group, unsigned sequence) {
  const auto low = [](unsigned value, unsigned octet) { return value >> (8 * octet) & 0xFF; };
  return {0xB1,
          0x01,
          low(publisher, 0),
          low(publisher, 1),
          0x0F,
          low(group, 0),
          low(group, 1),
          low(version, 0),
          low(version, 1),
          low(version, 2),
          low(version, 3),
          1,
          0,
          low(sequence, 0),
          low(sequence, 1),
          0x1B,
          low(sequence, 0),
          low(sequence, 1),
          0,
          0};
}

TEST(ProgramFormat, OctetsOfARobustState) {
  const ProgramFormat format(shape());
  Buffer buffer;
  std::vector<unsigned> expected = head(format.group_version(), 0x0102, 1, 0xBEEF);
  const std::vector<unsigned> fields = {14,   0,    0,    0,    4,    3,    2,    1,    0xCC, 0xBB, 0xAA,
                                        0x99, 0x44, 0x33, 0x22, 0x11, 0x88, 0x77, 0x66, 0x55, 2,    1};
  expected.insert(expected.end(), fields.begin(), fields.end());
  EXPECT_EQ(numbers(format.encode(sample(), buffer)), expected);
  EXPECT_EQ(expected.size(), 42u);
  EXPECT_EQ(state_octets(handshake::Variant::robust), 42u);
}

// A state is known again by its octets: exactly if nothing but its two sequence numbers differs.
TEST(ProgramFormat, KnowsAStateAgain) {
  const ProgramFormat format(shape());
  Buffer buffer;
  const uadp::Octets first = format.encode(sound(), buffer);
  KnownState known;
  EXPECT_FALSE(known.is_repeated_by(first));
  known.note(first, sound().word);
  EXPECT_TRUE(known.is_repeated_by(first));
  for (std::size_t at = 0; at < first.size(); ++at) {
    Buffer changed = buffer;
    changed[at] ^= std::byte{1};
    const bool is_sequence = at == 13 || at == 14 || at == 16 || at == 17;
    EXPECT_EQ(known.is_repeated_by(uadp::Octets(changed).first(first.size())), is_sequence) << at;
  }
  EXPECT_FALSE(known.is_repeated_by(first.first(first.size() - 1)));
  StateMessage next = sound();
  next.sequence = 7;
  Buffer other;
  const uadp::Octets second = format.encode(next, other);
  ASSERT_TRUE(known.is_repeated_by(second));
  EXPECT_EQ(known.message(2, second), next);
  EXPECT_EQ(format.sender_of(second), 2u);
}

// `paper` says so little that it is read anew each time.
TEST(ProgramFormat, KnowsNoStateOfPaperAgain) {
  const ProgramFormat format(shape(handshake::Variant::paper));
  Buffer buffer;
  const uadp::Octets octets = format.encode(sound(), buffer);
  KnownState known;
  known.note(octets, sound().word);
  EXPECT_FALSE(known.is_repeated_by(octets));
}

TEST(ProgramFormat, OctetsOfAStateOfPaper) {
  const ProgramFormat format(shape(handshake::Variant::paper));
  Buffer buffer;
  std::vector<unsigned> expected = head(format.group_version(), 0x0102, 1, 0xBEEF);
  expected.insert(expected.end(), {14, 0, 0, 0});
  EXPECT_EQ(numbers(format.encode(sample(), buffer)), expected);
  EXPECT_EQ(expected.size(), state_octets(handshake::Variant::paper));
}

TEST(ProgramFormat, OctetsOfProcessData) {
  const ProgramFormat format(shape());
  Buffer buffer;
  std::vector<unsigned> expected = head(format.group_version(), 0x0101, 3, 0x0102);
  expected.insert(expected.end(), {0x98, 0xBA, 0xDC, 0xFE, 5, 6, 7});
  const std::array<std::byte, 3> fields{std::byte{5}, std::byte{6}, std::byte{7}};
  EXPECT_EQ(numbers(format.encode(ProcessDataMessage{1, 1, 0x0102, 0xFEDCBA98, fields}, buffer)), expected);
  EXPECT_EQ(expected.size(), process_data_octets(3));
  EXPECT_EQ(format.encode(ProcessDataMessage{0, 0, 1, 1, {}}, buffer).size(), process_data_octets(10));
}

// The hot path writes what the general codec reads.
TEST(ProgramFormat, TheGeneralDecoderAgrees) {
  const ProgramFormat format(shape());
  Buffer buffer;
  uadp::NetworkMessage message;
  ASSERT_EQ(uadp::decode(format.encode(sound(), buffer), message), uadp::DecodeStatus::ok);
  EXPECT_EQ(message.header.publisher_id, uadp::PublisherId::uint16(0x0102));
  EXPECT_EQ(message.header.group,
            (uadp::GroupHeader{std::uint16_t{1}, format.group_version(), std::uint16_t{1}, std::uint16_t{0xBEEF}}));
  EXPECT_EQ(message.payload_offset, 15u);
  uadp::DataSetMessage data_set;
  ASSERT_EQ(uadp::decode(message.payload, data_set), uadp::DecodeStatus::ok);
  EXPECT_EQ(data_set.header.encoding, uadp::FieldEncoding::RawData);
  EXPECT_EQ(data_set.header.sequence_number, std::uint16_t{0xBEEF});
  EXPECT_EQ(message.payload_offset + data_set.body_offset, fields_at);
}

TEST(ProgramFormat, EveryStateAndIntentMakesTheRoundTrip) {
  const ProgramFormat format(shape());
  Buffer buffer;
  int taken = 0;
  for (std::size_t state = 0; state < handshake::published_state_count; ++state) {
    for (std::size_t kind = 0; kind < handshake::intent_kind_count; ++kind) {
      for (const std::uint32_t number :
           {std::uint32_t{0}, std::uint32_t{1}, std::numeric_limits<std::uint32_t>::max()}) {
        StateMessage message = sound();
        message.word.state = handshake::published_state_at(state);
        message.word.intent.kind = static_cast<handshake::IntentKind>(kind);
        message.word.intent.number = message.word.incarnation = number;
        message.word.intent.origin = 0;
        message.word.intent.run = message.word.run = handshake::run_of(number, number);
        if (message.word.state == handshake::PublishedState::Halted ||
            message.word.state == handshake::PublishedState::HaltedInit)
          message.word.run = 0;
        if (message.word.intent.kind == handshake::IntentKind::Halt) message.word.intent.run = 0;
        const auto decoded = format.decode(format.encode(message, buffer));
        ASSERT_EQ(decoded.has_value(), handshake::is_valid(message.word, handshake::Variant::robust, 2));
        if (!decoded) continue;
        ++taken;
        EXPECT_EQ(std::get<StateMessage>(*decoded), message);
      }
    }
  }
  EXPECT_EQ(taken, 2 * 8 + 1) << "three states of a start, one of each other kind; without a number Halted only";
}

TEST(ProgramFormat, PaperKeepsTheStateAlone) {
  const ProgramFormat format(shape(handshake::Variant::paper));
  Buffer buffer;
  const auto decoded = format.decode(format.encode(sound(), buffer));
  ASSERT_TRUE(decoded);
  EXPECT_EQ(std::get<StateMessage>(*decoded).word, (handshake::Word{0, handshake::PublishedState::Suspended, {}, 0}));
}

TEST(ProgramFormat, PaddingIsPassedOver) {
  const ProgramFormat format(shape());
  Buffer buffer;
  const std::array<std::byte, 3> fields{std::byte{5}, std::byte{6}, std::byte{7}};
  const std::size_t size = format.encode(ProcessDataMessage{1, 1, 9, 8, fields}, buffer).size();
  const auto decoded = format.decode(std::span(buffer).first(size + 19));
  ASSERT_TRUE(decoded);
  EXPECT_EQ(std::get<ProcessDataMessage>(*decoded).run, 8u);
  EXPECT_EQ(numbers(std::get<ProcessDataMessage>(*decoded).fields), (std::vector<unsigned>{5, 6, 7}));
}

TEST(ProgramFormat, TruncatedOnesAreNone) {
  const ProgramFormat format(shape());
  Buffer buffer;
  const auto state = format.encode(sound(), buffer);
  for (std::size_t length = 0; length < state.size(); ++length)
    EXPECT_FALSE(format.decode(state.first(length))) << length;
  const auto data = format.encode(ProcessDataMessage{0, 0, 1, 1, {}}, buffer);
  for (std::size_t length = 0; length < data.size(); ++length)
    EXPECT_FALSE(format.decode(data.first(length))) << length;
}

// Every constant octet counts, and every field is one of the group's; sequence numbers may be anything.
TEST(ProgramFormat, ForeignValuesAreNone) {
  const ProgramFormat format(shape());
  Buffer buffer;
  const auto taken = [&](std::size_t position, unsigned value) {
    const auto octets = format.encode(sound(), buffer);
    buffer[position] = static_cast<std::byte>(value);
    return format.decode(octets).has_value();
  };
  for (std::size_t position = 0; position < 16; ++position) {
    const bool is_sequence = position == 13 || position == 14;
    const bool is_other_sender = position == 2;  // 0 and 1 are participants too
    EXPECT_EQ(taken(position, 0x55), is_sequence) << position;
    const bool is_zero = position == 6 || position == 12;  // already
    EXPECT_EQ(taken(position, 0x00), is_sequence || is_other_sender || is_zero) << position;
  }
  const unsigned suspended = 14;
  const auto suspend = static_cast<unsigned>(handshake::IntentKind::Suspend);
  for (unsigned value = 0; value < 256; ++value) {
    EXPECT_EQ(taken(20, value), value == suspended) << value;
    EXPECT_TRUE(taken(24, value)) << "any incarnation";
    EXPECT_EQ(taken(28, value), value == 0x88) << "a run that is not that of the suspend";
    EXPECT_TRUE(taken(32, value)) << "any number";
    EXPECT_EQ(taken(36, value), value == 0x88) << "as above";
    EXPECT_EQ(taken(40, value), value == suspend) << value;
    EXPECT_EQ(taken(41, value), value <= 2) << "origin " << value << " of a group of 0 to 2";
  }
}

// A message whose status is Bad has no values (all its fields are RawData); Uncertain ones count.
TEST(ProgramFormat, BadMessagesAreNone) {
  const ProgramFormat format(shape());
  Buffer buffer;
  for (const unsigned status : {0x00U, 0x40U, 0x80U, 0xC0U}) {
    const auto state = format.encode(sound(), buffer);
    buffer[19] = static_cast<std::byte>(status);
    EXPECT_EQ(format.decode(state).has_value(), status < 0x80U);
    const auto data = format.encode(ProcessDataMessage{0, 0, 1, 1, {}}, buffer);
    buffer[19] = static_cast<std::byte>(status);
    EXPECT_EQ(format.decode(data).has_value(), status < 0x80U);
  }
}

// A packet that has killed nodes: origin 3 of a group of 0 to 1 (the version of the group and the PublisherId are those
// of the test's).
TEST(ProgramFormat, AnOriginOutsideTheGroupIsNone) {
  ProgramShape two;
  two.name = "cell";
  two.variant = handshake::Variant::robust;
  two.participants = {"plc", "left"};
  two.first_publisher_id = 0x0102 - 1;
  const ProgramFormat format(two);
  std::vector<unsigned> octets = head(format.group_version(), 0x0102, 1, 121);
  const std::vector<unsigned> fields = {0x0B, 0, 0, 0, 0x63, 0x84, 0x96, 0xBA, 0, 0, 0,
                                        0,    2, 0, 0, 0,    0,    0,    0,    0, 5, 3};
  octets.insert(octets.end(), fields.begin(), fields.end());
  std::vector<std::byte> message;
  for (const unsigned octet : octets) message.push_back(static_cast<std::byte>(octet));
  EXPECT_FALSE(format.decode(message));
  message.back() = std::byte{1};
  EXPECT_TRUE(format.decode(message));
}

// A data set has one sender.
TEST(ProgramFormat, DataOfAnotherSenderIsNone) {
  const ProgramFormat format(shape());
  Buffer buffer;
  const auto octets = format.encode(ProcessDataMessage{1, 1, 1, 1, {}}, buffer);
  EXPECT_TRUE(format.decode(octets));
  buffer[2] = std::byte{2};
  EXPECT_FALSE(format.decode(octets));
}

TEST(ProgramFormat, AnotherGroupVersionIsNone) {
  ProgramShape other = shape();
  other.data_sets[0].fields[0].name = "other";
  Buffer buffer;
  EXPECT_FALSE(ProgramFormat(shape()).decode(ProgramFormat(other).encode(sound(), buffer)));
}

// Whatever is decoded is valid, whatever arrives.
TEST(ProgramFormat, GarbageIsBounded) {
  const ProgramFormat format(shape());
  std::uint64_t chance = 1;
  std::size_t taken = 0;
  Buffer buffer;
  for (int round = 0; round < 200'000; ++round) {
    const auto octets = format.encode(sound(), buffer);
    for (int change = 0; change < 2; ++change) {
      chance = chance * 6364136223846793005ULL + 1442695040888963407ULL;
      buffer[chance >> 32 & 63] = static_cast<std::byte>(chance >> 59);  // small values are likelier to be valid
    }
    const auto message = format.decode(octets);
    if (!message) continue;
    ++taken;
    const auto* const state = std::get_if<StateMessage>(&*message);
    EXPECT_TRUE(state == nullptr || handshake::is_valid(state->word, handshake::Variant::robust, 2));
  }
  EXPECT_GT(taken, 0u);
}

}  // namespace
}  // namespace takt::wire
