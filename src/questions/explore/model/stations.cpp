// SPDX-License-Identifier: Apache-2.0
#include "explore/model/stations.hpp"

#include <algorithm>

#include "sim/check.hpp"

namespace takt::explore {

using handshake::Announcement;
using handshake::Binder;
using handshake::Candidate;
using handshake::Input;
using handshake::Outputs;
using handshake::PublishedState;
using handshake::Side;
using handshake::SkillId;
using handshake::Word;

namespace {

std::uint64_t mixed_in(std::uint64_t digest, std::uint64_t value) {
  return mixed(digest ^ value) * 0x9E3779B97F4A7C15ULL;
}
std::uint64_t number_of(const Binding& binding) { return std::uint64_t{binding.candidate} << 32 | binding.life; }

/// Takes a step of a participant and shows it. `outside`: the same node in the outer group, of the master of an inner
/// one.
Outputs take(Participant& participant, const Input& input, const Binding& self, RoleEvents& events,
             bool is_outer = false, const Participant* outside = nullptr) {
  const Word before = participant.word();
  const Outputs outputs = participant.step(input);
  participant.forget_last_transition();
  RoleEvent event;
  event.participant = participant.config().index;
  event.is_outer = is_outer;
  event.effect = effect_of(before, participant.word(), outputs);
  if (outside != nullptr && outputs.raised && outputs.raised_kind == handshake::IntentKind::Start) {
    event.effect.started_run = participant.intent().run;
    event.effect.outer_run = outside->intent().run;
  }
  event.self = self;
  event.after = participant.state();
  events.properties.bits |= event.effect.properties.bits;
  event.effect.properties = {};
  events.properties.bits |= judged(input, outputs, before.state, participant).bits;
  if (event.effect != Effect{}) events.each.push_back(event);
  return outputs;
}

Input input_of(Happens what, std::size_t which, const Participant& participant) {
  if (what == Happens::call) return Input::command(program::methods[which].method);
  return what == Happens::initialised ? Input::initialised(participant.intent().run) : Input::finished();
}

}  // namespace

template <>
std::size_t Stations::Hash<Stations::Master>::operator()(const Master& value) const {
  const std::uint64_t digest =
      mixed_in(value.participant.hash(), std::uint64_t{value.binder} << 1 | (value.down ? 1 : 0));
  return value.outer ? mixed_in(mixed_in(digest, value.outer->hash()), value.coupling.hash()) : digest;
}
template <>
std::size_t Stations::Hash<Stations::Outsider>::operator()(const Outsider& value) const {
  return mixed_in(value.participant.hash(), value.down ? 1 : 0);
}
template <>
std::size_t Stations::Hash<Binder>::operator()(const Binder& value) const {
  std::uint64_t digest = value.complete() ? 1 : 0;
  for (const Binding& binding : value.bindings()) digest = mixed_in(digest, number_of(binding));
  for (std::uint8_t c = 0; c < value.candidates(); ++c)
    digest = mixed_in(digest, std::uint64_t{value.used_life(c)} << 1 | (value.present(c) ? 1 : 0));
  return digest;
}
template <>
std::size_t Stations::Hash<Stations::Node>::operator()(const Node& value) const {
  const Candidate& candidate = value.candidate;
  return mixed_in(value.member ? value.member->hash() : 0,
                  std::uint64_t{candidate.announcement().life} << 16 | std::uint64_t{value.number} << 8 |
                      (candidate.announces() ? 4U : 0U) | (candidate.announcement().leaving ? 2U : 0U) |
                      (value.down ? 1U : 0U));
}
template <>
std::size_t Stations::Hash<Notice>::operator()(const Notice& value) const {
  std::uint64_t digest = mixed_in(HashOfWord{}(value.word), static_cast<std::uint64_t>(value.kind) << 8 | value.role);
  digest = mixed_in(digest, std::uint64_t{value.announcement.life} << 1 | (value.announcement.leaving ? 1 : 0));
  for (const SkillId skill : value.announcement.skills) digest = mixed_in(digest, skill);
  for (const Binding& binding : value.bindings) digest = mixed_in(digest, number_of(binding));
  for (const std::uint32_t life : value.used_lives) digest = mixed_in(digest, life);
  return digest;
}
template <>
std::size_t Stations::Hash<RoleEvents>::operator()(const RoleEvents& value) const {
  std::uint64_t digest = std::uint64_t{value.properties.bits} << 1 | (value.refused ? 1 : 0);
  for (const RoleEvent& each : value.each) {
    digest = mixed_in(digest, HashOfEffect{}(each.effect));
    digest = mixed_in(digest, number_of(each.self) << 16 | static_cast<std::uint64_t>(each.kind) << 12 |
                                  static_cast<std::uint64_t>(each.participant) << 8 | (each.is_outer ? 1U << 7 : 0U) |
                                  handshake::index_of(each.after));
  }
  return digest;
}

Stations::Stations(const Query& query) : query_(query) {
  for (std::uint32_t role = 0; role < query.roles(); ++role) skills_.push_back(role + 1);
  notices_.intern(Notice{});  // nothing
  events_.intern(RoleEvents{});
}

/// Of a single group the inner side.
handshake::Config Stations::config(std::size_t index, std::uint32_t incarnation, Side side) const {
  const bool is_nested = query_.nested() && index == (side == Side::inner ? 0 : query_.slaves);
  return {handshake::Variant::robust,
          index == 0 ? handshake::Role::master : handshake::Role::slave,
          static_cast<std::uint8_t>(index),
          side == Side::inner ? query_.roles() : query_.slaves,
          incarnation,
          handshake::Subscription::star,
          is_nested};
}

StationId Stations::master(std::uint32_t incarnation, bool down) {
  Master master{Participant(config(0, incarnation)),
                binders_.intern(Binder(skills_, query_.candidates, query_.starts_again)),
                down,
                std::nullopt,
                {}};
  if (query_.nested()) master.outer.emplace(config(query_.slaves, incarnation, Side::outer));
  return masters_.intern(master);
}

StationId Stations::candidate(std::size_t number, std::uint32_t life, bool joined, bool down) {
  std::vector<SkillId> offered;
  for (std::size_t role = 0; role < skills_.size(); ++role)
    if (((query_.offers[number] >> role) & 1U) != 0) offered.push_back(skills_[role]);
  const auto index = static_cast<std::uint8_t>(number);
  Node node{index, Candidate(index, life, offered), std::nullopt, down};
  if (joined) node.candidate.join();
  return nodes_.intern(node);
}

auto Stations::step(StationId id, std::uint64_t kind, Happens what, std::size_t which, NoticeId notice) -> Stepped {
  TAKT_CHECK(id < 1U << 28 && notice < 1U << 20 && which < 16, "a step is one of few");
  const std::uint64_t key =
      kind | std::uint64_t{id} << 32 | static_cast<std::uint64_t>(what) << 24 | std::uint64_t{which} << 20 | notice;
  std::uint64_t found = steps_.find(key);
  if (found == Memo::absent) {
    RoleEvents events;
    const Notice heard = notices_[notice];
    const auto stepped = kind == 0              ? &Stations::stepped_master
                         : kind == from_nodes   ? &Stations::stepped_node
                         : kind == from_outside ? &Stations::stepped_outside
                                                : &Stations::stepped_outsider;
    const StationId station = (this->*stepped)(id, what, which, heard, events);
    found = std::uint64_t{station} | std::uint64_t{events_.intern(events)} << 32;
    steps_.insert(key, found);
  }
  return {static_cast<StationId>(found), static_cast<std::uint32_t>(found >> 32)};
}

/// As a ProgramNode does at the master; received: `which` is the candidate who has sent it.
StationId Stations::stepped_master(StationId id, Happens what, std::size_t which, const Notice& notice,
                                   RoleEvents& events) {
  Master master = masters_[id];
  Binder binder = binders_[master.binder];
  const auto number = static_cast<std::uint8_t>(which);
  const auto step = [&](const Input& input) { return take(master.participant, input, {}, events); };
  if (master.outer && what == Happens::initialised) {
    master.coupling.initialised(Side::inner, master.participant.intent().run);
    return settled(master, binder, what, events);
  }
  switch (what) {
    case Happens::received:
      if (notice.kind == Notice::Kind::announcement) {
        binder.announced(number, notice.announcement);
      } else {
        const Binding& binding = binder.binding(notice.role);
        if (!binding.bound() || handshake::incarnation_of(binding.candidate, binding.life) != notice.word.incarnation)
          return id;
        if (binding.candidate != number) events.properties.insert(Property::B1);
        step(Input::received(notice.role, notice.word, usual_sequence));
      }
      break;
    case Happens::call: {
      binder.called();
      const bool waits = program::methods[which].method == program::Method::Start &&
                         master.participant.state() == PublishedState::Halted && !binder.complete();
      events.refused = waits || !program::is_good(step(input_of(what, which, master.participant)).status);
      break;
    }
    case Happens::role_silent:
      binder.role_silent(which);
      step(Input::peer_silent(which));
      break;
    case Happens::announcer_silent:
      binder.silent(number);
      break;
    default:
      step(input_of(what, which, master.participant));
      break;
  }
  return settled(master, binder, what, events);
}

StationId Stations::settled(Master& master, Binder& binder, Happens what, RoleEvents& events) {
  if (!events.refused) settle(master, binder, what, events);
  master.binder = binders_.intern(binder);
  return masters_.intern(master);
}

/// As a wire::Nesting does: the two groups first, then the roles, until nothing is left.
void Stations::settle(Master& master, Binder& binder, Happens what, RoleEvents& events) const {
  if (!master.outer) {
    stabilise_roles(master, binder, events);
    return;
  }
  do {
    while (const auto next =
               master.coupling.next(view_of(*master.outer), view_of(master.participant, binder.complete())))
      next->side == Side::outer ? take(*master.outer, next->input, {}, events, true)
                                : take(master.participant, next->input, {}, events, false, &*master.outer);
  } while (stabilise_roles(master, binder, events));
  TAKT_CHECK(handshake::in_step(master.outer->state(), master.participant.state()),
             "both groups of a node are in step");
  const bool is_silence = what == Happens::role_silent || what == Happens::master_silent;
  if (is_silence &&
      (master.outer->state() != PublishedState::Halted || master.participant.state() != PublishedState::Halted))
    events.properties.insert(Property::F1);
}

/// Roles change hands in Halted only, nobody has two, and whoever has one offers its skill. False if nothing is left.
bool Stations::stabilise_roles(Master& master, Binder& binder, RoleEvents& events) const {
  Participant& participant = master.participant;
  bool has_stepped = false;
  while (const auto input = binder.next(handshake::master_view_of(participant))) {
    if (input->kind == Input::Kind::peer_replaced) {
      RoleEvent event;
      event.kind = RoleEvent::Kind::bound;
      event.participant = static_cast<std::uint8_t>(input->peer + 1);
      event.self = binder.binding(input->peer);
      events.each.push_back(event);
      const bool is_wrong = participant.state() != PublishedState::Halted ||
                            (event.self.bound() && ((query_.offers[event.self.candidate] >> input->peer) & 1U) == 0);
      if (is_wrong || std::count_if(binder.bindings().begin(), binder.bindings().end(), [&](const Binding& each) {
                        return each.bound() && each.candidate == event.self.candidate;
                      }) > 1)
        events.properties.insert(Property::B1);
    }
    take(participant, *input, {}, events);
    has_stepped = true;
  }
  return has_stepped;
}

/// The master, as a slave of the outer group.
StationId Stations::stepped_outside(StationId id, Happens what, std::size_t which, const Notice& notice,
                                    RoleEvents& events) {
  Master master = masters_[id];
  Binder binder = binders_[master.binder];
  if (what == Happens::initialised) {
    master.coupling.initialised(Side::outer, master.outer->intent().run);
  } else {
    const Input input = what == Happens::received        ? Input::received(0, notice.word, usual_sequence)
                        : what == Happens::master_silent ? Input::peer_silent(0)
                                                         : input_of(what, which, *master.outer);
    events.refused = !program::is_good(take(*master.outer, input, {}, events, true).status);
  }
  return settled(master, binder, what, events);
}

/// `which` is the peer of whom it hears, or hears nothing.
StationId Stations::stepped_outsider(StationId id, Happens what, std::size_t which, const Notice& notice,
                                     RoleEvents& events) {
  Outsider outsider = outsiders_[id];
  const Input input = what == Happens::received      ? Input::received(which, notice.word, usual_sequence)
                      : what == Happens::peer_silent ? Input::peer_silent(which)
                                                     : input_of(what, which, outsider.participant);
  events.refused = !program::is_good(take(outsider.participant, input, {}, events, true).status);
  return outsiders_.intern(outsider);
}

/// As a ProgramNode does at a candidate.
StationId Stations::stepped_node(StationId id, Happens what, std::size_t which, const Notice& notice,
                                 RoleEvents& events) {
  Node node = nodes_[id];
  const Binding self{node.number, node.candidate.announcement().life};
  const bool is_table = what == Happens::received && notice.kind == Notice::Kind::table;
  if (what == Happens::join) {
    node.candidate.join();
  } else if (what == Happens::leave) {
    node.candidate.leave();
  } else if (is_table) {
    const auto change =
        node.candidate.table(std::span(notice.bindings).first(query_.roles()), notice.used_lives[node.number]);
    if (change == Candidate::Change::released && node.member) {
      RoleEvent event;
      event.kind = RoleEvent::Kind::dropped;
      event.participant = node.member->config().index;
      event.self = self;
      events.each.push_back(event);
      node.member.reset();
    }
    if (change == Candidate::Change::bound)
      node.member.emplace(config(*node.candidate.role() + 1U, node.candidate.incarnation()));
  } else if (node.member) {
    const Input input = what == Happens::received        ? Input::received(0, notice.word, usual_sequence)
                        : what == Happens::master_silent ? Input::peer_silent(0)
                                                         : input_of(what, which, *node.member);
    const Outputs outputs = take(*node.member, input, self, events);
    events.refused = what == Happens::call && !program::is_good(outputs.status);
  } else {
    events.refused = true;
  }
  return nodes_.intern(node);
}

NoticeId Stations::word_notice(const Word& word) {
  Notice notice;
  notice.kind = Notice::Kind::word;
  notice.word = word;
  return notices_.intern(notice);
}

NoticeId Stations::word_of_master(StationId id) { return word_notice(masters_[id].participant.word()); }

NoticeId Stations::table(StationId id) {
  const Binder& told = binder(id);
  Notice notice;
  notice.kind = Notice::Kind::table;
  std::copy(told.bindings().begin(), told.bindings().end(), notice.bindings.begin());
  for (std::uint8_t c = 0; c < told.candidates(); ++c) notice.used_lives[c] = told.used_life(c);
  return notices_.intern(notice);
}

NoticeId Stations::announcement(StationId id) {
  const Candidate& candidate = nodes_[id].candidate;
  if (!candidate.announces()) return no_notice;
  Notice notice;
  notice.kind = Notice::Kind::announcement;
  notice.announcement = candidate.announcement();
  return notices_.intern(notice);
}

NoticeId Stations::word_of_node(StationId id) {
  const Node& node = nodes_[id];
  if (!node.member) return no_notice;
  Notice notice;
  notice.kind = Notice::Kind::word;
  notice.role = static_cast<std::uint8_t>(node.member->config().index - 1);
  notice.word = node.member->word();
  return notices_.intern(notice);
}

}  // namespace takt::explore
