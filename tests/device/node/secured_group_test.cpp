// SPDX-License-Identifier: Apache-2.0
// A group whose messages are secured, and a stranger who hears all of them and says what he likes, but has no key: he
// neither halts, starts, suspends nor stalls it. Keys change every 40 ms.
#include <gtest/gtest.h>

#include <algorithm>

#include "support/word_bench.hpp"

namespace takt::node::secured_group_test {
namespace {

using handshake::PublishedState;
using security::SecurityVerdict;
using namespace sim::literals;

/// xorshift64*: the same in every run.
struct Chance {
  std::uint64_t state = 88172645463325252;
  std::uint64_t below(std::uint64_t bound) {
    state ^= state >> 12, state ^= state << 25, state ^= state >> 27;
    return (state * 2685821657736338717) % bound;
  }
};

/// Words as they would be without security: what a stranger makes who knows all of the group but its keys.
std::vector<std::byte> without_signature(const std::vector<std::byte>& sealed) {
  std::vector<std::byte> octets(sealed.begin(), sealed.end() - 32);
  octets.erase(octets.begin() + 15, octets.begin() + 29);
  octets[1] &= ~std::byte{0x10};
  return octets;
}

/// One thing that a stranger does with what he has heard.
std::vector<std::byte> attack(const std::vector<std::vector<std::byte>>& heard, Chance& chance) {
  std::vector<std::byte> octets = heard[chance.below(heard.size())];
  switch (chance.below(6)) {
    case 0:
      return octets;  // replayed
    case 1:
      octets[chance.below(octets.size())] ^= static_cast<std::byte>(1 + chance.below(255));
      return octets;
    case 2:
      octets.resize(chance.below(octets.size()));
      return octets;
    case 3:
      return without_signature(octets);
    case 4:  // a later number in the nonce, or another key
      octets[15 + chance.below(14)] = static_cast<std::byte>(chance.below(256));
      return octets;
    default: {  // one's headers with another's signature
      const std::vector<std::byte>& other = heard[chance.below(heard.size())];
      std::copy(other.end() - 32, other.end(), octets.end() - 32);
      return octets;
    }
  }
}

class SecuredGroups : public ::testing::TestWithParam<const char*> {};

TEST_P(SecuredGroups, ChangeTheirKeysWithoutALostMessage) {
  test::WordBench bench(GetParam());
  bench.run(10_ms);
  ASSERT_EQ(bench.call(0, program::Method::Start), program::StatusCode::Good);
  bench.run(500_ms);  // twelve changes of keys
  EXPECT_TRUE(bench.all_in(PublishedState::Running)) << bench.ask();
  EXPECT_GT(bench.opened(SecurityVerdict::good), 2000u);
  for (const SecurityVerdict verdict :
       {SecurityVerdict::malformed, SecurityVerdict::unsecured, SecurityVerdict::mode, SecurityVerdict::header,
        SecurityVerdict::token, SecurityVerdict::truncated, SecurityVerdict::signature, SecurityVerdict::replayed})
    EXPECT_EQ(bench.opened(verdict), 0u) << static_cast<int>(verdict);
  for (std::size_t node = 0; node < bench.size(); ++node) EXPECT_EQ(bench.member(node).endpoint()->counts().stale, 0u);
}

// Every state of the group, before, during and behind each command: the group goes where its commands lead, as if
// nobody else were there.
TEST_P(SecuredGroups, AreNotMovedByAStranger) {
  Chance chance;
  test::WordBench bench(GetParam());
  std::vector<std::vector<std::byte>> heard;
  bench.record(heard);
  const auto flood_for = [&](int milliseconds, PublishedState state) {
    for (int i = 0; i < milliseconds; ++i) {
      for (int n = 0; n < 20 && !heard.empty(); ++n) bench.say(attack(heard, chance));
      bench.run(1_ms);
      if (i >= 30) {
        ASSERT_TRUE(bench.all_in(state)) << bench.ask();
      }
    }
    ASSERT_TRUE(bench.all_in(state)) << bench.ask();
  };
  bench.run(5_ms);
  for (int round = 0; round < 3; ++round) {
    flood_for(45, PublishedState::Halted);
    ASSERT_EQ(bench.call(0, program::Method::Start), program::StatusCode::Good);
    flood_for(90, PublishedState::Running);
    ASSERT_EQ(bench.call(1, program::Method::Suspend), program::StatusCode::Good);
    flood_for(45, PublishedState::Suspended);
    ASSERT_EQ(bench.call(0, program::Method::Resume), program::StatusCode::Good);
    flood_for(45, PublishedState::Running);
    ASSERT_EQ(bench.call(2, program::Method::Halt), program::StatusCode::Good);
    flood_for(45, PublishedState::Halted);
  }
  for (const SecurityVerdict verdict :
       {SecurityVerdict::unsecured, SecurityVerdict::mode, SecurityVerdict::header, SecurityVerdict::token,
        SecurityVerdict::truncated, SecurityVerdict::signature, SecurityVerdict::replayed})
    EXPECT_GT(bench.opened(verdict), 0u) << "the stranger has tried " << static_cast<int>(verdict);
  for (std::size_t node = 0; node < bench.size(); ++node) {
    const wire::EndpointCounts& counts = bench.member(node).endpoint()->counts();
    EXPECT_EQ(counts.foreign + counts.stale, 0u) << "what is not signed does not come so far";
  }
}

// A node that was killed is heard at once in its next life under the same key, and takes nothing of what was said
// before.
TEST_P(SecuredGroups, StartAgainAfterOneWasRestarted) {
  for (const std::size_t node : {0, 1}) {
    test::WordBench bench(GetParam());
    std::vector<std::vector<std::byte>> heard;
    bench.record(heard);
    bench.run(10_ms);
    ASSERT_EQ(bench.call(0, program::Method::Start), program::StatusCode::Good);
    bench.run(15_ms);
    ASSERT_TRUE(bench.all_in(PublishedState::Running)) << bench.ask();
    bench.restart(node, 2);
    const std::vector<std::vector<std::byte>> before = heard;
    const auto taken = [&bench] {
      std::uint64_t sum = 0;
      for (std::size_t each = 0; each < bench.size(); ++each) sum += bench.member(each).endpoint()->counts().taken;
      return sum;
    };
    const std::uint64_t taken_before = taken();
    const auto good = bench.opened(SecurityVerdict::good);
    for (const auto& octets : before) bench.say(octets);
    EXPECT_LE(taken(), taken_before + 6) << "but for those that were still under way";
    // A node has no window for what it said itself, and hears nobody by that name; and five messages of this instant's
    // cycle are still under way to two nodes each.
    EXPECT_LE(bench.opened(SecurityVerdict::good), good + before.size() + 10);
    bench.run(20_ms);
    EXPECT_TRUE(bench.all_in(PublishedState::Halted)) << bench.ask();
    EXPECT_EQ(bench.call(0, program::Method::Start), program::StatusCode::Good);
    bench.run(15_ms);
    EXPECT_TRUE(bench.all_in(PublishedState::Running)) << bench.ask();
  }
}

INSTANTIATE_TEST_SUITE_P(Modes, SecuredGroups, ::testing::Values("secured", "signed"),
                         [](const auto& mode) { return std::string(mode.param); });

// What security is for: the same stranger halts a group without it.
TEST(UnsecuredGroups, AreHaltedByOneReplay) {
  test::WordBench bench("two");
  std::vector<std::vector<std::byte>> heard;
  bench.record(heard);
  bench.run(10_ms);
  bench.call(0, program::Method::Start);
  bench.run(20_ms);
  bench.call(0, program::Method::Halt);
  bench.run(20_ms);
  bench.call(0, program::Method::Start);
  bench.run(20_ms);
  ASSERT_TRUE(bench.all_in(PublishedState::Running));
  // Any word of the slave's first start, with a sequence number of now.
  bench.say(bench.state_of(1, 1, "0b000000e90300000000000009000000000000000501"));
  bench.run(10_ms);
  EXPECT_TRUE(bench.all_in(PublishedState::Halted)) << bench.ask();
}

}  // namespace
}  // namespace takt::node::secured_group_test
