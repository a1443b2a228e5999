#include "handshake/tree_observer.hpp"

#include <utility>

#include "sim/check.hpp"

namespace takt::handshake {

TreeObserver::TreeObserver(std::vector<TreeGroup> groups) : groups_(std::move(groups)), taken_(groups_.size()) {
  TAKT_CHECK(!groups_.empty(), "a tree has a root");
  std::size_t participants = 0;
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    TAKT_CHECK(g == 0 ? groups_[g].outer_index == 0 : groups_[g].outer < g && groups_[g].outer_index != 0,
               "an inner group's master is a slave of a group before it");
    first_.push_back(participants);
    observers_.emplace_back(Variant::Robust, groups_[g].participants);
    participants += groups_[g].participants;
  }
  last_words_.resize(participants);
}

void TreeObserver::on_step(std::size_t group, std::size_t participant, const Outputs& outputs, const Word& after) {
  observers_[group].on_step(participant, outputs, after);
  take_violations(group);
  last_words_[number_of(group, participant)] = after;
  if (group != 0 && outputs.raised && outputs.raised_kind == IntentKind::Start)
    links_.push_back({group, after.intent.run, last_words_[number_of(groups_[group].outer, groups_[group].outer_index)].intent.run});
  bool was_ready = after.state == PublishedState::Ready;
  for (const StateChange& change : outputs.changes()) was_ready = was_ready || change.to == PublishedState::Ready;
  if (was_ready && after.run != 0) {
    if (const std::uint32_t run = tree_run(group, after.run); run != 0) facts_of(run).ready[number_of(group, participant)] = true;
  }
  for (const StateChange& change : outputs.changes())
    if (change.to == PublishedState::Running) became_running(group, participant, after);
}

void TreeObserver::on_restart(std::size_t group, std::size_t participant) {
  observers_[group].on_restart(participant);
  last_words_[number_of(group, participant)] = {};
}

void TreeObserver::on_process_data(std::size_t group, std::size_t from, std::size_t to, std::uint32_t sent_in) {
  observers_[group].on_process_data(from, to, sent_in);
  take_violations(group);
}

void TreeObserver::became_running(std::size_t group, std::size_t participant, const Word& after) {
  const std::uint32_t run = tree_run(group, after.run);
  if (run == 0) {
    report(Invariant::S1, Finding::RunningBeforeAllReady, group, participant);
    return;
  }
  Facts& facts = facts_of(run);
  facts.running[number_of(group, participant)] = true;
  bool all_ready = true;
  bool all_below_running = true;
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    const bool below = is_below(g, group, participant);
    for (std::size_t p = 0; p < groups_[g].participants; ++p) {
      if (is_node(g, p)) all_ready = all_ready && facts.ready[number_of(g, p)];
      const bool is_self = g == group && p == participant;
      if (below && !is_self) all_below_running = all_below_running && facts.running[number_of(g, p)];
    }
  }
  if (!all_ready) report(Invariant::S1, Finding::RunningBeforeAllReady, group, participant);
  if (!all_below_running) report(Invariant::S2, Finding::MasterBeforeSlaves, group, participant);
}

/// Whether a group hangs below a participant of `top`: a master's own group does, too.
bool TreeObserver::is_below(std::size_t group, std::size_t top, std::size_t top_participant) const {
  if (group == top) return top_participant == 0;
  while (group != 0) {
    const std::size_t outer = groups_[group].outer;
    if (outer == top) return top_participant == 0 || groups_[group].outer_index == top_participant;
    group = outer;
  }
  return false;
}

/// 0 if it was started for none.
std::uint32_t TreeObserver::tree_run(std::size_t group, std::uint32_t run) const {
  for (; group != 0; group = groups_[group].outer) {
    std::uint32_t outer = 0;
    for (std::size_t i = links_.size(); i-- > 0 && outer == 0;)
      if (links_[i].group == group && links_[i].inner == run) outer = links_[i].outer;
    if (outer == 0) return 0;
    run = outer;
  }
  return run;
}

/// The newest runs are asked for most.
auto TreeObserver::facts_of(std::uint32_t tree_run) -> Facts& {
  for (std::size_t i = facts_.size(); i-- > 0;)
    if (facts_[i].run == tree_run) return facts_[i];
  facts_.push_back({tree_run, std::vector<bool>(participants()), std::vector<bool>(participants())});
  return facts_.back();
}

void TreeObserver::report(Invariant invariant, Finding finding, std::size_t group, std::size_t participant) {
  violations_.push_back({group, {invariant, finding, static_cast<std::uint8_t>(participant)}, true});
}

void TreeObserver::take_violations(std::size_t group) {
  const auto all = observers_[group].violations();
  for (; taken_[group] < all.size(); ++taken_[group]) violations_.push_back({group, all[taken_[group]], false});
}

void TreeReactions::on_step(std::size_t number, const Outputs& outputs, sim::TrueTime at, const Origin& origin) {
  Outputs seen = outputs;
  if (outputs.alarm == Alarm::OtherGroup) seen.raised = false;
  tracker_.on_step(number, seen, Word{}, at, origin);  // without an intent: numbers of different groups cannot be compared
}

}  // namespace takt::handshake
