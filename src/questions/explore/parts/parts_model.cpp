// SPDX-License-Identifier: Apache-2.0
#include "explore/parts/parts_model.hpp"

#include <algorithm>

#include "explore/model/beginnings.hpp"
#include "explore/parts/telling.hpp"
#include "sim/check.hpp"

namespace takt::explore {

using handshake::PublishedState;

namespace {

/// Words newer than the one that is heard, at most.
constexpr std::size_t most_missed = PartsModel::most_words - 1;

Shape shape_of_parts(const Query& query) {
  Shape shape;
  shape.wide = true;  // no delayed copy of its own
  shape.channels_at = shape.late_at = shape.observer_at = shape.rest_at = static_cast<std::uint8_t>(query.slaves + 1);
  shape.recordings_at = static_cast<std::uint8_t>(query.slaves + 2);
  shape.words = static_cast<std::uint8_t>((query.slaves + 3) / 2 * 2);
  return shape;
}

}  // namespace

PartsModel::PartsModel(const Query& query) : query_(query), shape_(shape_of_parts(query)), parts_(query) {
  TAKT_CHECK(query.slaves >= 1 && query.slaves <= most_equal_slaves, "a group to explore is small");
  TAKT_CHECK(query.can_have_parts(), "a stranger, channels and other subscriptions are explored in small groups");
  TAKT_CHECK(query.commands <= most_commands && query.fault_budget <= most_faults, "budgets are small");
  list_actions();
  make_beginnings();
}

/// A lost word is one that is never heard, which costs nothing here: there is no action for it (README.md, step 3).
void PartsModel::list_actions() {
  const std::size_t participants = query_.slaves + 1U;
  const std::size_t channels = 2U * query_.slaves;
  const auto each_word = [&](ActionKind kind, std::size_t from) {
    for (std::size_t c = 0; c < channels; ++c)
      for (std::size_t newer = from; newer <= most_missed; ++newer) add(kind, c, newer);
  };
  const auto each_peer = [&](ActionKind kind) {
    for (std::size_t slave = 0; slave < query_.slaves; ++slave) add(kind, 0, slave);
    for (std::size_t slave = 1; slave <= query_.slaves; ++slave) add(kind, slave, 0);
  };
  const auto each_participant = [&](ActionKind kind) {
    for (std::size_t i = 0; i < participants; ++i) add(kind, i);
  };
  const bool strays = query_.faults.contains(Fault::duplicate) || query_.faults.contains(Fault::reorder);
  for (std::size_t c = 0; c < channels; ++c) add(ActionKind::receive, c);
  if (strays) add(ActionKind::deliver_late, 0);
  each_participant(ActionKind::initialised);
  if (query_.faults.contains(Fault::crash)) each_peer(ActionKind::silence);
  end_network();
  for (std::size_t i = 0; i < participants; ++i)
    for (std::size_t m = 0; m < program::methods.size(); ++m) add(ActionKind::call, i, m);
  if (query_.finishes) each_participant(ActionKind::finish);
  end_calls();
  if (query_.faults.contains(Fault::duplicate)) each_word(ActionKind::duplicate, 0);
  if (query_.faults.contains(Fault::reorder)) each_word(ActionKind::reorder, 1);
  if (query_.faults.contains(Fault::crash)) each_participant(ActionKind::crash);
  begin_free();
  if (query_.faults.contains(Fault::restart)) each_participant(ActionKind::restart);
  each_word(ActionKind::receive, 1);
  end_free();
  if (query_.faults.contains(Fault::timeout)) each_peer(ActionKind::timeout);
}

void PartsModel::make_beginnings() {
  const std::size_t participants = query_.slaves + 1U;
  for (const Rest& rest : rests()) {
    Opening opening(*this, switched_on(), rest.name);
    for (const program::Method method : rest.calls) {
      opening.call(method);
      opening.settle(participants, 2U * query_.slaves, 6);
    }
    opening.keep(participants, rest.state, beginnings_);
    if (query_.beginnings == Beginnings::switched_on) break;
  }
}

State PartsModel::switched_on() {
  State state(shape_);
  state.set_member(0, parts_.master_switched_on());
  for (std::size_t i = 1; i <= query_.slaves; ++i) state.set_member(i, parts_.slave_switched_on());
  return state;
}

PublishedState PartsModel::state_of(const State& state, std::size_t participant) const {
  return participant == 0 ? parts_.of_master(master(state)).state : parts_.of_slave(slave(state, participant)).state;
}

bool PartsModel::is_free(const State& state, Action action) const {
  if (action.kind == ActionKind::restart)
    return action.who == 0 ? parts_.of_master(master(state)).down : parts_.of_slave(slave(state, action.who)).down;
  return !is_fault(action.kind);
}

bool PartsModel::act(const State& state, Action action, Next& next) {
  if (action.kind == ActionKind::send || action.kind == ActionKind::lose) return false;  // README.md, step 3
  const bool is_word =
      action.kind == ActionKind::receive || action.kind == ActionKind::duplicate || action.kind == ActionKind::reorder;
  if (is_word && action.what >= parts_.longest_said()) return false;
  const bool is_call = action.kind == ActionKind::call || action.kind == ActionKind::finish;
  if (is_call && state.commands_left() == 0) return false;
  const bool costs_fault = !is_free(state, action);
  if (costs_fault && state.faults_left() == 0) return false;
  if (!change(state, action, next)) return false;
  if (is_call) next.state.set_commands_left(state.commands_left() - 1);
  if (costs_fault) next.state.set_faults_left(state.faults_left() - 1);
  return true;
}

bool PartsModel::change(const State& state, Action action, Next& next) {
  const bool keeps_copy = action.kind == ActionKind::duplicate || action.kind == ActionKind::reorder;
  if (keeps_copy || action.kind == ActionKind::deliver_late) {
    std::size_t late = 1;
    while (late <= query_.slaves && parts_.slave(slave(state, late)).late == Late::none) ++late;
    if ((late <= query_.slaves) == keeps_copy) return false;  // one copy at a time, in the whole group
    if (!keeps_copy) return take(state, late, action, next);
  }
  const PartAction part = part_action(action, query_.slaves);
  return take(state, part.slave, part.action, next);
}

bool PartsModel::take(const State& state, std::size_t about, Action action, Next& next) {
  // Of equal neighbours one is enough: the other one leads to the same group.
  if (about > 1 && slave(state, about) == slave(state, about - 1)) return false;
  const MasterId before = master(state);
  const auto outcomes = about == 0 ? parts_.alone(before, action, others(state, 0))
                                   : parts_.with_slave(before, slave(state, about), action, others(state, about));
  if (outcomes.empty()) return false;
  const Outcome outcome = outcomes.front();
  next = {state, outcome.properties};
  next.state.set_member(0, outcome.master);
  for (std::size_t i = 1; i <= query_.slaves; ++i) {
    if (i == about)
      next.state.set_member(i, outcome.slave);
    else if (outcome.master != before)
      next.state.set_member(i, parts_.after(before, outcome.master, slave(state, i)));
  }
  judge(outcome, next);
  return true;
}

Others PartsModel::others(const State& state, std::size_t but) const {
  Others others;
  for (std::size_t i = 1; i <= query_.slaves; ++i) {
    if (i == but) continue;
    const Known& known = parts_.known(slave(state, i));
    others.are_ready = others.are_ready && known.ready;
    others.are_running = others.are_running && known.running;
  }
  return others;
}

void PartsModel::judge(const Outcome& outcome, Next& next) const {
  const std::uint32_t run = outcome.running_in;
  if (run == 0) return;
  bool were_ready = parts_.seen_of_master(outcome.master).was_ready(run);
  bool were_running = true;
  for (std::size_t i = 1; i <= query_.slaves; ++i) {
    const Seen& seen = parts_.seen_of_slave(slave(next.state, i));
    were_ready = were_ready && seen.was_ready(run);
    were_running = were_running && seen.was_running(run);
  }
  if (!were_ready) next.properties.insert(Property::S1);
  if (outcome.master_runs && !were_running) next.properties.insert(Property::S2);
}

/// The order of equal slaves means nothing.
State PartsModel::canonical(const State& state) const {
  State sorted = state;
  std::sort(sorted.data() + 1, sorted.data() + 1 + query_.slaves);
  return sorted;
}

bool PartsModel::settled(const State& state) const {
  for (std::size_t i = 1; i <= query_.slaves; ++i)
    if (!parts_.are_settled(master(state), slave(state, i))) return false;
  // Somebody else may be down, and these two agree on Running.
  if (!anybody_down(state)) return true;
  for (std::size_t i = 0; i <= query_.slaves; ++i) {
    const bool is_down = i == 0 ? parts_.of_master(master(state)).down : parts_.of_slave(slave(state, i)).down;
    if (!is_down && state_of(state, i) != PublishedState::Halted) return false;
  }
  return true;
}

bool PartsModel::anybody_down(const State& state) const {
  if (parts_.of_master(master(state)).down) return true;
  for (std::size_t i = 1; i <= query_.slaves; ++i)
    if (parts_.of_slave(slave(state, i)).down) return true;
  return false;
}

bool PartsModel::all_running(const State& state) const {
  if (anybody_down(state)) return false;
  for (std::size_t i = 0; i <= query_.slaves; ++i)
    if (state_of(state, i) != PublishedState::Running) return false;
  return true;
}

Beginning PartsModel::told(const Beginning& beginning) {
  State state = switched_on();
  state.set_commands_left(most_commands);
  Telling telling(*this, state);
  for (const Action action : beginning.actions) telling.take(action);
  return {beginning.name, telling.actions(), beginning.state};
}

Trace PartsModel::told(const Trace& trace) {
  Telling telling(*this, beginnings_[trace.beginning].state);
  Trace result{trace.beginning, {}, trace.cycle};
  for (const Action action : trace.actions) telling.take(action);
  result.actions = telling.actions();
  return result;
}

}  // namespace takt::explore
