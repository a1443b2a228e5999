// SPDX-License-Identifier: Apache-2.0
// What a run learns about one Program: reactions, states, violated invariants. No participant asks for it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "handshake/observer.hpp"
#include "handshake/reaction.hpp"
#include "scenario/programs/observations.hpp"
#include "scenario/programs/program_faults.hpp"
#include "scenario/programs/round_trips.hpp"
#include "scenario/programs/tree_monitor.hpp"
#include "sim/simulation.hpp"

namespace takt::scenario {

/// One change of state, for the time line. A crash is one without a transition; a LifeRecord says that it is one.
struct StateRecord {
  sim::TrueTime time;
  std::uint8_t participant = 0;
  handshake::StateChange change;
};

/// A participant has died with its node, or is back.
struct LifeRecord {
  sim::TrueTime time;
  std::uint8_t participant = 0;
  bool is_back = false;
};

/// A violated invariant and when it was seen.
struct ViolationRecord {
  sim::TrueTime time;
  handshake::Violation violation;
};

/// A command of the script and what came of it.
struct CallRecord {
  sim::TrueTime time;
  std::uint8_t participant = 0;
  program::Method method = program::Method::Start;
  program::StatusCode status = program::StatusCode::Good;
};

class ProgramMonitor {
 public:
  /// What is counted from an instant on.
  struct Counts {
    std::uint64_t changes = 0;  ///< of state
    std::uint64_t process_data_received = 0;
  };

  /// `number` tells programs apart in the digest. Counts and round trips are kept from each of the instants on. At most
  /// `most_records` changes of state are kept for the time line. What participants do is judged when the instant is
  /// over: on_...() hand it to `observations`, which outlives the monitor.
  ProgramMonitor(sim::Simulation& simulation, Observations& observations, std::uint32_t number,
                 handshake::Variant variant, std::size_t participants, std::vector<sim::Duration> instants);

  /// Its program is group number `group` of a tree.
  void set_tree(TreeMonitor& tree, std::size_t group) { tree_ = &tree, group_ = group; }

  /// The faults that touch the program, by time, and the nodes that its participants are on at the beginning.
  void set_faults(std::vector<ProgramFault> faults) { faults_ = std::move(faults); }
  void set_nodes(std::vector<std::uint32_t> nodes) { nodes_ = std::move(nodes); }

  void on_step(std::size_t participant, const handshake::Outputs& outputs, const handshake::Word& after);
  /// A method is about to be called; on_call says what came of it.
  void before_call() { observe(observed::CallBegins{}); }
  void on_call(std::size_t participant, program::Method method, program::StatusCode status) {
    observe(observed::Call{participant, method, status});
  }
  /// The node of a participant that was in this state has failed: it is dead, and knows nothing when it comes back.
  void on_crash(std::size_t participant, handshake::PublishedState before);
  /// The participant is nobody any more, without a fault: its role has another node, or none.
  void on_gone(std::size_t participant, handshake::PublishedState before);
  /// The participant is there (again), on this node.
  void on_back(std::size_t participant, std::uint32_t node) { observe(observed::Back{participant, node}); }
  /// The script has let a node leave that has a role.
  void on_leave() { observe(observed::Leave{}); }
  /// The time-out of a peer, last heard at `since`, has expired at a participant: what its next step does is because of
  /// that.
  void on_silence(std::size_t participant, std::size_t peer, sim::TrueTime since) {
    observe(observed::Silence{participant, peer, since});
  }
  sim::TrueTime now() const { return simulation_->now(); }
  void on_process_data(std::size_t from, std::size_t to, std::uint32_t sent_in) {
    observe(observed::ProcessData{from, to, sent_in});
  }
  /// The number of rounds begun so far by anybody, if the participant is Running; 0 otherwise. It goes with what the
  /// participant sends now. Only of `paper`.
  std::uint32_t sending_run(std::size_t participant) const {
    return sending_[participant] == handshake::PublishedState::Running ? rounds_ : 0;
  }

  /// The instant is over in which that was observed.
  void judge(const Observation& what);
  void judge(const observed::Gone& gone);
  void judge(const observed::Back& back);

  /// The round trips of replies are measured.
  void set_round_trips(const ResolvedProgram& program) { round_trips_.emplace(program, instants_); }
  void on_published(std::size_t data_set, std::uint16_t sequence) {
    if (round_trips_) round_trips_->on_published(static_cast<std::uint8_t>(data_set), sequence, simulation_->now());
  }
  void on_replied(std::size_t reply, std::uint16_t sequence, std::uint16_t request) {
    round_trips_->on_replied(reply, sequence, request, simulation_->now());
  }
  void on_data_received(std::uint8_t data_set, std::uint16_t sequence, std::size_t to) {
    if (round_trips_) round_trips_->on_received(data_set, sequence, to, simulation_->now());
  }
  /// Nothing without replies.
  const std::optional<RoundTrips>& round_trips() const { return round_trips_; }

  std::span<const handshake::Reaction> reactions() const { return tracker_.reactions(); }
  const std::vector<StateRecord>& history() const { return history_; }
  const Counts& counts(sim::Duration from) const { return counts_.from(from); }
  /// In the whole run.
  std::uint64_t changes() const { return changes_; }
  std::uint64_t process_data_received() const { return process_data_received_; }
  const std::vector<LifeRecord>& lives() const { return lives_; }
  bool is_dead(std::size_t participant) const { return is_dead_[participant]; }
  const std::vector<ProgramFault>& faults() const { return faults_; }
  const std::vector<CallRecord>& calls() const { return calls_; }
  const std::vector<ViolationRecord>& violations() const { return violations_; }

 private:
  static constexpr std::size_t most_records = 10'000;
  void observe(const Observation& what) { observations_->add(*this, what); }
  void judge(const observed::Step& step);
  void judge(const observed::CallBegins&) { is_called_ = true; }
  void judge(const observed::Call& call);
  void judge(const observed::Crash& crash);
  void judge(const observed::Leave&) { last_leave_ = simulation_->now(); }
  void judge(const observed::Silence& silence);
  void judge(const observed::ProcessData& data);
  void note_violations();
  void note_gone(std::size_t participant, handshake::PublishedState before);
  handshake::Origin origin_of(const handshake::Outputs& outputs) const;

  sim::Simulation* simulation_;
  Observations* observations_;
  handshake::Variant variant_;
  std::vector<handshake::PublishedState> sending_;  // by participant, up to now
  std::uint32_t rounds_ = 0;                        // begun up to now; `paper` only
  TreeMonitor* tree_ = nullptr;
  std::size_t group_ = 0;
  std::uint32_t number_;
  handshake::Observer observer_;
  handshake::ReactionTracker tracker_;
  std::vector<ProgramFault> faults_;
  std::vector<std::uint32_t> nodes_;  // by participant
  std::vector<bool> is_dead_;
  std::vector<LifeRecord> lives_;
  handshake::Origin silence_;
  sim::TrueTime last_back_ = sim::TrueTime::never();
  sim::TrueTime last_leave_ = sim::TrueTime::never();
  bool is_called_ = false;
  std::vector<StateRecord> history_;
  std::vector<sim::Duration> instants_;
  Accounts<Counts> counts_;
  std::uint64_t changes_ = 0;
  std::uint64_t process_data_received_ = 0;
  std::vector<CallRecord> calls_;
  std::vector<ViolationRecord> violations_;
  std::optional<RoundTrips> round_trips_;
};

}  // namespace takt::scenario
