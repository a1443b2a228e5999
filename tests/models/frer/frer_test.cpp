// SPDX-License-Identifier: Apache-2.0
// The worked example of the reference, each rule by itself, and against a history that is a plain list of bits.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <array>
#include <deque>
#include <map>
#include <vector>

#include "models/frer/latent_error_detection.hpp"
#include "models/frer/r_tag.hpp"
#include "models/frer/sequence_generation.hpp"
#include "models/frer/sequence_recovery.hpp"

namespace takt::models {
namespace {

using Decision = SequenceRecovery::Decision;
using Counters = SequenceRecoveryCounters;
using Numbers = std::vector<SequenceNumber>;
constexpr Decision passed{true, true};
constexpr Decision discarded{false, false};
constexpr Decision discarded_but_alive{false, true};

SequenceRecoveryConfig vector_of(std::uint32_t history_length) {
  SequenceRecoveryConfig config;
  config.history_length = history_length;
  return config;
}

TEST(RTag, IsSixOctets) {
  const auto octets = encode_r_tag(0x1234);
  const std::array<std::byte, 6> expected = {std::byte{0xF1}, std::byte{0xC1}, std::byte{0},
                                             std::byte{0},    std::byte{0x12}, std::byte{0x34}};
  EXPECT_EQ(octets, expected);
  EXPECT_EQ(decode_r_tag(octets), 0x1234);
  EXPECT_EQ(decode_r_tag(std::span(octets).first(5)), std::nullopt);
  auto other = octets;
  other[2] = std::byte{0xFF};  // reserved: ignored
  EXPECT_EQ(decode_r_tag(other), 0x1234);
  other[0] = std::byte{0xF2};
  EXPECT_EQ(decode_r_tag(other), std::nullopt);
}

TEST(SequenceGeneration, CountsFromZeroAndWraps) {
  SequenceGeneration generation;
  for (std::uint32_t n = 0; n < 65'536; ++n) ASSERT_EQ(generation.next(), n);
  EXPECT_EQ(generation.next(), 0);
  EXPECT_EQ(generation.next(), 1);
  EXPECT_EQ(generation.resets(), 0u);
  generation.reset();
  EXPECT_EQ(generation.next(), 0);
  EXPECT_EQ(generation.resets(), 1u);
}

// H = 4: 10 pass, 10 discard, 12 pass out of order, 11 pass out of order, 11 discard, 17 rogue. The two shifts for 12
// push out zeros of the empty history.
TEST(VectorRecovery, WorkedExample) {
  SequenceRecovery recovery(vector_of(4));
  EXPECT_EQ(recovery.recover(10), passed);
  EXPECT_EQ(recovery.recover(10), discarded);
  EXPECT_EQ(recovery.recover(12), passed);
  EXPECT_EQ(recovery.recover(11), passed);
  EXPECT_EQ(recovery.recover(11), discarded);
  EXPECT_EQ(recovery.recover(17), discarded);
  Counters expected;
  expected.out_of_order_packets = 2;
  expected.rogue_packets = 1;
  expected.passed_packets = 3;
  expected.discarded_packets = 3;
  expected.lost_packets = 2;
  expected.lost_at_start = 2;
  expected.resets = 1;
  EXPECT_EQ(recovery.counters(), expected);
  // All else is rogue until 13, 14 or 15 come, or the timer.
  EXPECT_EQ(recovery.recover(18), discarded);
  EXPECT_EQ(recovery.recover(15), passed);
  EXPECT_EQ(recovery.recover(18), passed);
}

// H = 2, after 0 and 1: 3 leaves 2 open; 5 is two ahead of 3: 2 leaves the history unseen and is lost; 3 has been seen.
TEST(VectorRecovery, CountsWhatLeavesTheHistoryUnseen) {
  SequenceRecovery recovery(vector_of(2));
  for (const SequenceNumber n : Numbers{0, 1, 2}) EXPECT_EQ(recovery.recover(n), passed);
  EXPECT_EQ(recovery.counters().lost_packets, 1u);  // the empty place before 0
  EXPECT_EQ(recovery.counters().really_lost(), 0u);
  EXPECT_EQ(recovery.recover(3), passed);
  EXPECT_EQ(recovery.recover(5), discarded);  // delta 2 is not below H
  EXPECT_EQ(recovery.counters().rogue_packets, 1u);

  SequenceRecovery wider(vector_of(3));
  for (const SequenceNumber n : Numbers{0, 1, 3, 4}) EXPECT_EQ(wider.recover(n), passed);
  EXPECT_EQ(wider.counters().really_lost(), 0u);  // 2 may still come
  EXPECT_EQ(wider.recover(5), passed);
  EXPECT_EQ(wider.counters().really_lost(), 1u);
  EXPECT_EQ(wider.counters().lost_packets, 3u);
  EXPECT_EQ(wider.counters().out_of_order_packets, 1u);
}

TEST(VectorRecovery, WrapsAround) {
  SequenceRecovery recovery(vector_of(8));
  for (const SequenceNumber n : Numbers{65'533, 65'534, 0, 65'535, 1}) EXPECT_EQ(recovery.recover(n), passed);
  for (const SequenceNumber n : Numbers{65'533, 65'534, 0, 65'535, 1}) EXPECT_EQ(recovery.recover(n), discarded);
  EXPECT_EQ(recovery.counters().out_of_order_packets, 2u);  // 0 and 65535
  EXPECT_EQ(recovery.counters().rogue_packets, 0u);
  EXPECT_EQ(recovery.recover(32'769), discarded);  // delta -32768
  EXPECT_EQ(recovery.counters().rogue_packets, 1u);
}

TEST(VectorRecovery, AResetTakesAny) {
  SequenceRecovery recovery(vector_of(4));
  EXPECT_EQ(recovery.recover(100), passed);
  EXPECT_EQ(recovery.recover(5'000), discarded);
  recovery.reset();
  EXPECT_EQ(recovery.recover(5'000), passed);
  EXPECT_EQ(recovery.recover(5'000), discarded);
  EXPECT_EQ(recovery.recover(4'999), passed);  // the history is empty
  EXPECT_EQ(recovery.counters().resets, 2u);
}

TEST(VectorRecovery, FramesWithoutANumber) {
  SequenceRecovery strict(vector_of(4));
  EXPECT_EQ(strict.recover(std::nullopt), discarded);
  EXPECT_EQ(strict.counters().tagless_packets, 1u);
  EXPECT_EQ(strict.counters().discarded_packets, 1u);
  SequenceRecoveryConfig config = vector_of(4);
  config.take_no_sequence = true;
  SequenceRecovery lenient(config);
  EXPECT_EQ(lenient.recover(std::nullopt), passed);
  EXPECT_EQ(lenient.counters().passed_packets, 1u);
  EXPECT_EQ(lenient.recover(9), passed);  // still takes any
}

TEST(VectorRecovery, IndividualRecoveryKeepsTheTimerForDiscardedFrames) {
  SequenceRecoveryConfig config = vector_of(4);
  config.individual_recovery = true;
  SequenceRecovery recovery(config);
  EXPECT_EQ(recovery.recover(10), passed);
  EXPECT_EQ(recovery.recover(10), discarded_but_alive);
  EXPECT_EQ(recovery.recover(20), discarded_but_alive);
}

TEST(VectorRecovery, HistoryLengthsAreBounded) {
  EXPECT_THROW(SequenceRecovery(vector_of(1)), sim::InvariantBroken);
  EXPECT_THROW(SequenceRecovery(vector_of(1'025)), sim::InvariantBroken);
  EXPECT_NO_THROW(SequenceRecovery(vector_of(1'024)));
}

TEST(MatchRecovery, PassesWhatDiffersFromTheLast) {
  SequenceRecoveryConfig config;
  config.algorithm = RecoveryAlgorithm::match;
  SequenceRecovery recovery(config);
  EXPECT_EQ(recovery.recover(65'535), passed);  // TakeAny, though RecovSeqNum begins as 65535
  EXPECT_EQ(recovery.recover(65'535), discarded);
  EXPECT_EQ(recovery.recover(0), passed);
  EXPECT_EQ(recovery.recover(0), discarded);
  EXPECT_EQ(recovery.counters().out_of_order_packets, 0u);
  EXPECT_EQ(recovery.recover(2), passed);
  EXPECT_EQ(recovery.counters().out_of_order_packets, 1u);
  EXPECT_EQ(recovery.recover(0), passed);  // it remembers one number only
  EXPECT_EQ(recovery.recover(std::nullopt), passed);
  EXPECT_EQ(recovery.counters().tagless_packets, 1u);
  EXPECT_EQ(recovery.counters().passed_packets, 5u);
  EXPECT_EQ(recovery.counters().discarded_packets, 2u);
  config.individual_recovery = true;
  SequenceRecovery individual(config);
  EXPECT_EQ(individual.recover(1), passed);
  EXPECT_EQ(individual.recover(1), discarded_but_alive);
}

/// The pseudocode of the reference with the history as a list of bits, most recent first.
class ListRecovery {
 public:
  explicit ListRecovery(std::uint32_t length) : length_(static_cast<int>(length)) { reset(); }
  void reset() {
    number_ = 65'535;
    history_.assign(static_cast<std::size_t>(length_), false);
    accept_any_ = true;
    ++counters.resets;
  }
  bool recover(int sequence) {
    int delta = (sequence - number_ + 2 * 65'536) % 65'536;
    if (delta > 32'767) delta -= 65'536;
    if (accept_any_) {
      accept_any_ = false;
      history_[0] = true;
      number_ = sequence;
      return verdict(true);
    }
    if (std::abs(delta) >= length_) {
      ++counters.rogue_packets;
      return verdict(false);
    }
    if (delta <= 0) {
      if (history_[static_cast<std::size_t>(-delta)]) return verdict(false);
      history_[static_cast<std::size_t>(-delta)] = true;
      ++counters.out_of_order_packets;
      return verdict(true);
    }
    if (delta != 1) ++counters.out_of_order_packets;
    for (int i = 0; i < delta - 1; ++i) shift(false);
    shift(true);
    number_ = sequence;
    return verdict(true);
  }
  Counters counters;

 private:
  bool verdict(bool pass) {
    ++(pass ? counters.passed_packets : counters.discarded_packets);
    return pass;
  }
  void shift(bool bit) {
    if (!history_.back()) ++counters.lost_packets;
    history_.pop_back();
    history_.push_front(bit);
  }
  int length_;
  int number_ = 0;
  bool accept_any_ = true;
  std::deque<bool> history_;
};

TEST(VectorRecovery, AgreesWithAListOfBits) {
  const bool agrees = rc::check("vector recovery = pseudocode", [] {
    const std::uint32_t length = *rc::gen::oneOf(rc::gen::inRange<std::uint32_t>(2, 9),
                                                 rc::gen::element<std::uint32_t>(63, 64, 65, 1'023, 1'024));
    SequenceRecovery recovery(vector_of(length));
    ListRecovery oracle(length);
    const int reach = static_cast<int>(length) + 2;
    int at = *rc::gen::inRange(0, 65'536);
    const auto steps = *rc::gen::container<std::vector<std::pair<int, int>>>(
        rc::gen::pair(rc::gen::inRange(0, 40), rc::gen::inRange(-reach, reach + 1)));
    for (const auto& [action, offset] : steps) {
      if (action == 0) {
        recovery.reset();
        oracle.reset();
      } else if (action < 30) {
        at = (at + 1 + 65'536) % 65'536;
      } else {
        at = (at + offset + 65'536) % 65'536;
      }
      const Decision decision = recovery.recover(static_cast<SequenceNumber>(at));
      RC_ASSERT(decision.pass == oracle.recover(at));
      RC_ASSERT(decision.restart_timer == decision.pass);
      Counters counters = recovery.counters();
      counters.lost_at_start = 0;
      RC_ASSERT(counters == oracle.counters);
      RC_ASSERT(recovery.counters().lost_at_start <= recovery.counters().lost_packets);
    }
  });
  EXPECT_TRUE(agrees);
}

// What FRER is for: two lossy copies, the second delayed by less than the history. Every number that came at least once
// passes exactly once, and the lost counter is the number of those that never came and have left the history.
TEST(VectorRecovery, EachNumberPassesOnce) {
  const bool holds = rc::check("two lossy paths: exactly once", [] {
    const std::uint32_t length = *rc::gen::element<std::uint32_t>(8, 64, 256);
    const auto lag = *rc::gen::inRange<std::size_t>(0, length / 2);
    const auto mostly = rc::gen::weightedElement<bool>({{9, true}, {1, false}});
    const auto arrives = *rc::gen::container<std::vector<std::pair<bool, bool>>>(400, rc::gen::pair(mostly, mostly));
    const int origin = *rc::gen::inRange(0, 65'536);
    SequenceRecovery recovery(vector_of(length));
    std::map<std::size_t, int> passes;
    std::size_t came = 0, in_a_row = 0;
    std::optional<std::size_t> first;
    const auto arrive = [&](std::size_t n) {
      if (recovery.recover(static_cast<SequenceNumber>(origin + static_cast<int>(n))).pass) ++passes[n];
      if (!first) first = n;
    };
    for (std::size_t n = 0; n < arrives.size() + lag; ++n) {
      if (n < arrives.size() && arrives[n].first) arrive(n);
      if (n >= lag && arrives[n - lag].second) arrive(n - lag);
    }
    std::uint64_t lost = 0;
    for (std::size_t n = 0; n < arrives.size(); ++n) {
      const bool any = arrives[n].first || arrives[n].second;
      in_a_row = arrives[n].first ? 0 : in_a_row + 1;
      RC_PRE(in_a_row < length / 2);  // a longer outage of the first path would make rogues
      came += any;
      if (any) RC_ASSERT(passes[n] == 1);
      if (!any && first && n > *first && n + length < arrives.size() - in_a_row) ++lost;
    }
    RC_ASSERT(recovery.counters().passed_packets == came);
    RC_ASSERT(recovery.counters().rogue_packets == 0u);
    RC_ASSERT(recovery.counters().really_lost() >= lost);
    RC_ASSERT(recovery.counters().really_lost() <= arrives.size() - came);
  });
  EXPECT_TRUE(holds);
}

// Two paths: each passed frame should have one discarded copy.
TEST(LatentErrorDetection, SignalsWhenCopiesStayAway) {
  LatentErrorDetectionConfig config;
  config.difference = 5;
  LatentErrorDetection detection(config);
  Counters counters;
  counters.resets = 1;
  counters.passed_packets = 100;
  counters.discarded_packets = 95;
  EXPECT_FALSE(detection.test(counters));
  counters.discarded_packets = 94;
  EXPECT_TRUE(detection.test(counters));
  counters.discarded_packets = 105;
  EXPECT_FALSE(detection.test(counters));
  counters.discarded_packets = 106;  // more copies than paths
  EXPECT_TRUE(detection.test(counters));
  EXPECT_EQ(detection.errors(), 2u);
  detection.reset(counters);  // forgiven
  EXPECT_FALSE(detection.test(counters));
  EXPECT_EQ(detection.resets(), 1u);
  counters.passed_packets += 6;
  EXPECT_TRUE(detection.test(counters));
}

TEST(LatentErrorDetection, ThreePathsAndSuppression) {
  LatentErrorDetectionConfig config;
  config.paths = 3;
  LatentErrorDetection detection(config);
  Counters counters;
  counters.resets = 1;
  counters.passed_packets = 10;
  counters.discarded_packets = 20;
  EXPECT_FALSE(detection.test(counters));
  counters.passed_packets = 11;
  counters.resets = 2;  // the recovery was reset in this period
  EXPECT_FALSE(detection.test(counters));
  EXPECT_TRUE(detection.test(counters));
}

}  // namespace
}  // namespace takt::models
