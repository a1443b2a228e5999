// SPDX-License-Identifier: Apache-2.0
// A group of participants, in a star unless said otherwise, without a network: the test says which word is delivered
// when.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "handshake/observer.hpp"
#include "handshake/participant.hpp"
#include "handshake/reaction.hpp"

namespace takt::handshake {

/// A word under way, with process data if its sender is Running.
struct Message {
  std::size_t from = 0;
  std::size_t to = 0;
  Word word;
  std::uint16_t sequence = 0;
  std::uint32_t sent_in = 0;  ///< Observer::sending_run
};

class Group {
 public:
  using Member = Participant<64>;

  explicit Group(Variant variant, std::size_t slaves, Subscription subscription = Subscription::star)
      : observer(variant, slaves + 1),
        reactions(slaves + 1),
        variant_(variant),
        subscription_(subscription),
        pending_(slaves + 1),
        sequence_(slaves + 1),
        incarnation_(slaves + 1, 1) {
    for (std::size_t i = 0; i <= slaves; ++i) members_.emplace_back(config(i));
  }

  std::size_t size() const { return members_.size(); }
  const Member& operator[](std::size_t i) const { return members_[i]; }
  Config config(std::size_t i) const {
    return {variant_,
            i == 0 ? Role::master : Role::slave,
            static_cast<std::uint8_t>(i),
            static_cast<std::uint8_t>(pending_.size() - 1),
            incarnation_[i],
            subscription_};
  }

  /// One step; everything that a host and the observers do with its outputs.
  Outputs step(std::size_t i, const Input& input) {
    const Word before = members_[i].word();
    Member at_length = members_[i];
    const Outputs outputs = members_[i].step(input);
    EXPECT_TRUE(outputs == at_length.step_at_length(input) && members_[i] == at_length)
        << "a short cut leads elsewhere";
    EXPECT_EQ(outputs.publish, members_[i].word() != before);
    observer.on_step(i, outputs, members_[i].word());
    reactions.on_step(i, outputs, members_[i].word(), now);
    for (const StateChange& change : outputs.changes())
      journal += std::to_string(i) + ":" + std::string(name_of(change.to)) + " ";
    if (outputs.begin_initialisation) pending_[i] = {true, outputs.initialisation_run};
    if (members_[i].state() != PublishedState::HaltedInit) pending_[i] = {};
    return outputs;
  }
  Outputs call(std::size_t i, program::Method method) { return step(i, Input::command(method)); }

  bool initialising(std::size_t i) const { return pending_[i].under_way; }
  Outputs initialised(std::size_t i) {
    const std::uint32_t run = pending_[i].run;
    pending_[i] = {};
    return step(i, Input::initialised(run));
  }

  Message message(std::size_t from, std::size_t to) {
    return {from, to, members_[from].word(), ++sequence_[from], observer.sending_run(from)};
  }
  /// The receiver's step, and the process data of the message if it counts.
  Outputs deliver(const Message& message) {
    Member& receiver = members_[message.to];
    const std::size_t peer = receiver.peer_of(message.from);
    const Outputs outputs = step(message.to, Input::received(peer, message.word, message.sequence));
    if (message.sent_in != 0 && !outputs.ignored && receiver.process_data_counts(peer))
      observer.on_process_data(message.from, message.to, message.sent_in);
    return outputs;
  }
  /// Sends the present word to one peer at once.
  Outputs tell(std::size_t from, std::size_t to) { return deliver(message(from, to)); }
  /// One word to all that hear it: a slave's in a star to the master.
  void notify_all(std::size_t from) {
    for (std::size_t peer = 0; peer < members_[from].peer_count(); ++peer)
      tell(from, members_[from].participant_of(peer));
  }
  /// Everybody's initialisation ends and everybody publishes once.
  void round() {
    for (std::size_t i = 0; i < size(); ++i) {
      if (initialising(i)) initialised(i);
      notify_all(i);
    }
  }
  void rounds(int count) {
    for (int i = 0; i < count; ++i) round();
  }

  /// Starts until the master and all slaves are Ready and slave 1 alone is Running.
  void to_barrier() {
    call(0, program::Method::Start);
    notify_all(0);
    for (std::size_t i = 0; i < size(); ++i) initialised(i);
    for (std::size_t i = 1; i < size(); ++i) tell(i, 0);
    tell(0, 1);
    EXPECT_EQ(members_[0].state(), PublishedState::Ready);
    EXPECT_EQ(members_[1].state(), PublishedState::Running);
  }

  void restart(std::size_t i) {
    ++incarnation_[i];
    sequence_[i] = 0;
    pending_[i] = {};
    members_[i] = Member(config(i));
    observer.on_restart(i);
    reactions.on_restart(i, now);
  }

  bool all_in(PublishedState state) const {
    for (const Member& member : members_)
      if (member.state() != state) return false;
    return true;
  }
  /// L1: all know the same intent and are in the state that it names.
  bool agreed() const {
    for (const Member& member : members_)
      if (member.intent() != members_[0].intent()) return false;
    return all_in(goal_of(members_[0].intent().kind));
  }

  /// The changes of state since the last call, as "participant:state ".
  std::string drain_journal() {
    std::string taken;
    taken.swap(journal);
    return taken;
  }

  std::string describe() const {
    std::string text;
    for (std::size_t i = 0; i < size(); ++i) {
      const Word word = members_[i].word();
      text += "  " + std::to_string(i) + " " + std::string(name_of(word.state)) + " intent " +
              std::to_string(word.intent.number) + "/" + std::string(name_of(word.intent.kind)) + "/" +
              std::to_string(word.intent.origin) + "/" + std::to_string(word.intent.run) + " run " +
              std::to_string(word.run) + "\n";
    }
    for (const Violation& violation : observer.violations())
      text += "  " + std::string(name_of(violation.invariant)) + ": " + std::to_string(violation.participant) + " " +
              std::string(text_of(violation.finding)) + "\n";
    return text;
  }

  Observer observer;
  ReactionTracker reactions;
  sim::TrueTime now;
  std::string journal;

 private:
  struct Pending {
    bool under_way = false;
    std::uint32_t run = 0;
  };
  Variant variant_;
  Subscription subscription_;
  std::vector<Pending> pending_;
  std::vector<std::uint16_t> sequence_;
  std::vector<std::uint32_t> incarnation_;
  std::vector<Member> members_;
};

/// A group that has been started by its master.
inline Group started(Variant variant, std::size_t slaves) {
  Group group(variant, slaves);
  EXPECT_EQ(group.call(0, program::Method::Start).status, program::StatusCode::Good);
  group.rounds(4);
  EXPECT_TRUE(group.all_in(PublishedState::Running)) << group.describe();
  EXPECT_TRUE(group.observer.violations().empty()) << group.describe();
  group.drain_journal();
  return group;
}

}  // namespace takt::handshake
