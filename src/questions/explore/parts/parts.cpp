// SPDX-License-Identifier: Apache-2.0
#include "explore/parts/parts.hpp"

#include <algorithm>
#include <array>

#include "explore/model/wiring.hpp"
#include "sim/check.hpp"

namespace takt::explore {

using handshake::Input;
using handshake::PublishedState;
using handshake::Role;
using handshake::Word;

namespace {

/// Slaves have no names: each is the first one, and so is the origin of what it raises.
constexpr std::uint8_t any_slave = 1;

}  // namespace

std::size_t Parts::HashOf::operator()(const Known& known) const {
  const Participant::Peer& peer = known.peer;
  const std::uint64_t flags = std::uint64_t{peer.heard} | std::uint64_t{peer.sequence_known} << 1 |
                              std::uint64_t{known.ready} << 2 | std::uint64_t{known.running} << 3;
  return mixed(mixed(std::uint64_t{peer.incarnation} << 32 | peer.run) ^
               (std::uint64_t{peer.sequence} << 16 | handshake::index_of(peer.state) << 8 | flags));
}

std::size_t Parts::HashOf::operator()(const Slave& slave) const {
  std::uint64_t digest = mixed(std::uint64_t{slave.member} << 32 | slave.known);
  digest = mixed(digest ^ (std::uint64_t{slave.seen} << 32 | slave.up));
  return mixed(digest ^ (std::uint64_t{slave.down} << 32 | static_cast<std::uint64_t>(slave.late) << 24 |
                         std::uint64_t{slave.late_is_down} << 16 | slave.late_word));
}

Parts::Parts(const Query& query) {
  TAKT_CHECK(query.variant == handshake::Variant::robust && query.subscription == handshake::Subscription::star,
             "parts are those of a star with robust");
  words_.append(Word{});  // no_word
  known_.intern(Known{});
  seen_.intern(Seen{});
  said_.intern(Said{});
}

handshake::Config Parts::config(bool is_master, std::uint32_t incarnation) const {
  return {handshake::Variant::robust,
          is_master ? Role::master : Role::slave,
          is_master ? std::uint8_t{0} : any_slave,
          1,
          incarnation,
          handshake::Subscription::star};
}

MasterId Parts::master_switched_on() { return intern_master({fresh(true, 1), 0}); }

SlaveId Parts::slave_switched_on() {
  Slave slave;
  slave.member = fresh(false, 1);
  append(slave.up, traits_[slave.member].word);
  append(slave.down, traits_[fresh(true, 1)].word);
  return slaves_.intern(slave);
}

MemberId Parts::intern(const Participant& participant, bool down) {
  const MemberId member = values_.intern({participant, down});
  if (member < traits_.size()) return member;
  Traits traits;
  traits.word = static_cast<WordId>(words_.intern(participant.word()));
  TAKT_CHECK(words_.size() <= 0x10000, "an exploration has at most 65535 different words: allow fewer calls or faults");
  traits.state = participant.state();
  traits.down = down;
  for (const program::MethodInfo& method : program::methods) {
    if (down || (method.method == program::Method::Start && participant.config().role != Role::master)) continue;
    Participant tried = participant;
    if (program::is_good(tried.step(Input::command(method.method)).status))
      traits.calls = static_cast<std::uint8_t>(traits.calls | 1U << program::index_of(method.method));
  }
  traits_.push_back(traits);
  return member;
}

/// It remembers only how often it was up.
MemberId Parts::down(const Participant& participant) {
  return intern(Participant(config(participant.config().role == Role::master, participant.config().incarnation)), true);
}

void Parts::append(std::uint32_t& said, WordId word) {
  Said all = said_[said];
  all.append(word);
  longest_said_ = std::max(longest_said_, all.size());
  said = said_.intern(all);
}

void Parts::hold(std::uint32_t& said, std::size_t at, bool sender_is_up) {
  Said all = said_[said];
  all.hold(at, sender_is_up);
  said = said_.intern(all);
}

Input Parts::heard(WordId word, bool overtaken) const {
  return Input::received(0, words_[word], overtaken ? overtaken_sequence : usual_sequence);
}

template <class Take>
std::span<const Outcome> Parts::remembered(Key key, Take&& take) {
  const std::uint32_t step = steps_.intern(key);
  if (step == outcomes_of_.size()) {
    made_.clear();
    take();
    outcomes_of_.emplace_back(static_cast<std::uint32_t>(outcomes_.size()), static_cast<std::uint32_t>(made_.size()));
    outcomes_.insert(outcomes_.end(), made_.begin(), made_.end());
  }
  const auto [first, count] = outcomes_of_[step];
  return {outcomes_.data() + first, count};
}

std::span<const Outcome> Parts::with_slave(MasterId master, SlaveId slave, Action action, Others others) {
  const std::uint64_t packed = static_cast<std::uint64_t>(action.kind) << 40 | std::uint64_t{action.who} << 32 |
                               std::uint64_t{action.what} << 8 | std::uint64_t{others.are_ready} << 1 |
                               std::uint64_t{others.are_running};
  return remembered({std::uint64_t{master} << 32 | slave, packed},
                    [&] { take(masters_[master], slaves_[slave], action, others); });
}

std::span<const Outcome> Parts::alone(MasterId master, Action action, Others all) {
  const std::uint64_t packed = std::uint64_t{1} << 63 | static_cast<std::uint64_t>(action.kind) << 40 |
                               std::uint64_t{action.what} << 8 | std::uint64_t{all.are_ready} << 1 |
                               std::uint64_t{all.are_running};
  return remembered({std::uint64_t{master} << 32, packed}, [&] { take_alone(masters_[master], action, all); });
}

/// The parts are copied: a step may make new ones, and the tables move.
void Parts::take(const Master& the_master, const Slave& the_slave, Action action, Others others) {
  const Master master = the_master;
  const Slave slave = the_slave;
  const Traits& self = traits_[slave.member];
  const bool master_is_up = !traits_[master.member].down;
  const bool is_down = action.who == 1;  // of channels: from the master to the slave
  const std::size_t count = said_[is_down ? slave.down : slave.up].size();
  const bool has_word = action.what < count;
  const std::size_t at = has_word ? count - 1 - action.what : 0;
  const bool sender_is_up = is_down ? master_is_up : !self.down;
  switch (action.kind) {
    case ActionKind::receive:
      if (!has_word || (is_down ? self.down : !master_is_up)) return;
      is_down ? hear_at_slave(master, slave, at) : hear_at_master(master, slave, at, others);
      return;
    case ActionKind::deliver_late:
      if (slave.late != Late::none) deliver_late(master, slave, others);
      return;
    case ActionKind::initialised:
      if (!self.down && self.state == PublishedState::HaltedInit)
        step_slave(master, slave, Input::initialised(values_[slave.member].participant.intent().run));
      return;
    case ActionKind::silence:
    case ActionKind::timeout: {
      const bool expects_down = action.kind == ActionKind::silence;
      const bool notices_slave = action.who == 0;
      const bool is_possible =
          notices_slave ? master_is_up && self.down == expects_down : !self.down && master_is_up != expects_down;
      if (!is_possible) return;
      notices_slave ? expire_at_master(master, slave, expects_down, others)
                    : expire_at_slave(master, slave, expects_down);
      return;
    }
    case ActionKind::call:
      if (((self.calls >> action.what) & 1U) != 0)
        step_slave(master, slave, Input::command(program::methods[action.what].method), true);
      return;
    case ActionKind::finish:
      if (!self.down && self.state == PublishedState::Running) step_slave(master, slave, Input::finished(), true);
      return;
    case ActionKind::crash:
      if (!self.down) crash_slave(master, slave);
      return;
    case ActionKind::restart:
      restart_slave(master, slave);
      return;
    case ActionKind::duplicate:
      if (has_word && slave.late == Late::none) keep_copy(master, slave, is_down, at, false);
      return;
    case ActionKind::reorder:
      if (has_word && slave.late == Late::none && sender_is_up && action.what != 0)
        keep_copy(master, slave, is_down, at, true);
      return;
    default:
      return;
  }
}

void Parts::take_alone(const Master& the_master, Action action, Others all) {
  const Master master = the_master;
  const Traits& self = traits_[master.member];
  const Participant value = values_[master.member].participant;
  switch (action.kind) {
    case ActionKind::initialised:
      if (!self.down && self.state == PublishedState::HaltedInit)
        step_master(master, nullptr, Input::initialised(value.intent().run), all);
      return;
    case ActionKind::call:
      if (((self.calls >> action.what) & 1U) != 0)
        step_master(master, nullptr, Input::command(program::methods[action.what].method), all, true);
      return;
    case ActionKind::finish:
      if (!self.down && self.state == PublishedState::Running)
        step_master(master, nullptr, Input::finished(), all, true);
      return;
    case ActionKind::crash:
      if (!self.down) add({intern_master({down(value), master.seen}), 0, {}, 0, false});
      return;
    case ActionKind::restart:
      restart_master(master);
      return;
    default:
      return;
  }
}

/// A word that changes nothing at its hearer leaves the register as it was: then more may still be heard, never less.
void Parts::hear_at_slave(const Master& master, Slave slave, std::size_t at) {
  const WordId word = said_[slave.down][at];
  const bool overtakes = slave.late_is_down && (slave.late == Late::newer_sent || (slave.late == Late::same && at > 0));
  hold(slave.down, at, !traits_[master.member].down);
  if (overtakes) slave.late = Late::overtaken;
  step_slave(master, slave, heard(word, false), overtakes);
}

void Parts::hear_at_master(const Master& master, Slave slave, std::size_t at, Others others) {
  const WordId word = said_[slave.up][at];
  const bool overtakes =
      !slave.late_is_down && (slave.late == Late::newer_sent || (slave.late == Late::same && at > 0));
  hold(slave.up, at, !traits_[slave.member].down);
  if (overtakes) slave.late = Late::overtaken;
  step_master(master, &slave, heard(word, false), others, overtakes);
}

void Parts::deliver_late(const Master& master, Slave slave, Others others) {
  const bool is_down = slave.late_is_down;
  const bool receiver_is_up = is_down ? !traits_[slave.member].down : !traits_[master.member].down;
  const Input input = heard(slave.late_word, slave.late == Late::overtaken);
  slave.late = Late::none;
  slave.late_is_down = false;
  slave.late_word = no_word;
  if (!receiver_is_up)
    add({intern_master(master), slaves_.intern(slave), {}, 0, false});
  else if (is_down)
    step_slave(master, slave, input, true);
  else
    step_master(master, &slave, input, others, true);
}

/// What stands in the register stays, and a copy of it comes at any later time; if it is overtaken, the sender
/// publishes at once.
void Parts::keep_copy(const Master& master, Slave slave, bool is_down, std::size_t at, bool is_overtaken) {
  std::uint32_t& said = is_down ? slave.down : slave.up;
  const bool sender_is_up = is_down ? !traits_[master.member].down : !traits_[slave.member].down;
  slave.late = is_overtaken ? Late::newer_sent : Late::same;
  slave.late_is_down = is_down;
  slave.late_word = said_[said][at];
  hold(said, is_overtaken ? said_[said].size() - 1 : at, sender_is_up);
  add({intern_master(master), slaves_.intern(slave), {}, 0, false});
}

void Parts::expire_at_slave(const Master& master, Slave slave, bool master_is_down) {
  const bool forgets = master_is_down && said_[slave.down].size() != 0;
  if (master_is_down) slave.down = said_.intern(Said{});
  if (forgets && slave.late == Late::same && slave.late_is_down) slave.late = Late::newer_sent;
  step_slave(master, slave, Input::peer_silent(0), forgets);
}

void Parts::expire_at_master(const Master& master, Slave slave, bool slave_is_down, Others others) {
  const bool forgets = slave_is_down && said_[slave.up].size() != 0;
  if (slave_is_down) slave.up = said_.intern(Said{});
  if (forgets && slave.late == Late::same && !slave.late_is_down) slave.late = Late::newer_sent;
  step_master(master, &slave, Input::peer_silent(0), others, forgets);
}

void Parts::crash_slave(const Master& master, Slave slave) {
  slave.member = down(values_[slave.member].participant);
  add({intern_master(master), slaves_.intern(slave), {}, 0, false});
}

void Parts::restart_slave(const Master& master, Slave slave) {
  slave.member = fresh(false, values_[slave.member].participant.config().incarnation + 1);
  Seen seen = seen_[slave.seen];
  seen.restart();
  slave.seen = seen_.intern(seen);
  append(slave.up, traits_[slave.member].word);
  add({intern_master(master), slaves_.intern(slave), {}, 0, false});
}

void Parts::restart_master(const Master& master) {
  Master now = master;
  now.member = fresh(true, values_[master.member].participant.config().incarnation + 1);
  Seen seen = seen_[master.seen];
  seen.restart();
  now.seen = seen_.intern(seen);
  add({intern_master(now), 0, {}, 0, false});
}

void Parts::add(const Outcome& outcome) {
  if (std::find(made_.begin(), made_.end(), outcome) == made_.end()) made_.push_back(outcome);
}

SlaveId Parts::bare(SlaveId slave) {
  Slave part = slaves_[slave];
  part.up = part.down = 0;
  return slaves_.intern(part);
}

SlaveId Parts::joined(SlaveId a, SlaveId b, bool master_is_up) {
  Slave part = slaves_[a];
  const Slave other = slaves_[b];
  Said up = said_[part.up];
  Said down = said_[part.down];
  const bool keeps_first = part.late == Late::same;  // that is the word of which a copy is under way
  up.join(said_[other.up], !traits_[part.member].down, keeps_first && !part.late_is_down);
  down.join(said_[other.down], master_is_up, keeps_first && part.late_is_down);
  longest_said_ = std::max({longest_said_, up.size(), down.size()});
  part.up = said_.intern(up);
  part.down = said_.intern(down);
  return slaves_.intern(part);
}

bool Parts::are_settled(MasterId master_id, SlaveId slave_id) const {
  const Traits& master = of_master(master_id);
  const Traits& slave = of_slave(slave_id);
  if (master.down || slave.down)
    return (master.down || master.state == PublishedState::Halted) &&
           (slave.down || slave.state == PublishedState::Halted);
  const Word& said = words_[master.word];
  return master.state == slave.state && said.intent == words_[slave.word].intent &&
         master.state == handshake::goal_of(said.intent.kind);
}

bool Parts::are_at_rest(MasterId master, SlaveId slave, Others others) {
  // What one who is down has said may be lost.
  Slave part = slaves_[slave];
  if (of_slave(slave).down) part.up = 0;
  if (of_master(master).down) part.down = 0;
  slave = slaves_.intern(part);
  for (const std::uint8_t who : {std::uint8_t{0}, std::uint8_t{1}})
    for (const ActionKind kind :
         {ActionKind::receive, ActionKind::silence, ActionKind::deliver_late, ActionKind::initialised})
      for (const Outcome& each : with_slave(master, slave, {kind, who, 0}, others))
        if (each.master != master || each.slave != slave) return false;
  const Others all{others.are_ready && known(slave).ready, others.are_running && known(slave).running};
  return alone(master, {ActionKind::initialised, 0, 0}, all).empty();
}

PartAction part_action(Action action, std::size_t slaves) {
  const auto of = [](std::size_t slave, Action of_pair, std::uint8_t who, std::uint16_t what) {
    of_pair.who = who;
    of_pair.what = what;
    return PartAction{slave, of_pair};
  };
  switch (action.kind) {
    case ActionKind::receive:
    case ActionKind::duplicate:
    case ActionKind::reorder:
      return action.who < slaves ? of(action.who + 1U, action, 0, action.what)
                                 : of(action.who - slaves + 1, action, 1, action.what);
    case ActionKind::silence:
    case ActionKind::timeout:
      return action.who == 0 ? of(action.what + 1U, action, 0, 0) : of(action.who, action, 1, 0);
    default:
      return of(action.who, action, action.who == 0 ? 0 : 1, action.what);
  }
}

}  // namespace takt::explore
