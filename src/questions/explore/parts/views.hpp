// SPDX-License-Identifier: Apache-2.0
// A group of any number of equal slaves: what holds in each of them, proved at once by view abstraction (Abdulla,
// Haziza, Holik) with views of the master and one slave.
//
// A view is a state of the master, with what is left of the budgets, and the part of one slave (parts.hpp). A set of
// views stands for all groups, of whatever size, all of whose views are in it. The set here holds the beginnings and is
// closed under all steps, so every state of every group is among those that it stands for. README.md has the argument
// in numbered steps.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <vector>

#include "explore/parts/parts.hpp"
#include "explore/search/search.hpp"

namespace takt::explore {

struct AnyNumber {
  std::array<PropertyVerdict, property_count> verdicts{};  ///< holds: in a group of any size
  std::uint64_t masters = 0;                               ///< states of the master, with budgets
  std::uint64_t views = 0;
  std::uint64_t parts = 0;  ///< different parts of slaves
  bool exhausted = false;
  bool interrupted = false;
  bool are_alike =
      true;  ///< else the handshake treats one slave otherwise than another one, and nothing follows for more slaves

  PropertyVerdict operator[](Property property) const { return verdicts[index_of(property)]; }
  /// Whatever must hold holds for every number of slaves.
  bool is_proved() const;
};

/// The views of all groups for the variant, budgets and faults of the query; its slaves are not looked at. At most
/// query.states views, and half a million different parts of slaves.
class Views {
 public:
  explicit Views(const Query& query);

  AnyNumber prove(const Watcher& watcher);

  /// After prove(): whether a group's view is in the set.
  bool contains(MasterId master, std::uint32_t commands_left, std::uint32_t faults_left, bool has_late, SlaveId slave);
  Parts& parts() { return parts_; }

 private:
  using CoreId = std::uint32_t;
  /// What all views of a group have in common.
  struct Core {
    MasterId master = 0;
    std::uint8_t commands = 0;
    std::uint8_t faults = 0;
    bool late = false;  ///< a delayed copy is under way
    bool operator==(const Core&) const = default;
  };
  struct HashOfCore {
    std::size_t operator()(const Core& core) const {
      return mixed(std::uint64_t{core.master} << 32 | std::uint64_t{core.commands} << 16 |
                   std::uint64_t{core.faults} << 8 | std::uint64_t{core.late});
    }
  };
  /// Who may be beside the slave that a step is about.
  enum class Beside : std::uint8_t { anybody, ready, running };
  /// A step about one slave or none, as another slave's view sees it.
  struct Move {
    CoreId to = 0;
    Beside beside = Beside::anybody;
    std::uint32_t running_in = 0;
    bool master_runs = false;
    bool operator==(const Move&) const = default;
  };
  struct View {
    CoreId core = 0;
    SlaveId slave = 0;
    bool is_expanded = false;
  };

  void begin();
  void list_actions();
  CoreId core_of(const Core& core);
  void see(CoreId core, SlaveId slave);
  void expand(View view);
  void take(View view, Action action);
  void take_alone(CoreId core);
  void move(CoreId from, const Move& move);
  void pass(CoreId from, const Move& move, SlaveId beside);
  bool is_beside(Beside beside, SlaveId slave) const;
  void judge_pair(CoreId core, const Outcome& outcome);
  bool allows(CoreId core, Action action, bool is_alone, SlaveId slave) const;
  Core left_by(CoreId core, Action action, const Outcome& outcome, bool is_free) const;
  bool is_free(CoreId core, SlaveId slave, Action action, bool is_alone) const;
  void judge_rest();
  void found(PropertySet properties) { seen_.bits |= properties.bits; }
  void conclude(AnyNumber& result) const;

  Query query_;
  Parts parts_;
  std::vector<Action> with_slave_;  ///< actions of a group with one slave
  std::vector<Action> alone_;
  Interner<Core, HashOfCore> cores_;
  std::vector<std::vector<std::uint32_t>> views_of_;  ///< by core
  std::vector<std::vector<Move>> moves_of_;
  Memo in_set_;  ///< by core and bare part: the place of the view, whose registers may hold what those of any such view
                 ///< may
  std::vector<View> views_;         ///< in the order of discovery
  std::deque<std::uint32_t> open_;  ///< places of those that are not expanded, or were with less in their registers
  PropertySet seen_;
};

AnyNumber prove_for_any_number(const Query& query, const Watcher& watcher);

}  // namespace takt::explore
