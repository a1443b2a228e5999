// What a run learns about a Program with roles: who has which role, and what the bound nodes do as participants.
#pragma once

#include <cstdint>
#include <optional>
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

/// A handshake::RoleObserver before a ProgramMonitor.
class PlugMonitor {
 public:
  /// `nodes`: of the candidates.
  PlugMonitor(sim::Simulation& simulation, std::uint32_t number, ProgramMonitor& program, std::size_t roles, std::vector<std::uint32_t> nodes)
      : simulation_(&simulation), number_(number), program_(&program), observer_(roles), nodes_(std::move(nodes)) {}

  /// `before`: the state in which the participant of that life is already, if there is one.
  void on_bound(std::size_t role, const handshake::Binding& binding, std::optional<handshake::PublishedState> before);
  /// The participant on a candidate has taken a step in its role.
  void on_step(std::size_t role, const handshake::Binding& self, const handshake::Outputs& outputs, const handshake::Word& after);
  /// The participant is gone: it was let go, or its node has crashed.
  void on_dropped(std::size_t role, const handshake::Binding& self, bool has_crashed);
  void on_process_data(std::size_t role, const handshake::Binding& self, std::size_t from, std::uint32_t sent_in);

  handshake::PublishedState state(std::size_t role) const { return observer_.state(role); }
  const handshake::Binding& binding(std::size_t role) const { return observer_.binding(role); }
  bool has_role(std::uint8_t candidate) const;
  const std::vector<BindingRecord>& history() const { return history_; }

 private:
  static constexpr std::size_t most_records = 10'000;

  sim::Simulation* simulation_;
  std::uint32_t number_;
  ProgramMonitor* program_;
  handshake::RoleObserver observer_;
  std::vector<std::uint32_t> nodes_;   // of the candidates
  std::vector<BindingRecord> history_;
};

}  // namespace takt::scenario
