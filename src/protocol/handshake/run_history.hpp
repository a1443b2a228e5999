// SPDX-License-Identifier: Apache-2.0
// Who was Ready and who was Running in which run, and what S1, S2 and S4 (invariants.hpp) say of whoever comes next:
// the one set of rules for all observers. What it is kept in depends on the host: an Observer (observer.hpp) watches
// any number of participants for any time, the explorer keeps a small value of it with each state.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "handshake/group_tree.hpp"
#include "handshake/invariants.hpp"
#include "handshake/word.hpp"

namespace takt::handshake {

/// `Storage` has `Set`, made with the number of participants, and `List<T>`, which a std::vector could be. A value:
/// equal knowledge is equal.
///
/// A run of the tree is a run of the root with the inner runs that were started for it. A node is Ready or Running as
/// the slave of its group, the root as the master of its own: an inner master shows INIT while it waits for the outer
/// barrier, and that its group is prepared is what the same node's outer Ready says.
template <class Storage>
class RunHistory {
 public:
  using Set = typename Storage::Set;

  RunHistory(Variant variant, const GroupTree& tree)
      : is_paper_(variant == Variant::paper), passed_init_(tree.participants()), ready_now_(tree.participants()) {
    TAKT_CHECK(!is_paper_ || tree.groups() == 1, "only robust is nested");
    if (!is_paper_) return;
    for (std::size_t i = 0; i < tree.participants(); ++i)
      runs_.insert(runs_.end(),
                   Run{static_cast<std::uint32_t>(i), 0, 0, Set(tree.participants()), Set(tree.participants())});
  }

  /// A round of `paper` begins for whoever makes this change.
  static constexpr bool begins_round(const StateChange& change) {
    return change.to == PublishedState::HaltedInit ||
           (change.to == PublishedState::Ready && change.from != PublishedState::HaltedInit);
  }

  /// A participant has changed its state and is in this run. Calls found(invariant, finding, of_tree) for what is
  /// violated.
  template <class Found>
  void on_transition(const GroupTree& tree, std::size_t participant, const StateChange& change, std::uint32_t run,
                     Found&& found) {
    if (change.to == PublishedState::Halted) passed_init_.erase(participant);
    if (change.to == PublishedState::HaltedInit) passed_init_.insert(participant);
    if (is_paper_) {
      change.to == PublishedState::Ready ? ready_now_.insert(participant) : ready_now_.erase(participant);
      if (begins_round(change)) {
        runs_[participant].ready = ready_now_;
        runs_[participant].running = Set(tree.participants());
      }
    }
    if (change.to == PublishedState::Ready) on_ready(tree, participant, run, found);
    if (change.to == PublishedState::Running) on_running(tree, participant, run, found);
  }
  /// It is Ready in this run; one that stays Ready may join another run so.
  template <class Found>
  void on_ready(const GroupTree& tree, std::size_t participant, std::uint32_t run, Found&& found) {
    if (is_paper_) {
      for (Run& each : runs_) each.ready.insert(participant);
      return;
    }
    const Run& now = note_ready(tree, participant, run);
    if (now.of_tree == 0) return;  // in a run of its group alone; there Running is forbidden
    for (std::size_t inner = 1; inner < tree.groups(); ++inner)
      if (tree.outer_number(tree.number_of(inner, 0)) == participant &&
          !in_tree_run(tree, now.of_tree, inner, 1, &Run::ready))
        found(Invariant::S1, Finding::ready_before_inner_group, true);
  }
  /// An inner group was started in this run for that run of the group outside.
  void on_started(const GroupTree& tree, std::size_t inner_master, std::uint32_t run, std::uint32_t outer_run) {
    const std::size_t group = tree.group_of(inner_master);
    const std::size_t outer = tree.group(group).outer;
    std::uint32_t of_tree = outer_run;
    if (outer != 0) {
      const std::size_t at = place(outer, outer_run);
      of_tree = is_at(at, outer, outer_run) ? runs_[at].of_tree : 0;
    }
    run_of(tree, group, run).of_tree = of_tree;
  }
  /// It is new: Halted, and it knows nothing.
  void on_restart(std::size_t participant) {
    passed_init_.erase(participant);
    ready_now_.erase(participant);
  }

  /// The same with other numbers for the participants of a single group.
  template <class To>
  RunHistory renamed(To&& to) const {
    RunHistory result = *this;
    result.passed_init_ = passed_init_.renamed(to);
    result.ready_now_ = ready_now_.renamed(to);
    for (std::size_t i = 0; i < runs_.size(); ++i) {
      Run& run = result.runs_[is_paper_ ? to(i) : i];
      run = runs_[i];
      if (is_paper_) run.id = static_cast<std::uint32_t>(to(i));
      run.ready = runs_[i].ready.renamed(to);
      run.running = runs_[i].running.renamed(to);
    }
    return result;
  }

  bool operator==(const RunHistory&) const = default;
  /// Calls mix(number) for whatever two that differ may differ in.
  template <class Mix>
  void hash_into(Mix&& mix) const {
    passed_init_.hash_into(mix);
    ready_now_.hash_into(mix);
    for (const Run& run : runs_) {
      mix(run.id | std::uint64_t{run.of_tree} << 32);
      mix(run.group);
      run.ready.hash_into(mix);
      run.running.hash_into(mix);
    }
  }

 private:
  /// What happened in a run of a group; `paper`: since a participant's round began.
  struct Run {
    std::uint32_t id = 0;       ///< the run; `paper`: the participant
    std::uint32_t of_tree = 0;  ///< the root's run for which it was started; 0: none
    std::uint16_t group = 0;
    Set ready;    ///< who was Ready at any time in it
    Set running;  ///< who was Running at any time in it
    bool operator==(const Run&) const = default;
  };

  template <class Found>
  void on_running(const GroupTree& tree, std::size_t participant, std::uint32_t run, Found&& found) {
    const std::size_t group = tree.group_of(participant);
    if (is_paper_)
      for (Run& each : runs_) each.running.insert(participant);
    else
      run_of(tree, group, run).running.insert(participant);
    const Run& now = is_paper_ ? runs_[participant] : run_of(tree, group, run);
    const bool is_master = tree.index_of(participant) == 0;
    if (!contains_group(tree, now.ready, group, 0)) found(Invariant::S1, Finding::running_before_all_ready, false);
    if (is_master && !contains_group(tree, now.running, group, 1))
      found(Invariant::S2, Finding::master_before_slaves, false);
    if (!passed_init_.contains(participant)) found(Invariant::S4, Finding::running_without_init, false);
    if (tree.groups() > 1) on_running_in_tree(tree, participant, now.of_tree, found);
  }
  template <class Found>
  void on_running_in_tree(const GroupTree& tree, std::size_t participant, std::uint32_t run, Found&& found) const {
    bool are_ready = run != 0;
    bool are_running = true;
    for (std::size_t group = 0; group < tree.groups() && run != 0; ++group) {
      are_ready = are_ready && in_tree_run(tree, run, group, group == 0 ? 0 : 1, &Run::ready);
      if (!tree.is_below(group, participant)) continue;
      are_running =
          are_running && in_tree_run(tree, run, group, group == tree.group_of(participant) ? 1 : 0, &Run::running);
    }
    if (!are_ready) found(Invariant::S1, Finding::running_before_all_ready, true);
    if (!are_running) found(Invariant::S2, Finding::master_before_slaves, true);
  }

  /// All of a group from this index on are in the set.
  static bool contains_group(const GroupTree& tree, const Set& set, std::size_t group, std::size_t from) {
    for (std::size_t i = from; i < tree.size(group); ++i)
      if (!set.contains(tree.number_of(group, i))) return false;
    return true;
  }
  /// All of a group from this index on were so in a run that was started for that one of the tree.
  bool in_tree_run(const GroupTree& tree, std::uint32_t of_tree, std::size_t group, std::size_t from,
                   Set Run::*which) const {
    Set all(tree.participants());
    for (const Run& each : runs_)
      if (each.group == group && each.of_tree == of_tree) all.add(each.*which);
    return contains_group(tree, all, group, from);
  }

  Run& note_ready(const GroupTree& tree, std::size_t participant, std::uint32_t run) {
    Run& now = run_of(tree, tree.group_of(participant), run);
    now.ready.insert(participant);
    return now;
  }
  std::size_t place(std::size_t group, std::uint32_t run) const {
    return static_cast<std::size_t>(std::lower_bound(runs_.begin(), runs_.end(), run,
                                                     [group](const Run& each, std::uint32_t id) {
                                                       return each.group != group ? each.group < group : each.id < id;
                                                     }) -
                                    runs_.begin());
  }
  bool is_at(std::size_t at, std::size_t group, std::uint32_t run) const {
    return at < runs_.size() && runs_[at].group == group && runs_[at].id == run;
  }
  Run& run_of(const GroupTree& tree, std::size_t group, std::uint32_t run) {
    const std::size_t at = place(group, run);
    if (!is_at(at, group, run)) {
      const std::uint32_t of_tree = group == 0 ? run : 0;
      runs_.insert(
          runs_.begin() + static_cast<std::ptrdiff_t>(at),
          Run{run, of_tree, static_cast<std::uint16_t>(group), Set(tree.participants()), Set(tree.participants())});
    }
    return runs_[at];
  }

  bool is_paper_ = false;
  Set passed_init_;                            ///< since they were last Halted
  Set ready_now_;                              ///< `paper` only
  typename Storage::template List<Run> runs_;  ///< rising by group and run
};

}  // namespace takt::handshake
