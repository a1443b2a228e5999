// SPDX-License-Identifier: Apache-2.0
// What is proved for any number of slaves, and that real groups of 5 to 64 slaves stay within what the proof looks at.
#include "explore/parts/views.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <optional>
#include <vector>

#include "../ask.hpp"
#include "explore/model/beginnings.hpp"
#include "explore/model/wiring.hpp"
#include "handshake/observer.hpp"

namespace takt::explore {
namespace {

using handshake::Input;
using handshake::Word;
using Real = handshake::Participant<64>;

Query asked(std::uint32_t commands, std::uint32_t faults, std::initializer_list<Fault> classes) {
  Query query;
  query.fault_budget = faults;
  return with(query, commands, std::vector<Fault>(classes));
}

AnyNumber proved(const Query& query) {
  return prove_for_any_number(query, [](const Progress&) { return true; });
}

struct Proved {
  Query query;
  std::uint64_t views;
};

TEST(Views, ProveRobustForEveryNumberOfSlaves) {
  const Proved all[] = {
      {asked(1, 0, {}), 179},
      {asked(2, 0, {}), 1962},
      {asked(3, 0, {}), 8854},
      {asked(1, 1, {Fault::loss, Fault::crash}), 966},
      {asked(2, 1, {Fault::loss, Fault::crash}), 7746},
      {asked(1, 1, {Fault::loss, Fault::timeout}), 1788},
  };
  for (const Proved& each : all) {
    SCOPED_TRACE(query_line(each.query));
    const AnyNumber result = proved(each.query);
    EXPECT_TRUE(result.exhausted && result.are_alike && result.is_proved());
    EXPECT_EQ(result.views, each.views);
  }
}

// Without a call nothing happens, and that is no proof.
TEST(Views, SayWhatIsNeverReached) {
  const AnyNumber result = proved(asked(0, 0, {}));
  EXPECT_TRUE(result.exhausted);
  EXPECT_FALSE(result.is_proved());
  EXPECT_EQ(result[Property::T5], PropertyVerdict::unreached);
}

TEST(Views, CanBeCutAndInterrupted) {
  Query query = asked(2, 1, {Fault::crash});
  query.states = 100;
  const AnyNumber few = proved(query);
  EXPECT_FALSE(few.exhausted);
  EXPECT_EQ(few[Property::S1], PropertyVerdict::unknown);
}

Word nameless(Word word) {
  if (word.intent.origin != 0) word.intent.origin = 1;
  return word;
}

/// A real group: participants of a node, registers with real words and sequence numbers. Beside it the parts of the
/// same group, step by step.
class RealGroup {
 public:
  RealGroup(Views& views, std::size_t slaves)
      : parts_(views.parts()),
        views_(views),
        registers_(2 * slaves),
        sequences_(slaves + 1, 0),
        down_(slaves + 1, false) {
    for (std::size_t i = 0; i <= slaves; ++i) members_.push_back(fresh(i, 1));
    master_ = parts_.master_switched_on();
    slaves_.assign(slaves, parts_.slave_switched_on());
  }

  void settle() {
    for (int round = 0; round < 6; ++round) {
      for (std::size_t i = 0; i < members_.size(); ++i) initialise(i);
      for (std::size_t c = 0; c < registers_.size(); ++c) {
        send(c);
        receive(c);
      }
    }
  }
  void begin(std::uint32_t commands, std::uint32_t faults) {
    commands_ = commands;
    faults_ = faults;
  }

  bool is_down(std::size_t i) const { return down_[i]; }
  void send(std::size_t channel) {
    const std::size_t sender = sender_of(channel);
    if (!down_[sender]) registers_[channel] = Message{members_[sender].word(), ++sequences_[sender]};
  }
  void receive(std::size_t channel) {
    if (registers_[channel]) hear(channel, *registers_[channel], ActionKind::receive);
  }
  void lose(std::size_t channel) { registers_[channel].reset(); }
  void initialise(std::size_t i) {
    if (down_[i] || members_[i].state() != handshake::PublishedState::HaltedInit) return;
    step(i, Input::initialised(members_[i].intent().run));
    follow(i, {ActionKind::initialised, place(i), 0});
  }
  bool call(std::size_t i, std::size_t method) {
    const program::Method called = program::methods[method].method;
    Real tried = members_[i];
    if (down_[i] || commands_ == 0 || (i != 0 && called == program::Method::Start) ||
        !program::is_good(tried.step(Input::command(called)).status))
      return false;
    --commands_;
    step(i, Input::command(called));
    follow(i, {ActionKind::call, place(i), static_cast<std::uint16_t>(method)});
    return true;
  }
  void crash(std::size_t i) {
    if (down_[i] || !spend_fault()) return;
    down_[i] = true;
    follow(i, {ActionKind::crash, place(i), 0});
  }
  /// The hearer's time-out of this channel expires.
  void expire(std::size_t channel) {
    const bool is_silence = down_[sender_of(channel)];
    if (down_[receiver_of(channel)] || (!is_silence && !spend_fault())) return;
    step(receiver_of(channel), Input::peer_silent(peer_of(channel)));
    if (is_silence) registers_[channel].reset();
    follow(slave_of(channel), {is_silence ? ActionKind::silence : ActionKind::timeout,
                               is_up(channel) ? std::uint8_t{0} : std::uint8_t{1}, 0});
  }

  /// Master and slave by slave: the parts are what the real participants are, and the proof has looked at them.
  void expect_within(bool is_in_proof) {
    const auto same = [&](const Real& real, const Participant& here, bool is_down) {
      if (is_down) return true;
      return nameless(real.word()) == here.word() && real.waits_initialised() == here.waits_initialised();
    };
    ASSERT_EQ(down_[0], parts_.of_master(master_).down);
    ASSERT_TRUE(same(members_[0], parts_.master_value(master_), down_[0]));
    for (std::size_t i = 0; i < slaves_.size(); ++i) {
      SCOPED_TRACE(testing::Message() << "slave " << i + 1);
      ASSERT_EQ(down_[i + 1], parts_.of_slave(slaves_[i]).down);
      ASSERT_TRUE(same(members_[i + 1], parts_.slave_value(slaves_[i]), down_[i + 1]));
      if (!down_[0]) expect_same(members_[0].part_of(i), parts_.known(slaves_[i]));
      if (!down_[i + 1]) expect_same(members_[i + 1].part_of(0), parts_.slave_value(slaves_[i]).part_of(0));
      if (is_in_proof) {
        ASSERT_TRUE(views_.contains(master_, commands_, faults_, false, slaves_[i]));
      }
    }
    ASSERT_TRUE(observer_.violations().empty());
  }
  std::size_t steps() const { return steps_; }

 private:
  struct Message {
    Word word;
    std::uint16_t sequence = 0;
  };

  Real fresh(std::size_t i, std::uint32_t incarnation) const {
    const auto slaves = static_cast<std::uint8_t>(slaves_.empty() ? registers_.size() / 2 : slaves_.size());
    return Real({handshake::Variant::robust, i == 0 ? handshake::Role::master : handshake::Role::slave,
                 static_cast<std::uint8_t>(i), slaves, incarnation});
  }
  static void expect_same(const Real::PeerPart& real, const Known& here) {
    const auto fields = [](const auto& known) {
      return std::tuple(known.peer.incarnation, known.peer.run, known.peer.state, known.peer.heard,
                        known.peer.sequence_known, known.ready, known.running);
    };
    ASSERT_EQ(fields(real), fields(here));
  }
  bool is_up(std::size_t channel) const { return channel < slaves_.size(); }
  std::size_t slave_of(std::size_t channel) const { return channel % slaves_.size() + 1; }
  std::size_t sender_of(std::size_t channel) const { return is_up(channel) ? slave_of(channel) : 0; }
  std::size_t receiver_of(std::size_t channel) const { return is_up(channel) ? 0 : slave_of(channel); }
  std::size_t peer_of(std::size_t channel) const { return is_up(channel) ? channel : 0; }
  static std::uint8_t place(std::size_t i) { return i == 0 ? 0 : 1; }
  std::uint8_t who(std::size_t channel) const { return is_up(channel) ? 0 : 1; }
  bool spend_fault() {
    if (faults_ == 0) return false;
    --faults_;
    return true;
  }

  /// How many newer words the sender has had than this one, as the parts know it.
  std::uint16_t newer(std::size_t channel, const Word& word) {
    const SlaveId slave = slaves_[slave_of(channel) - 1];
    const Said& said = is_up(channel) ? parts_.up(slave) : parts_.down(slave);
    for (std::size_t back = 0; back < said.size(); ++back)
      if (parts_.word(said[said.size() - 1 - back]) == nameless(word)) return static_cast<std::uint16_t>(back);
    ADD_FAILURE() << "a register holds what cannot stand in it";
    return 0;
  }
  void hear(std::size_t channel, const Message& message, ActionKind kind) {
    if (down_[receiver_of(channel)]) return;
    const std::uint16_t back = newer(channel, message.word);
    step(receiver_of(channel), Input::received(peer_of(channel), message.word, message.sequence));
    follow(slave_of(channel), {kind, who(channel), back});
  }
  void step(std::size_t i, const Input& input) {
    if (down_[i]) return;
    const handshake::Outputs outputs = members_[i].step(input);
    observer_.on_step(i, outputs, members_[i].word());
  }
  /// The same step of the parts; `about`: the slave, or 0.
  void follow(std::size_t about, Action action) {
    ++steps_;
    Others others;
    for (std::size_t i = 0; i < slaves_.size(); ++i) {
      if (i + 1 == about) continue;
      others.are_ready = others.are_ready && parts_.known(slaves_[i]).ready;
      others.are_running = others.are_running && parts_.known(slaves_[i]).running;
    }
    const auto outcomes = about == 0 ? parts_.alone(master_, action, others)
                                     : parts_.with_slave(master_, slaves_[about - 1], action, others);
    if (outcomes.empty()) return;  // nothing changes
    const Outcome done = outcomes.front();
    for (std::size_t i = 0; i < slaves_.size(); ++i)
      slaves_[i] = i + 1 == about ? done.slave : parts_.after(master_, done.master, slaves_[i]);
    master_ = done.master;
  }

  Parts& parts_;
  Views& views_;
  MasterId master_ = 0;
  std::vector<SlaveId> slaves_;
  std::vector<Real> members_;
  std::vector<std::optional<Message>> registers_;
  std::vector<std::uint16_t> sequences_;
  std::vector<bool> down_;
  handshake::Observer observer_{handshake::Variant::robust, registers_.size() / 2 + 1};
  std::uint32_t commands_ = most_commands;
  std::uint32_t faults_ = 0;
  std::size_t steps_ = 0;
};

class Dice {
 public:
  explicit Dice(std::uint64_t seed) : state_(seed) {}
  std::size_t below(std::size_t count) {
    state_ = state_ * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<std::size_t>((state_ >> 33) % count);
  }

 private:
  std::uint64_t state_;
};

void run(RealGroup& group, std::size_t slaves, Dice& dice) {
  const std::size_t i = dice.below(slaves + 1);
  const std::size_t channel = dice.below(2 * slaves);
  switch (dice.below(24)) {
    case 0:
      group.call(i, dice.below(program::methods.size()));
      break;
    case 1:
      if (dice.below(4) == 0) group.crash(i);
      break;
    case 3:
      if (group.is_down(channel < slaves ? channel + 1 : 0) || dice.below(16) == 0) group.expire(channel);
      break;
    case 4:
      group.lose(channel);
      break;
    case 7:
    case 8:
      group.initialise(i);
      break;
    default:
      dice.below(2) == 0 ? group.send(channel) : group.receive(channel);
      break;
  }
}

// Step by step: the registers hold nothing else, the master takes no other step, and each view of the group is one that
// was proved.
TEST(Views, HoldEveryStepOfRealGroups) {
  Views views(asked(1, 1, {Fault::loss, Fault::crash, Fault::timeout}));
  ASSERT_TRUE(views.prove([](const Progress&) { return true; }).is_proved());
  std::size_t steps = 0;
  for (const std::size_t slaves : {5U, 8U, 13U, 33U, 64U}) {
    for (std::size_t begins = 0; begins < rests().size(); ++begins) {
      for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        SCOPED_TRACE(testing::Message() << slaves << " slaves from " << rests()[begins].name << ", seed " << seed);
        RealGroup group(views, slaves);
        Dice dice(seed);
        for (const program::Method method : rests()[begins].calls) {
          ASSERT_TRUE(group.call(0, program::index_of(method)));
          group.settle();
        }
        group.begin(1, 1);
        group.expect_within(true);  // the states at rest are those of small groups
        for (std::size_t i = 0; i < 40 * slaves; ++i) {
          const std::size_t before = group.steps();
          run(group, slaves, dice);
          if (group.steps() == before) continue;
          group.expect_within(true);
          if (testing::Test::HasFatalFailure()) return;
        }
        steps += group.steps();
      }
    }
  }
  EXPECT_GT(steps, 20'000U);
}

}  // namespace
}  // namespace takt::explore
