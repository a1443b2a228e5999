// SPDX-License-Identifier: Apache-2.0
#include "explore/parts/views.hpp"

#include <algorithm>

#include "explore/parts/parts_model.hpp"
#include "sim/check.hpp"

namespace takt::explore {

using handshake::PublishedState;

namespace {

/// All that may be beside the slave that a step is about; `none` is a group of one slave.
constexpr Others every_beside[] = {{false, false}, {true, false}, {false, true}, {true, true}};

/// Different parts of slaves, at most: more of them take minutes.
constexpr std::uint64_t most_parts = 500'000;

constexpr bool is_of_word(ActionKind kind) {
  return kind == ActionKind::receive || kind == ActionKind::duplicate || kind == ActionKind::reorder;
}

}  // namespace

bool AnyNumber::is_proved() const {
  return std::all_of(verdicts.begin(), verdicts.end(), [](PropertyVerdict each) {
    return each == PropertyVerdict::holds || each == PropertyVerdict::reached || each == PropertyVerdict::not_asked;
  });
}

Views::Views(const Query& query) : query_(query), parts_(query) {
  TAKT_CHECK(query.can_have_parts(), "a stranger, channels and other subscriptions are explored in small groups");
  list_actions();
}

void Views::list_actions() {
  const auto pair = [&](ActionKind kind) {
    for (std::uint8_t who = 0; who < 2; ++who) with_slave_.push_back({kind, who, 0});
  };
  const auto at_slave = [&](ActionKind kind, std::size_t count = 1) {
    for (std::size_t what = 0; what < count; ++what) {
      with_slave_.push_back({kind, 1, static_cast<std::uint16_t>(what)});
      alone_.push_back({kind, 0, static_cast<std::uint16_t>(what)});
    }
  };
  const bool strays = query_.faults.contains(Fault::duplicate) || query_.faults.contains(Fault::reorder);
  pair(ActionKind::receive);
  if (strays) with_slave_.push_back({ActionKind::deliver_late, 0, 0});
  at_slave(ActionKind::initialised);
  if (query_.faults.contains(Fault::crash)) pair(ActionKind::silence);
  at_slave(ActionKind::call, program::methods.size());
  if (query_.finishes) at_slave(ActionKind::finish);
  if (query_.faults.contains(Fault::duplicate)) pair(ActionKind::duplicate);
  if (query_.faults.contains(Fault::reorder)) pair(ActionKind::reorder);
  if (query_.faults.contains(Fault::crash)) at_slave(ActionKind::crash);
  if (query_.faults.contains(Fault::restart)) at_slave(ActionKind::restart);
  if (query_.faults.contains(Fault::timeout)) pair(ActionKind::timeout);
}

/// The states at rest of small groups. That those of greater ones have the same views is tested (views_test.cpp).
void Views::begin() {
  for (std::uint8_t slaves = 1; slaves <= 3; ++slaves) {
    Query small = query_;
    small.slaves = slaves;
    PartsModel model(small);
    for (const Beginning& each : model.beginnings()) {
      // Numbers of parts belong to one Parts, so the calls and words are gone through again here.
      MasterId master = parts_.master_switched_on();
      std::vector<SlaveId> group(slaves, parts_.slave_switched_on());
      for (const Action action : each.actions) {
        const PartAction part = part_action(action, slaves);
        Others others;
        for (std::size_t i = 0; i < group.size(); ++i) {
          if (i + 1 == part.slave) continue;
          others.are_ready = others.are_ready && parts_.known(group[i]).ready;
          others.are_running = others.are_running && parts_.known(group[i]).running;
        }
        const auto outcomes = part.slave == 0 ? parts_.alone(master, part.action, others)
                                              : parts_.with_slave(master, group[part.slave - 1], part.action, others);
        if (outcomes.empty()) continue;
        const Outcome done = outcomes.front();
        for (std::size_t i = 0; i < group.size(); ++i)
          group[i] = i + 1 == part.slave ? done.slave : parts_.after(master, done.master, group[i]);
        master = done.master;
      }
      const CoreId core = core_of(
          {master, static_cast<std::uint8_t>(query_.commands), static_cast<std::uint8_t>(query_.fault_budget), false});
      for (const SlaveId slave : group) see(core, slave);
    }
  }
}

Views::CoreId Views::core_of(const Core& core) {
  const CoreId id = cores_.intern(core);
  if (id == views_of_.size()) {
    views_of_.emplace_back();
    moves_of_.emplace_back();
    take_alone(id);
  }
  return id;
}

void Views::see(CoreId core, SlaveId slave) {
  const std::uint64_t key = std::uint64_t{core} << 32 | parts_.bare(slave);
  const std::uint64_t place = in_set_.find(key);
  if (place == Memo::absent) {
    in_set_.insert(key, views_.size());
    views_of_[core].push_back(static_cast<std::uint32_t>(views_.size()));
    views_.push_back({core, slave});
    open_.push_back(static_cast<std::uint32_t>(views_.size() - 1));
    return;
  }
  View& view = views_[place];
  if (view.slave == slave) return;
  const SlaveId joined = parts_.joined(view.slave, slave, !parts_.of_master(cores_[core].master).down);
  if (joined == view.slave) return;
  view.slave = joined;
  if (view.is_expanded) open_.push_back(static_cast<std::uint32_t>(place));
  view.is_expanded = false;
}

bool Views::contains(MasterId master, std::uint32_t commands_left, std::uint32_t faults_left, bool has_late,
                     SlaveId slave) {
  const Core wanted{master, static_cast<std::uint8_t>(commands_left), static_cast<std::uint8_t>(faults_left), has_late};
  const std::optional<std::uint32_t> core = cores_.number_of(wanted);
  if (!core) return false;
  const std::uint64_t place = in_set_.find(std::uint64_t{*core} << 32 | parts_.bare(slave));
  if (place == Memo::absent) return false;
  const SlaveId joined = parts_.joined(views_[place].slave, slave, !parts_.of_master(master).down);
  return joined == parts_.joined(views_[place].slave, views_[place].slave, !parts_.of_master(master).down);
}

bool Views::is_free(CoreId core, SlaveId slave, Action action, bool is_alone) const {
  if (action.kind != ActionKind::restart) return !is_fault(action.kind);
  return is_alone ? parts_.of_master(cores_[core].master).down : parts_.of_slave(slave).down;
}

bool Views::allows(CoreId core_id, Action action, bool is_alone, SlaveId slave) const {
  const Core& core = cores_[core_id];
  if ((action.kind == ActionKind::call || action.kind == ActionKind::finish) && core.commands == 0) return false;
  if (!is_free(core_id, slave, action, is_alone) && core.faults == 0) return false;
  return !core.late || (action.kind != ActionKind::duplicate && action.kind != ActionKind::reorder);
}

Views::Core Views::left_by(CoreId core_id, Action action, const Outcome& outcome, bool is_free) const {
  Core core = cores_[core_id];
  core.master = outcome.master;
  if (action.kind == ActionKind::call || action.kind == ActionKind::finish) --core.commands;
  if (!is_free) --core.faults;
  if (action.kind == ActionKind::duplicate || action.kind == ActionKind::reorder) core.late = true;
  if (action.kind == ActionKind::deliver_late) core.late = false;
  return core;
}

AnyNumber Views::prove(const Watcher& watcher) {
  AnyNumber result;
  begin();
  std::uint32_t watched = 0;
  const std::uint64_t most = std::min<std::uint64_t>(query_.states, most_parts);
  while (!open_.empty() && views_.size() < query_.states && parts_.slaves() < most) {
    if ((++watched & 0xFFFU) == 0 &&
        !watcher({views_.size(), views_.size() - open_.size(), 0, views_.size() * 24, false})) {
      result.interrupted = true;
      break;
    }
    View& view = views_[open_.front()];
    open_.pop_front();
    view.is_expanded = true;
    expand(view);
  }
  result.exhausted = open_.empty();
  if (result.exhausted) judge_rest();
  conclude(result);
  return result;
}

void Views::expand(View view) {
  // Steps that others have taken so far; those that are found later look for it by themselves.
  for (std::size_t i = 0; i < moves_of_[view.core].size(); ++i) {
    const Move each = moves_of_[view.core][i];
    pass(view.core, each, view.slave);
  }
  for (const Action& action : with_slave_) {
    if (!allows(view.core, action, false, view.slave)) continue;
    const std::size_t words = (action.who == 0 ? parts_.up(view.slave) : parts_.down(view.slave)).size();
    const std::size_t count = is_of_word(action.kind) ? words : 1;
    for (std::size_t newer = 0; newer < count; ++newer) {
      Action one = action;
      if (is_of_word(action.kind)) one.what = static_cast<std::uint16_t>(newer);
      take(view, one);
    }
  }
}

void Views::take(View view, Action action) {
  std::vector<Outcome> beside_anybody;
  for (const Others others : every_beside) {
    const auto found_now = parts_.with_slave(cores_[view.core].master, view.slave, action, others);
    const std::vector<Outcome> outcomes(found_now.begin(), found_now.end());
    for (const Outcome& outcome : outcomes) {
      if (std::find(beside_anybody.begin(), beside_anybody.end(), outcome) != beside_anybody.end()) continue;
      found(outcome.properties);
      const CoreId to = core_of(left_by(view.core, action, outcome, is_free(view.core, view.slave, action, false)));
      see(to, outcome.slave);
      judge_pair(to, outcome);
      if (others.none()) continue;
      const Beside beside = others.are_ready ? Beside::ready : others.are_running ? Beside::running : Beside::anybody;
      move(view.core, {to, beside, outcome.running_in, outcome.master_runs});
    }
    if (others == every_beside[0]) beside_anybody = outcomes;
  }
}

/// Steps of the master that are about no slave. Each slave's part is beside such a step, so it looks for what all are.
void Views::take_alone(CoreId core) {
  for (const Action& action : alone_) {
    if (!allows(core, action, true, 0)) continue;
    for (const Others all : every_beside) {
      if (all.none()) continue;  // a group has a slave, and none is both
      const auto found_now = parts_.alone(cores_[core].master, action, all);
      const std::vector<Outcome> outcomes(found_now.begin(), found_now.end());
      for (const Outcome& outcome : outcomes) {
        found(outcome.properties);
        const CoreId to = core_of(left_by(core, action, outcome, is_free(core, 0, action, true)));
        if (outcome.running_in != 0 && !parts_.seen_of_master(cores_[to].master).was_ready(outcome.running_in))
          seen_.insert(Property::S1);
        move(core, {to,
                    all.are_ready     ? Beside::ready
                    : all.are_running ? Beside::running
                                      : Beside::anybody,
                    outcome.running_in, outcome.master_runs});
      }
    }
  }
}

void Views::move(CoreId from, const Move& move) {
  if (move.to == from && move.running_in == 0) return;
  std::vector<Move>& moves = moves_of_[from];
  if (std::find(moves.begin(), moves.end(), move) != moves.end()) return;
  moves.push_back(move);
  const std::vector<std::uint32_t> beside = views_of_[from];
  for (const std::uint32_t each : beside) pass(from, move, views_[each].slave);
}

/// A step that this slave's part is beside of.
void Views::pass(CoreId from, const Move& move, SlaveId beside) {
  if (!is_beside(move.beside, beside)) return;
  if (move.running_in != 0) {
    const Seen& seen = parts_.seen_of_slave(beside);
    if (!seen.was_ready(move.running_in)) seen_.insert(Property::S1);
    if (move.master_runs && !seen.was_running(move.running_in)) seen_.insert(Property::S2);
  }
  see(move.to, parts_.after(cores_[from].master, cores_[move.to].master, beside));
}

bool Views::is_beside(Beside beside, SlaveId slave) const {
  const Known& known = parts_.known(slave);
  return beside == Beside::anybody || (beside == Beside::ready ? known.ready : known.running);
}

/// S1 and S2 among the two that the step is about.
void Views::judge_pair(CoreId core, const Outcome& outcome) {
  if (outcome.running_in == 0) return;
  const Seen& slave = parts_.seen_of_slave(outcome.slave);
  if (!slave.was_ready(outcome.running_in) || !parts_.seen_of_master(cores_[core].master).was_ready(outcome.running_in))
    seen_.insert(Property::S1);
  if (outcome.master_runs && !slave.was_running(outcome.running_in)) seen_.insert(Property::S2);
}

/// L1 and F1: where nothing changes any more by itself, all are where they have to be (README.md, steps 7 and 8).
void Views::judge_rest() {
  for (const View& view : views_) {
    const MasterId master = cores_[view.core].master;
    if (parts_.are_settled(master, view.slave)) continue;
    const Known known = parts_.known(view.slave);
    const bool is_at_rest = parts_.are_at_rest(master, view.slave, {}) ||
                            (known.ready && parts_.are_at_rest(master, view.slave, {true, false})) ||
                            (known.running && parts_.are_at_rest(master, view.slave, {false, true}));
    if (!is_at_rest) continue;
    const bool is_down = parts_.of_master(master).down || parts_.of_slave(view.slave).down;
    seen_.insert(is_down ? Property::F1 : Property::L1);
  }
}

void Views::conclude(AnyNumber& result) const {
  result.masters = cores_.size();
  result.views = views_.size();
  result.parts = parts_.slaves();
  result.are_alike = parts_.are_sound();
  for (std::size_t p = 0; p < property_count; ++p) {
    const auto property = static_cast<Property>(p);
    PropertyVerdict& verdict = result.verdicts[p];
    if ((is_of_silence(property) && !query_.asks_for_silence()) || is_of_roles(property) || is_of_replays(property) ||
        property == Property::all_running) {
      verdict = PropertyVerdict::not_asked;
    } else if (must_always_hold(property)) {
      const bool is_liveness = property == Property::L1 || property == Property::F1;
      const bool is_decided = result.exhausted && result.are_alike && (!is_liveness || parts_.go_forward());
      verdict = seen_.contains(property) ? PropertyVerdict::violated
                : is_decided             ? PropertyVerdict::holds
                                         : PropertyVerdict::unknown;
    } else {
      verdict = seen_.contains(property) ? PropertyVerdict::reached : PropertyVerdict::unreached;
    }
  }
}

AnyNumber prove_for_any_number(const Query& query, const Watcher& watcher) { return Views(query).prove(watcher); }

}  // namespace takt::explore
