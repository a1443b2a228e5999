// SPDX-License-Identifier: Apache-2.0
// A stranger who replays: signed words move nobody again, unsigned ones do, and what a state keeps of windows and keys
// is what a node's receiver does.
#include <gtest/gtest.h>

#include <array>
#include <map>
#include <random>

#include "../ask.hpp"
#include "explore/model/group_model.hpp"
#include "explore/report/account.hpp"
#include "explore/report/knowledge.hpp"
#include "security/key_ring.hpp"

namespace takt::explore {
namespace {

Query replaying(std::uint8_t slaves, std::uint32_t commands, std::vector<Fault> faults = {Fault::replay}) {
  Query query;
  query.slaves = slaves;
  return with(query, commands, faults);
}
Query secured(Query query) {
  query.is_signed = true;
  query.key_changes = 1;
  return query;
}

TEST(Replays, SignedWordsHoldEverything) {
  expect_to_hold({secured(replaying(1, 2)), 65981, 240119});
  expect_to_hold({secured(replaying(1, 1, {Fault::replay, Fault::loss, Fault::crash, Fault::restart, Fault::timeout})),
                  332100, 974844});
  Query twice = secured(replaying(1, 1));
  twice.key_changes = 2;
  expect_to_hold({twice, 44547, 183369});
  Query thrice = secured(replaying(1, 1));
  thrice.fault_budget = 3;
  expect_to_hold({thrice, 8517, 31580});
#ifdef NDEBUG
  Query restarts = secured(replaying(1, 1, {Fault::replay, Fault::restart}));
  restarts.fault_budget = 2;
  expect_to_hold({restarts, 2366278, 7613394});
  expect_to_hold({secured(replaying(2, 1)), 2159001, 13846673});
#endif
}

// Within one life of everybody the handshake itself lets no old word move anybody.
TEST(Replays, UnsignedWordsOfOneLifeMoveNobody) { expect_to_hold({replaying(1, 2), 23039, 62795}); }

// Who was restarted knows nothing, and takes a recorded start for one.
TEST(Replays, UnsignedWordsMoveWhoWasRestarted) {
  Query query = replaying(1, 0, {Fault::replay, Fault::restart});
  query.fault_budget = 2;
  const SearchResult result = ask(query);
  EXPECT_TRUE(result.exhausted);
  for (const Property property : {Property::S1, Property::S2, Property::S3, Property::S4, Property::S5, Property::L1})
    EXPECT_EQ(result[property], PropertyVerdict::holds) << text_report(query, result, 0.0);
  ASSERT_EQ(result[Property::R1], PropertyVerdict::violated);
  const std::vector<Explanation> all = explanations(query, result);
  ASSERT_EQ(all.size(), 1U);
  ASSERT_EQ(all[0].steps.size(), 2U);
  EXPECT_EQ(all[0].steps[1].sentence,
            "fault: a stranger replays to slave 1 a word of master: Halted.INIT (intent 1 start of master, run 0)");
  const Belief& belief = all[0].steps[1].knowledge.back();
  EXPECT_TRUE(belief.is_replayed && !belief.by_stranger && belief.is_cause);
  EXPECT_EQ(text_of(belief),
            "slave 1 takes master for Halted.INIT (intent 1 start of master, run 0), said before the first step, "
            "replayed by a stranger in step 2; "
            "it is Running (intent 1 start of master, run 1) since the beginning");
}

/// The last word of the master that says so was said so many before the last one.
std::size_t back_to(GroupModel& model, const State& state, handshake::PublishedState said) {
  const Recording& recording = model.recording(state, 0);
  for (std::size_t place = recording.size(); place > 0; --place)
    if (model.members().word(recording[place].word).state == said) return recording.size() - place;
  return most_recorded;
}

// Two recorded words take a slave that was restarted to Running, while its master is down: signed, it takes neither.
TEST(Replays, ARecordedStartStarts) {
  for (const bool is_signed : {false, true}) {
    SCOPED_TRACE(is_signed);
    Query query = replaying(1, 0, {Fault::replay, Fault::restart, Fault::crash});
    query.fault_budget = 4;
    query.is_signed = is_signed;
    GroupModel model(query);
    State state = model.beginnings()[1].state;
    Next next;
    const auto take = [&](Action action) {
      const bool done = model.act(state, action, next);
      if (done) state = next.state;
      return done;
    };
    ASSERT_TRUE(take({ActionKind::crash, 0, 0}));
    ASSERT_TRUE(take({ActionKind::restart, 1, 0}));
    const std::size_t channel = model.wiring().channel(0, 1);
    for (const handshake::PublishedState said :
         {handshake::PublishedState::HaltedInit, handshake::PublishedState::Ready}) {
      EXPECT_EQ(take({ActionKind::replay, static_cast<std::uint8_t>(channel),
                      static_cast<std::uint16_t>(back_to(model, state, said))}),
                !is_signed);
      take({ActionKind::initialised, 1, 0});
    }
    EXPECT_EQ(model.state_of(state, 1),
              is_signed ? handshake::PublishedState::Halted : handshake::PublishedState::Running);
  }
}

/// A sender's life as its nonces tell it, and a hearer with a window and keys: the very classes of a node.
class Peer {
 public:
  Peer() {
    std::vector<security::Secret> keys;
    for (unsigned i = 0; i < 8; ++i) keys.emplace_back(security::key_octets(security::MessagePolicy::aes128_ctr));
    ring_.emplace(security::MessagePolicy::aes128_ctr, security::KeySchedule{1, 0, lifetime},
                  std::make_unique<security::ListedKeys>(1, std::move(keys)));
  }
  bool takes(const security::Freshness& freshness, std::uint8_t changes) {
    return ring_->find(freshness.token, changes * lifetime + lifetime / 2) != nullptr &&
           security::ReplayMemory(windows_).take({7, 1, 0}, freshness);
  }

 private:
  static constexpr std::int64_t lifetime = 1'000'000'000;
  std::optional<security::KeyRing> ring_;
  std::array<security::StoredWindow, 4> windows_{};
};

// What a recording says of a message is what window and keys of a node say, in any order of words, changes of keys,
// restarts and replays.
TEST(Replays, RecordingsTakeWhatANodeTakes) {
  std::size_t taken = 0;
  std::size_t refused = 0;
  for (unsigned seed = 0; seed < 300; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const auto below = [&random](std::size_t count) { return random() % count; };
    Recording recording;
    Peer hearer;
    std::vector<security::Freshness> first;     // by place: of the first message that says so
    std::map<std::size_t, std::uint32_t> used;  // by place: messages that the hearer has opened
    security::Freshness now{1, 0, static_cast<std::uint16_t>(random())};  // lives go round
    const std::uint16_t first_life = now.life;
    std::uint8_t keys_of_hearer = 0;
    for (int step = 0; step < 60; ++step) {
      switch (below(6)) {
        case 0:
          if (recording.size() == most_recorded) break;
          recording.say(static_cast<WordId>(1 + below(5)), static_cast<std::uint8_t>(now.life - first_life));
          if (recording.size() == first.size()) break;
          first.push_back({now.token, now.number + 1, now.life});
          now.number += 1000;
          break;
        case 1:
          if (below(4) != 0 || recording.token() == 5 || recording.token() > keys_of_hearer) break;
          recording.change_key();
          ++now.token;
          now.number = 0;
          break;
        case 2:
          if (keys_of_hearer <= recording.token() && keys_of_hearer < 5 && below(2) == 0) ++keys_of_hearer;
          break;
        case 3:
          if (below(4) != 0) break;
          ++now.life;
          now.number = 0;
          break;
        default: {
          if (first.empty()) break;
          const std::size_t place = 1 + below(first.size());
          security::Freshness message = first[place - 1];
          message.number += used[place]++;
          const bool is_taken = recording.takes(0, place, keys_of_hearer);
          ASSERT_EQ(is_taken, hearer.takes(message, keys_of_hearer)) << "step " << step << ", place " << place;
          if (is_taken) recording.take(0, place);
          ++(is_taken ? taken : refused);
        }
      }
    }
  }
  EXPECT_GT(taken, 500U);
  EXPECT_GT(refused, 500U);
}

// What all hearers have left behind is forgotten, and nothing of it would have been taken.
TEST(Replays, ForgettingChangesNothing) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    std::mt19937 random(seed);
    Recording whole;
    Recording kept;
    for (int step = 0; step < 35; ++step) {
      const auto word = static_cast<WordId>(1 + random() % 9);
      whole.say(word, 1);
      kept.say(word, 1);
      const std::size_t hearer = 1 + random() % 2;
      const std::size_t gone = whole.size() - kept.size();
      const std::size_t place = 1 + random() % whole.size();
      const bool is_taken = whole.takes(hearer, place, 0);
      if (place <= gone) {
        EXPECT_FALSE(is_taken);
        continue;
      }
      EXPECT_EQ(is_taken, kept.takes(hearer, place - gone, 0));
      if (!is_taken) continue;
      whole.take(hearer, place);
      kept.take(hearer, place - gone);
      kept.forget(0b110);
    }
  }
}

}  // namespace
}  // namespace takt::explore
