// SPDX-License-Identifier: Apache-2.0
// One packet of a stranger: nodes survive it, can be asked what they think of it, and the group can be started
// afterwards.
#include <gtest/gtest.h>

#include <functional>

#include "support/word_bench.hpp"

namespace takt::node::forged_words_test {
namespace {

using handshake::PublishedState;
using namespace sim::literals;

/// The fields of a Halted word, from the state to the origin.
std::string halted(const std::string& incarnation, const std::string& number, const std::string& kind_and_origin) {
  return "0b000000" + incarnation + "00000000" + number + "00000000" + kind_and_origin;
}

/// However little is known of the other end: a Start succeeds as soon as everybody has been heard again.
void expect_that_it_starts(test::WordBench& bench) {
  bench.run(30_ms);
  if (!bench.all_in(PublishedState::Running)) {
    EXPECT_TRUE(bench.all_in(PublishedState::Halted)) << bench.ask();
    EXPECT_EQ(bench.call(0, program::Method::Start), program::StatusCode::Good) << bench.ask();
    bench.run(40_ms);
  }
  EXPECT_TRUE(bench.all_in(PublishedState::Running)) << bench.ask();
}

// b10102000f010052c7ac22010079001b790000000b000000638496ba0000000002000000000000000503: origin 3 of a group of 0 to 1,
// seen to kill both nodes as soon as they were asked for their status. Version, sequence numbers and incarnation are
// those of the test's group.
TEST(ForgedWords, AnOriginOutsideTheGroup) {
  for (const bool is_running : {false, true}) {
    test::WordBench bench("two");
    bench.run(10_ms);
    if (is_running) bench.call(0, program::Method::Start);
    bench.run(20_ms);
    const auto foreign = bench.member(0).endpoint()->counts().foreign;
    bench.say(bench.state_of(1, 1, halted("e9030000", "02000000", "0503")));
    EXPECT_EQ(bench.member(0).endpoint()->counts().foreign, foreign + 1);
    EXPECT_EQ(bench.all_in(PublishedState::Running), is_running) << "nothing of it is believed";
    bench.run(5_ms);
    EXPECT_NE(bench.ask().find("plc"), std::string::npos);
    expect_that_it_starts(bench);
  }
}

// b10102000f010052c7ac2201007d001b7d0000000b0000007d8496ba00000000ffffffff000000000501: a halt that no later intent
// could follow.
TEST(ForgedWords, AHaltWithTheLastNumber) {
  for (const std::string number :
       {"ffffffff", "feffffff", "ffffff3f", "00000040", "ffffff7f", "00000080", "010000c0"}) {
    for (const bool is_running : {false, true}) {
      for (const std::size_t as : {0, 1}) {
        SCOPED_TRACE(number + (is_running ? " in a run, as " : " when switched on, as ") + std::to_string(as));
        test::WordBench bench("two");
        bench.run(10_ms);
        if (is_running) bench.call(0, program::Method::Start);
        bench.run(20_ms);
        bench.say(bench.state_of(as, 1, halted(as == 0 ? "e8030000" : "e9030000", number, "0501")));
        bench.ask();
        expect_that_it_starts(bench);
      }
    }
  }
}

// A sequence number far ahead makes the true words look old, an incarnation that of a restarted node: for one time-out
// at most.
TEST(ForgedWords, ANumberOfAMessageFarAhead) {
  for (const std::string kind : {"robust", "all-to-all", "nested"}) {
    for (const std::string incarnation : {"e8030000", "e9030000", "78563412"}) {
      for (const int ahead : {1000, 16000, 20000, 40000}) {
        for (const std::size_t as : {0, 1}) {
          SCOPED_TRACE(kind + " " + incarnation + " " + std::to_string(ahead));
          test::WordBench bench(kind);
          bench.run(10_ms);
          bench.call(0, program::Method::Start);
          bench.run(30_ms);
          ASSERT_TRUE(bench.all_in(PublishedState::Running)) << bench.ask();
          bench.say(bench.state_of(as, static_cast<std::uint16_t>(ahead), halted(incarnation, "07000000", "0501")));
          expect_that_it_starts(bench);
        }
      }
    }
  }
}

// A life far ahead makes the true announcements look late.
TEST(ForgedWords, ALifeFarAhead) {
  for (const std::string life : {"00008000", "ffff7f00", "f0ffff00", "00000001", "00000000"}) {
    test::WordBench bench("roles");
    bench.run(30_ms);
    bench.call(0, program::Method::Start);
    bench.run(30_ms);
    ASSERT_TRUE(bench.all_in(PublishedState::Running)) << bench.ask();
    for (std::vector<std::byte> message : bench.heard()) {
      if (uadp::load_little_endian<std::uint16_t>(message.data() + 5) != wire::announcement_writer_group) continue;
      message = test::WordBench::forged(std::move(message), 1);
      for (std::size_t i = 0; i < 4; ++i)
        message.at(wire::fields_at + i) = static_cast<std::byte>(std::stoi(life.substr(2 * i, 2), nullptr, 16));
      bench.say(message);
    }
    bench.ask();
    bench.run(100_ms);
    expect_that_it_starts(bench);
  }
}

/// What a stranger makes of the announcements that it has heard.
using Forgery = std::function<void(std::vector<std::byte>& announcement, std::uint32_t turn)>;

// While they come, nothing can be promised. Once they have ended, roles are bound to nodes that are there and the group
// goes on, as `on_replacement: restart` says.
TEST(ForgedWords, AFloodOfAnnouncements) {
  const auto set_life = [](std::vector<std::byte>& octets, std::uint32_t life) {
    uadp::store_little_endian(octets.data() + wire::fields_at, life % 0xFFFFFFU + 1);
  };
  const auto life_of = [](const std::vector<std::byte>& octets) {
    return uadp::load_little_endian<std::uint32_t>(octets.data() + wire::fields_at);
  };
  const std::vector<std::pair<std::string, Forgery>> floods = {
      {"the next life", [&](auto& octets, std::uint32_t turn) { set_life(octets, life_of(octets) + turn); }},
      {"lives far apart",
       [&](auto& octets, std::uint32_t turn) { set_life(octets, life_of(octets) + turn * 0x654321U); }},
      {"half of all lives away", [&](auto& octets, std::uint32_t) { set_life(octets, life_of(octets) + 0x7FFFFFU); }},
      {"its own life, leaving", [](auto& octets, std::uint32_t) { octets[wire::fields_at + 4] = std::byte{1}; }},
      {"its own life, without skills",
       [](auto& octets, std::uint32_t) {
         std::fill(octets.begin() + wire::fields_at + 5, octets.end(), std::byte{0});
       }},
      {"the last life", [&](auto& octets, std::uint32_t) { set_life(octets, 0xFFFFFEU); }},
      {"the former life", [&](auto& octets, std::uint32_t) { set_life(octets, life_of(octets) - 2); }},
  };
  for (const auto& [name, forge] : floods) {
    for (const std::int64_t every_us : {130, 1000, 4000, 9000}) {
      SCOPED_TRACE(name + " every " + std::to_string(every_us) + " us");
      test::WordBench bench("roles-restart");
      bench.run(60_ms);
      ASSERT_EQ(bench.call(0, program::Method::Start), program::StatusCode::Good) << bench.ask();
      bench.run(60_ms);
      ASSERT_TRUE(bench.all_in(PublishedState::Running)) << bench.ask();
      for (std::uint32_t turn = 1; turn <= 400; ++turn) {
        for (std::vector<std::byte> message : bench.heard()) {
          if (uadp::load_little_endian<std::uint16_t>(message.data() + 5) != wire::announcement_writer_group) continue;
          message = test::WordBench::forged(std::move(message), static_cast<std::uint16_t>(turn));
          forge(message, turn);
          bench.say(message);
        }
        bench.run(every_us * sim::Duration::from_ps(1'000'000));
      }
      bench.run(300_ms);
      EXPECT_TRUE(bench.member(0).binder()->complete()) << bench.ask();
      EXPECT_TRUE(bench.all_in(PublishedState::Running)) << bench.ask();
      EXPECT_EQ(bench.member(0).state(), PublishedState::Running);
    }
  }
}

}  // namespace
}  // namespace takt::node::forged_words_test
