// SPDX-License-Identifier: Apache-2.0
// A group of equal slaves in parts: the master, and for each slave one part that holds all that is about it.
//
// A slave's part has the slave itself, what the master knows of it, what may stand in the registers between both, and
// what an observer has seen of it. So a group is its master and a multiset of slaves' parts. All steps are taken by the
// handshake's own code: the master's with the slave that it is about and, for all others, with stand-ins that are all
// Ready, all Running, or neither. That this is enough, and why slaves need no names, is argued in parts/README.md.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "explore/model/action.hpp"
#include "explore/model/hash_index.hpp"
#include "explore/model/members.hpp"
#include "explore/model/query.hpp"
#include "explore/model/state.hpp"
#include "explore/parts/said.hpp"
#include "explore/parts/seen.hpp"
#include "explore/properties/property.hpp"

namespace takt::explore {

using MasterId = std::uint32_t;
using SlaveId = std::uint32_t;
/// All that the master keeps of one slave.
using Known = Participant::PeerPart;

/// What the master knows of all slaves but the one that a step is about.
struct Others {
  bool are_ready = true;  ///< all, in the run that is being started
  bool are_running = true;
  /// Both only if there are none.
  bool none() const { return are_ready && are_running; }
  constexpr bool operator==(const Others&) const = default;
};

/// What a step makes of the master and the slave that it is about.
struct Outcome {
  MasterId master = 0;
  SlaveId slave = 0;       ///< unused where the step is about no slave
  PropertySet properties;  ///< violated or reached, as far as these two show it
  std::uint32_t running_in =
      0;  ///< somebody has become Running in this run (0: nobody), so S1 asks whether all were Ready in it
  bool master_runs = false;  ///< the master has, so S2 asks whether all slaves were Running in it
  constexpr bool operator==(const Outcome&) const = default;
};

class Parts {
 public:
  /// What the searches ask most about a participant.
  struct Traits {
    WordId word = no_word;
    handshake::PublishedState state = handshake::PublishedState::Halted;
    bool down = false;
    std::uint8_t calls = 0;  ///< methods that it accepts, by index
  };
  struct Slave {
    MemberId member = 0;
    std::uint32_t known = 0;
    std::uint32_t seen = 0;
    std::uint32_t up = 0;       ///< what the master may hear of it
    std::uint32_t down = 0;     ///< what it may hear of the master
    Late late = Late::none;     ///< a delayed copy is under way
    bool late_is_down = false;  ///< from the master
    WordId late_word = no_word;
    constexpr bool operator==(const Slave&) const = default;
  };

  explicit Parts(const Query& query);

  MasterId master_switched_on();
  SlaveId slave_switched_on();

  /// A step of the slave, of the master about it, or on the registers between them. The action is one of a group with
  /// this slave alone (participants 0 and 1, channel 0 up and 1 down); of `receive`, `duplicate` and `reorder` it says
  /// how many newer words there are. Nothing if it is not possible or changes nothing. More than one only if the
  /// handshake does not treat slaves alike. Valid until the next call.
  std::span<const Outcome> with_slave(MasterId master, SlaveId slave, Action action, Others others);
  /// A step of the master that is about no slave; `all`: what it knows of all of them.
  std::span<const Outcome> alone(MasterId master, Action action, Others all);
  /// The part of a slave that a step of the master was not about.
  SlaveId after(MasterId before, MasterId now, SlaveId slave);

  const Traits& of_master(MasterId master) const { return traits_[masters_[master].member]; }
  const Traits& of_slave(SlaveId slave) const { return traits_[slaves_[slave].member]; }
  const Participant& master_value(MasterId master) const { return values_[masters_[master].member].participant; }
  const Participant& slave_value(SlaveId slave) const { return values_[slaves_[slave].member].participant; }
  const Slave& slave(SlaveId slave) const { return slaves_[slave]; }
  const Known& known(SlaveId slave) const { return known_[slaves_[slave].known]; }
  const Said& up(SlaveId slave) const { return said_[slaves_[slave].up]; }
  const Said& down(SlaveId slave) const { return said_[slaves_[slave].down]; }
  const Seen& seen_of_master(MasterId master) const { return seen_[masters_[master].seen]; }
  const Seen& seen_of_slave(SlaveId slave) const { return seen_[slaves_[slave].seen]; }
  const handshake::Word& word(WordId word) const { return words_[word]; }

  /// The part with nothing in its registers, and one whose registers may hold what those of either may hold (of parts
  /// that are the same else).
  SlaveId bare(SlaveId slave);
  SlaveId joined(SlaveId a, SlaveId b, bool master_is_up);

  /// These two are where the group has to come: in one state, the one that their intent names; where one of them is
  /// down the other one is Halted.
  bool are_settled(MasterId master, SlaveId slave) const;
  /// By itself nothing changes any more at these two. (In the end each register holds what its sender says now.)
  bool are_at_rest(MasterId master, SlaveId slave, Others others);

  std::size_t values() const { return values_.size(); }
  std::size_t words() const { return words_.size() - 1; }
  std::size_t slaves() const { return slaves_.size(); }
  /// The longest list of words that may stand in a register.
  std::size_t longest_said() const { return longest_said_; }
  /// What was found is true of all groups.
  bool are_sound() const { return are_alike_ && !names_matter_; }
  /// Each step so far was the same at each place among the peers, and with one or two others.
  bool are_alike() const { return are_alike_; }
  /// No step so far had to compare two intents of slaves that differ in their run alone: then their names would decide.
  bool names_matter() const { return names_matter_; }
  /// Each network step so far took its participant forward: to a later intent, or further under the same one. So there
  /// are no cycles (parts/README.md, step 8).
  bool go_forward() const { return go_forward_; }

 private:
  struct Value {
    Participant participant;
    bool down = false;
    bool operator==(const Value&) const = default;
  };
  struct Master {
    MemberId member = 0;
    std::uint32_t seen = 0;
    constexpr bool operator==(const Master&) const = default;
  };
  struct Key {
    std::uint64_t parts = 0;   ///< master and slave
    std::uint64_t action = 0;  ///< and others
    constexpr bool operator==(const Key&) const = default;
  };
  struct HashOf {
    std::size_t operator()(const Value& value) const { return mixed(value.participant.hash() + value.down); }
    std::size_t operator()(const Master& master) const {
      return mixed(std::uint64_t{master.member} << 32 | master.seen);
    }
    std::size_t operator()(const Key& key) const { return mixed(mixed(key.parts) ^ key.action); }
    std::size_t operator()(const Known& known) const;
    std::size_t operator()(const Slave& slave) const;
  };
  /// A step of the master, with what it knows of the slave.
  struct MasterStep {
    Participant after;
    Known known;
    Effect effect;
    bool operator==(const MasterStep&) const = default;
  };
  /// How a value of the master came of another one.
  struct Cause {
    Known known;
    handshake::Input input;
    bool has_slave = false;
  };

  template <class Take>
  std::span<const Outcome> remembered(Key key, Take&& take);
  void take(const Master& master, const Slave& slave, Action action, Others others);
  void take_alone(const Master& master, Action action, Others all);

  void hear_at_slave(const Master& master, Slave slave, std::size_t at);
  void hear_at_master(const Master& master, Slave slave, std::size_t at, Others others);
  void deliver_late(const Master& master, Slave slave, Others others);
  void keep_copy(const Master& master, Slave slave, bool is_down, std::size_t at, bool is_overtaken);
  void expire_at_slave(const Master& master, Slave slave, bool master_is_down);
  void expire_at_master(const Master& master, Slave slave, bool slave_is_down, Others others);
  void crash_slave(const Master& master, Slave slave);
  void restart_slave(const Master& master, Slave slave);
  void restart_master(const Master& master);

  /// Adds an outcome, unless it would change nothing.
  bool step_slave(const Master& master, Slave slave, const handshake::Input& input, bool changed = false);
  void step_master(const Master& master, const Slave* slave, const handshake::Input& input, Others others,
                   bool changed = false);
  void add(const Outcome& outcome);
  std::vector<MasterStep> master_steps(const Participant& master, const Known* known, const handshake::Input& input,
                                       Others others);
  void judge(Outcome& outcome, Seen::Step seen) const;
  void look_at_step(const handshake::Input& input, const Participant& before, const Participant& after);

  handshake::Input heard(WordId word, bool overtaken) const;
  MemberId intern(const Participant& participant, bool down);
  MemberId fresh(bool is_master, std::uint32_t incarnation) {
    return intern(Participant(config(is_master, incarnation)), false);
  }
  MemberId down(const Participant& participant);
  handshake::Config config(bool is_master, std::uint32_t incarnation) const;
  MasterId intern_master(const Master& master) { return masters_.intern(master); }
  void append(std::uint32_t& said, WordId word);
  void hold(std::uint32_t& said, std::size_t at, bool sender_is_up);

  Interner<Value, HashOf> values_;
  std::vector<Traits> traits_;
  struct HashOfWordHere {
    std::size_t operator()(const handshake::Word& word) const { return HashOfWord{}(word); }
  };
  Interner<handshake::Word, HashOfWordHere> words_;
  Interner<Known, HashOf> known_;
  Interner<Seen, HashOfSeen> seen_;
  Interner<Said, HashOfSaid> said_;
  Interner<Master, HashOf> masters_;
  Interner<Slave, HashOf> slaves_;
  Interner<Key, HashOf> steps_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> outcomes_of_;  ///< by step: the first outcome, and how many
  std::vector<Outcome> outcomes_;
  Memo cause_of_;  ///< of two members, the latter came of the former
  std::vector<Cause> causes_;
  Interner<Key, HashOf> afters_;
  std::vector<SlaveId> after_;
  std::vector<Outcome> made_;  ///< by the step that is being taken
  std::size_t longest_said_ = 1;
  bool are_alike_ = true;
  bool names_matter_ = false;
  bool go_forward_ = true;
};

/// Who is where in a group with so many slaves, as in Wiring: an action of the group as one of a group with one slave.
struct PartAction {
  std::size_t slave = 0;  ///< 1 and on; 0: it is about none
  Action action;
};
PartAction part_action(Action action, std::size_t slaves);

}  // namespace takt::explore
