// SPDX-License-Identifier: Apache-2.0
// The steps of participants, taken by the handshake: a slave's own, the master's with stand-ins for all other slaves.
#include <algorithm>
#include <array>

#include "explore/parts/parts.hpp"

namespace takt::explore {

using handshake::Input;
using handshake::Outputs;
using handshake::PublishedState;
using handshake::Standing;

namespace {

/// One who stands for all others. Only what the master counts of it is looked at.
Known stand_in(const Participant& master, Others others) {
  Known known;
  known.peer = {1, 0, usual_sequence, PublishedState::Halted, true, true};
  if (others.are_ready) known.peer.state = PublishedState::Ready;
  if (others.are_running) known.peer.state = PublishedState::Running;
  if (others.are_ready || others.are_running) known.peer.run = master.intent().run;
  known.ready = others.are_ready;
  known.running = others.are_running;
  return known;
}

/// How far a participant has come under its intent. Only a start has more than one place on its way.
std::size_t progress_of(const Participant& participant) {
  const bool in_run = participant.run() == participant.intent().run;
  switch (participant.state()) {
    case PublishedState::Halted:
      return 0;
    case PublishedState::HaltedInit:
      return participant.waits_initialised() ? 2 : 1;
    case PublishedState::Ready:
      return in_run ? 4 : 3;
    case PublishedState::Running:
    case PublishedState::Suspended:
      break;
  }
  return 5;
}

}  // namespace

void Parts::judge(Outcome& outcome, Seen::Step seen) const {
  outcome.running_in = seen.running_in;
  if (seen.without_init) outcome.properties.insert(Property::S4);
}

/// What steps 4 and 8 of README.md rest on.
void Parts::look_at_step(const Input& input, const Participant& before, const Participant& after) {
  const handshake::Intent& intent = input.word.intent;
  if (input.kind == Input::Kind::received && intent.number == before.intent().number &&
      intent.kind == before.intent().kind && intent.origin == before.intent().origin && intent.origin != 0 &&
      intent.run != before.intent().run)
    names_matter_ = true;
  if (input.kind == Input::Kind::command || input.kind == Input::Kind::finished) return;
  const Standing standing = standing_of(after.intent(), before.intent());
  const bool has_way = after.intent().kind == handshake::IntentKind::Start;
  const bool stays = after.state() == before.state() && after.run() == before.run();
  const bool is_same = standing == Standing::same && (has_way ? progress_of(after) >= progress_of(before) : stays);
  if (!is_same && standing != Standing::later) go_forward_ = false;
}

bool Parts::step_slave(const Master& master, Slave slave, const Input& input, bool changed) {
  const MemberId member = slave.member;
  const Participant before = values_[member].participant;
  Participant after = before;
  const Outputs outputs = after.step(input);
  after.forget_last_transition();
  const Effect effect = effect_of(before.word(), after.word(), outputs);
  look_at_step(input, before, after);
  Outcome outcome;
  outcome.properties = effect.properties;
  outcome.properties.bits |= judged(input, outputs, before.state(), after).bits;
  slave.member = intern(after, false);
  if (traits_[slave.member].word != traits_[member].word) append(slave.up, traits_[slave.member].word);
  Seen seen = seen_[slave.seen];
  judge(outcome, seen.take(effect));
  slave.seen = seen_.intern(seen);
  if (slave.member == member && !changed && outcome.properties.bits == 0) return false;
  outcome.master = intern_master(master);
  outcome.slave = slaves_.intern(slave);
  add(outcome);
  return true;
}

/// With others at each place beside the slave that the step is about.
auto Parts::master_steps(const Participant& master, const Known* known, const Input& input, Others others)
    -> std::vector<MasterStep> {
  const Known other = stand_in(master, others);
  std::vector<MasterStep> all;
  const auto take = [&](std::size_t count, std::size_t place) {
    std::array<Known, 3> parts{other, other, other};
    if (known != nullptr) parts[place] = *known;
    const Participant before = master.with_parts(std::span(parts.data(), count));
    Participant after = before;
    Input placed = input;
    placed.peer = static_cast<std::uint8_t>(place);
    const Outputs outputs = after.step(placed);
    after.forget_last_transition();
    MasterStep step{after.with_parts(std::array{Known{}}), known == nullptr ? Known{} : after.part_of(place),
                    effect_of(before.word(), after.word(), outputs)};
    step.effect.properties.bits |= judged(placed, outputs, before.state(), after).bits;
    if (std::find(all.begin(), all.end(), step) == all.end()) all.push_back(step);
  };
  if (known != nullptr && others.none()) {
    take(1, 0);
    return all;
  }
  for (std::size_t count = known == nullptr ? 1 : 2; count <= 3; ++count)
    for (std::size_t place = 0; place < (known == nullptr ? 1 : count); ++place) take(count, place);
  if (all.size() > 1) are_alike_ = false;
  return all;
}

void Parts::step_master(const Master& master, const Slave* slave, const Input& input, Others others, bool changed) {
  const MemberId member = master.member;
  const Participant before = values_[member].participant;
  const Known known = slave == nullptr ? Known{} : known_[slave->known];
  for (const MasterStep& step : master_steps(before, slave == nullptr ? nullptr : &known, input, others)) {
    look_at_step(input, before, step.after);
    Outcome outcome;
    outcome.properties = step.effect.properties;
    Master now{intern(step.after, false), 0};
    Seen seen = seen_[master.seen];
    judge(outcome, seen.take(step.effect));
    outcome.master_runs = outcome.running_in != 0;
    now.seen = seen_.intern(seen);
    if (now.member == member && step.known == known && !changed && outcome.properties.bits == 0) continue;
    outcome.master = intern_master(now);
    const std::uint64_t way = std::uint64_t{member} << 32 | now.member;
    if (cause_of_.find(way) == Memo::absent) {
      cause_of_.insert(way, causes_.size());
      causes_.push_back({known, input, slave != nullptr});
    }
    if (slave != nullptr) {
      Slave part = *slave;
      part.known = known_.intern(step.known);
      if (traits_[now.member].word != traits_[member].word) append(part.down, traits_[now.member].word);
      outcome.slave = slaves_.intern(part);
    }
    add(outcome);
  }
}

SlaveId Parts::after(MasterId before, MasterId now, SlaveId slave) {
  const MemberId from = masters_[before].member;
  const MemberId to = masters_[now].member;
  if (from == to) return slave;
  const std::uint32_t key = afters_.intern({std::uint64_t{from} << 32 | to, slave});
  if (key < after_.size()) return after_[key];
  Slave part = slaves_[slave];
  const std::uint64_t cause = cause_of_.find(std::uint64_t{from} << 32 | to);
  if (cause == Memo::absent) {
    part.known = 0;  // a crash or a restart
  } else {
    // The handshake itself says what becomes of the others.
    const Cause& how = causes_[cause];
    const std::array<Known, 2> parts{how.known, known_[part.known]};
    const std::size_t place = how.has_slave ? 1 : 0;
    Participant master = values_[from].participant.with_parts(std::span(parts).subspan(1 - place));
    master.step(how.input);
    part.known = known_.intern(master.part_of(place));
  }
  if (!traits_[to].down && (traits_[from].word != traits_[to].word || traits_[from].down))
    append(part.down, traits_[to].word);
  const SlaveId result = slaves_.intern(part);
  after_.push_back(result);
  return result;
}

}  // namespace takt::explore
