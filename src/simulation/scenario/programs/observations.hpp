// SPDX-License-Identifier: Apache-2.0
// What the participants of Programs do at one instant. The monitors judge it when the instant is over.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <variant>
#include <vector>

#include "handshake/binder.hpp"
#include "handshake/participant.hpp"
#include "sim/simulation.hpp"

namespace takt::scenario {

class ProgramMonitor;
class RoleMonitor;

namespace observed {

struct Step {
  std::size_t participant = 0;
  handshake::Outputs outputs;
  handshake::Word after;
};
/// The script is about to call a method.
struct CallBegins {};
struct Call {
  std::size_t participant = 0;
  program::Method method = program::Method::Start;
  program::StatusCode status = program::StatusCode::Good;
};
/// The node of a participant that was in this state has failed.
struct Crash {
  std::size_t participant = 0;
  handshake::PublishedState before{};
};
/// A participant has ended without a fault.
struct Gone {
  std::size_t participant = 0;
  handshake::PublishedState before{};
};
struct Back {
  std::size_t participant = 0;
  std::uint32_t node = 0;
};
/// The script has let a node leave that has a role.
struct Leave {};
/// The time-out of a peer, last heard at `since`, has expired at a participant.
struct Silence {
  std::size_t participant = 0;
  std::size_t peer = 0;
  sim::TrueTime since;
};
struct ProcessData {
  std::size_t from = 0;
  std::size_t to = 0;
  std::uint32_t sent_in = 0;
};

}  // namespace observed

using Observation = std::variant<observed::Step, observed::CallBegins, observed::Call, observed::Crash, observed::Gone,
                                 observed::Back, observed::Leave, observed::Silence, observed::ProcessData>;

/// Shared by the monitors of a run. No node sees what another one does at the same instant, but monitors compare nodes.
/// So they see an instant as a whole: first what participants did, in the order of phases and of the components that
/// handled the events; then which node each role has got.
class Observations final : public sim::Component {
 public:
  /// Before anything happens.
  void watch(sim::Simulation& simulation) {
    simulation_ = &simulation;
    source_ = sim::EventSource(simulation.add(*this));
  }

  void add(ProgramMonitor& monitor, const Observation& what) {
    ask();
    seen_.push_back({&monitor, {simulation_->phase(), simulation_->target()}, what});
  }
  /// The master has given the role to a node, or taken it away.
  void add_binding(RoleMonitor& monitor, std::size_t role, const handshake::Binding& binding) {
    ask();
    bindings_.push_back({&monitor, role, binding});
  }

  /// The instant is over.
  void handle(sim::Simulation& simulation, const sim::Event& event) override;

 private:
  void ask() {
    if (seen_.empty() && bindings_.empty())
      simulation_->schedule(source_, simulation_->now(), sim::Phase::judgement, source_.id(), 0, 0);
  }

  struct Seen {
    ProgramMonitor* monitor;
    std::pair<sim::Phase, sim::ComponentId> when;
    Observation what;
  };
  struct Bound {
    RoleMonitor* monitor;
    std::size_t role;
    handshake::Binding binding;
  };
  sim::Simulation* simulation_ = nullptr;
  sim::EventSource source_;
  std::vector<Seen> seen_;
  std::vector<Bound> bindings_;
};

}  // namespace takt::scenario
