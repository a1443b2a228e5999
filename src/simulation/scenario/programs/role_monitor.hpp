// SPDX-License-Identifier: Apache-2.0
// What a run learns about a Program with roles: who has which role, and what the bound nodes do as participants.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "handshake/role_observer.hpp"
#include "scenario/programs/program_monitor.hpp"

namespace takt::scenario {

/// A role got a node, or lost it.
struct BindingRecord {
  sim::TrueTime time;
  std::uint8_t role = 0;                  ///< from 0
  std::optional<std::uint8_t> candidate;  ///< none: nobody
};

/// A handshake::RoleObserver for each role before a ProgramMonitor. What an instant does to bindings counts from its
/// end on, whatever else happens in it: a node that falls silent for the master when the master falls silent for it
/// still takes its last step in its role.
class RoleMonitor {
 public:
  /// The state in which the participant of a binding's life is, if there is one.
  using StateOf = std::function<std::optional<handshake::PublishedState>(const handshake::Binding&)>;

  /// `nodes`: of the candidates.
  RoleMonitor(sim::Simulation& simulation, Observations& observations, std::uint32_t number, ProgramMonitor& program,
              std::size_t roles, std::vector<std::uint32_t> nodes, StateOf state_of)
      : simulation_(&simulation),
        observations_(&observations),
        number_(number),
        program_(&program),
        observers_(roles),
        nodes_(std::move(nodes)),
        state_of_(std::move(state_of)) {}

  void on_bound(std::size_t role, const handshake::Binding& binding) {
    observations_->add_binding(*this, role, binding);
  }
  /// The participant on a candidate has taken a step in its role.
  void on_step(std::size_t role, const handshake::Binding& self, const handshake::Outputs& outputs,
               const handshake::Word& after);
  /// The participant is gone: it was let go, or its node has crashed.
  void on_dropped(std::size_t role, const handshake::Binding& self, bool has_crashed);
  void on_process_data(std::size_t role, const handshake::Binding& self, std::size_t from, std::uint32_t sent_in);

  handshake::PublishedState state(std::size_t role) const { return observers_[role].state(); }
  const handshake::Binding& binding(std::size_t role) const { return observers_[role].binding(); }
  bool has_role(std::uint8_t candidate) const;
  const std::vector<BindingRecord>& history() const { return history_; }

  /// The instant is over in which the role got that.
  void judge_binding(std::size_t role, const handshake::Binding& binding);

 private:
  static constexpr std::size_t most_records = 10'000;

  sim::Simulation* simulation_;
  Observations* observations_;
  std::uint32_t number_;
  ProgramMonitor* program_;
  std::vector<handshake::RoleObserver> observers_;  // by role
  std::vector<std::uint32_t> nodes_;                // of the candidates
  StateOf state_of_;
  std::vector<BindingRecord> history_;
};

}  // namespace takt::scenario
