// Messages of Programs: round trips, the exact layout, and whatever else arrives.
#include "wire/program_message.hpp"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <vector>

namespace takt::wire {
namespace {

using Buffer = std::array<std::byte, 1500>;

StateMessage sample() {
  StateMessage message;
  message.sender = 3;
  message.sequence = 0xBEEF;
  message.word.incarnation = 0x01020304;
  message.word.state = handshake::PublishedState::Suspended;
  message.word.intent.number = 0x11223344;
  message.word.intent.kind = handshake::IntentKind::Suspend;
  message.word.intent.origin = 5;
  message.word.intent.run = 0x55667788;
  message.word.run = 0x99AABBCC;
  return message;
}

TEST(ProgramMessage, EveryStateAndIntentMakesTheRoundTrip) {
  Buffer buffer;
  for (std::size_t state = 0; state < handshake::published_state_count; ++state) {
    for (std::size_t kind = 0; kind < handshake::intent_kind_count; ++kind) {
      for (const std::uint32_t number : {std::uint32_t{0}, std::uint32_t{1}, std::numeric_limits<std::uint32_t>::max()}) {
        StateMessage message = sample();
        message.word.state = handshake::published_state_at(state);
        message.word.intent.kind = static_cast<handshake::IntentKind>(kind);
        message.word.intent.number = message.word.intent.run = message.word.run = message.word.incarnation = number;
        const auto octets = encode(message, buffer);
        ASSERT_EQ(octets.size(), state_message_length);
        const auto decoded = decode(octets);
        ASSERT_TRUE(decoded);
        EXPECT_EQ(std::get<StateMessage>(*decoded), message);
      }
    }
  }
}

TEST(ProgramMessage, ProcessDataMakesTheRoundTrip) {
  Buffer buffer;
  for (const std::size_t fields : {std::size_t{0}, std::size_t{1}, std::size_t{1462}}) {
    const ProcessDataMessage message{64, 255, 65535, 0xFEDCBA98};
    const auto octets = encode(message, fields, buffer);
    ASSERT_EQ(octets.size(), process_data_header_length + fields);
    const auto decoded = decode(octets);
    ASSERT_TRUE(decoded);
    EXPECT_EQ(std::get<ProcessDataMessage>(*decoded), message);
  }
}

// version, kind, sender, 0, sequence, incarnation, state, intent kind, origin, 0, number, intent's run, run, 0 0
TEST(ProgramMessage, LayoutOfAState) {
  Buffer buffer;
  const auto octets = encode(sample(), buffer);
  const std::array<unsigned, state_message_length> expected = {1,    1,    3,    0,    0xEF, 0xBE, 4,    3,    2,    1,    14,   static_cast<unsigned>(handshake::IntentKind::Suspend),
                                                               5,    0,    0x44, 0x33, 0x22, 0x11, 0x88, 0x77, 0x66, 0x55, 0xCC, 0xBB, 0xAA, 0x99, 0,    0};
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(std::to_integer<unsigned>(octets[i]), expected[i]) << "octet " << i;
}

TEST(ProgramMessage, TooSmallATargetGetsNothing) {
  Buffer buffer;
  for (std::size_t size = 0; size < state_message_length; ++size) EXPECT_TRUE(encode(sample(), std::span(buffer).first(size)).empty());
  for (std::size_t size = 0; size < process_data_header_length + 7; ++size)
    EXPECT_TRUE(encode(ProcessDataMessage{}, 7, std::span(buffer).first(size)).empty());
}

TEST(ProgramMessage, TruncatedOnesAreNone) {
  Buffer buffer;
  const auto state = encode(sample(), buffer);
  for (std::size_t length = 0; length < state.size(); ++length) EXPECT_FALSE(decode(state.first(length))) << length;
  const auto data = encode(ProcessDataMessage{}, 4, buffer);
  for (std::size_t length = 0; length < process_data_header_length; ++length) EXPECT_FALSE(decode(data.first(length))) << length;
}

TEST(ProgramMessage, ForeignValuesAreNone) {
  Buffer buffer;
  const auto with = [&](std::size_t position, unsigned value) {
    const auto octets = encode(sample(), buffer);
    buffer[position] = static_cast<std::byte>(value);
    return decode(octets);
  };
  for (const unsigned version : {0u, 2u, 255u}) EXPECT_FALSE(with(0, version));
  for (const unsigned kind : {0u, 3u, 255u}) EXPECT_FALSE(with(1, kind));
  for (unsigned state = 0; state < 256; ++state) EXPECT_EQ(with(10, state).has_value(), state >= 11 && state <= 15) << state;
  for (unsigned intent = 0; intent < 256; ++intent) EXPECT_EQ(with(11, intent).has_value(), intent < handshake::intent_kind_count) << intent;
}

// Whatever is decoded is valid, whatever arrives.
TEST(ProgramMessage, GarbageIsBounded) {
  std::uint64_t chance = 1;
  std::size_t taken = 0;
  for (int round = 0; round < 200'000; ++round) {
    std::array<std::byte, 40> octets;
    for (std::byte& one : octets) {
      chance = chance * 6364136223846793005ULL + 1442695040888963407ULL;
      one = static_cast<std::byte>(chance >> 59);  // small values are likelier to be valid
    }
    const auto message = decode(std::span(octets).first(static_cast<std::size_t>(round) % octets.size()));
    if (!message) continue;
    ++taken;
    const auto* const state = std::get_if<StateMessage>(&*message);
    EXPECT_TRUE(state == nullptr || handshake::is_valid(state->word));
  }
  EXPECT_GT(taken, 0u);
}

}  // namespace
}  // namespace takt::wire
