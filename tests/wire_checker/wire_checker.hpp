// SPDX-License-Identifier: Apache-2.0
// Verifies a run from outside: a recorder that knows the configuration, the trace records and the frames that they
// name, and nothing of the model's state. What it checks is listed in README.md.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <set>
#include <span>
#include <variant>
#include <vector>

#include "models/plan.hpp"
#include "sim/trace.hpp"
#include "tests/wire_checker/ingress_oracle.hpp"
#include "tests/wire_checker/port_checker.hpp"

namespace takt::wire_checker {

/// What the script and the faults of a scenario change while it runs.
struct Change {
  struct Gates {
    models::NodeIndex node;
    std::uint16_t port = 0;
    models::GateConfig gates;
  };
  struct StuckGate {
    models::NodeIndex node;
    std::uint16_t port = 0;
    models::TrafficClass traffic_class = 0;
    std::optional<bool> open;
  };
  struct LinkState {
    std::uint32_t link = 0;
    bool up = false;
  };
  struct Routes {};
  Ps at = 0;
  std::variant<Gates, StuckGate, LinkState, Routes> what;
};

/// Which component of the simulation is which part of the plan.
struct Directory {
  std::vector<std::vector<sim::ComponentId>> nodes;  ///< by node: its bridge, its host
  std::vector<std::vector<sim::ComponentId>> ports;  ///< by node and port
};

using FrameLookup = std::function<const models::Frame&(models::FrameIndex)>;

/// What became of the frames of a stream, by the trace.
struct StreamAccount {
  std::uint64_t produced = 0;
  std::uint64_t delivered = 0;
  std::uint64_t in_flight = 0;  ///< on links and in queues, at the end
  std::array<std::uint64_t, static_cast<std::size_t>(models::DropReason::count)> dropped{};
};

class WireChecker final : public sim::TraceSink {
 public:
  /// `plan` outlives the checker; `changes` are in the order of their times.
  WireChecker(const models::NetworkPlan& plan, std::vector<Change> changes, const Directory& directory,
              FrameLookup frame_of);
  ~WireChecker() override;
  WireChecker(const WireChecker&) = delete;
  WireChecker& operator=(const WireChecker&) = delete;

  void record(const sim::TraceRecord& record) override;
  /// The run is over at `end`; everything up to and at it has been recorded.
  void finish(Ps end);
  /// Compares the accounts with those that the model kept. `hosts_hold`: frames that were produced may be in hosts
  /// still, beside what their latencies do.
  void compare(std::span<const models::Stream> streams, bool hosts_hold = false);

  const Violations& violations() const { return violations_; }
  Violations& violations() { return violations_; }
  const std::vector<StreamAccount>& accounts() const { return accounts_; }
  /// All frames that were named, for a look at the pool: those alive among them are all that are.
  const std::set<std::uint32_t>& handles() const { return handles_; }
  std::uint64_t transmissions() const { return transmissions_; }

 private:
  struct Direction;
  struct Node;
  struct Arrival;
  struct Recorded;
  struct Place {
    std::uint32_t direction = 0xFFFF'FFFF;
    std::uint32_t node = 0xFFFF'FFFF;
  };

  void connect(const models::LinkPlan& link, const models::LinkPlan::End& from, const models::LinkPlan::End& to);
  void announce_cut_through();
  void work_up_to(Ps time, bool with_records);
  void instant(Ps now);
  std::set<std::uint32_t> ports_with_headers(Ps now) const;
  void note_what_could_be_cut_through(const std::set<std::uint32_t>& ports, Ps now);
  bool is_cut_through(const Direction& direction, const Recorded& recorded) const;
  void apply(const Change& change);
  void attribute(Ps now, std::vector<Recorded>& batch);
  bool is_own(std::uint32_t node, models::StreamIndex stream, std::uint32_t direction) const;
  bool is_taken_in(std::uint32_t node, const Arrival& arrival) const;
  void finish_host_instant(std::uint32_t node, Ps now);
  void check_nobody_overtakes(std::uint32_t index, Ps now);
  void check_why_stored(std::uint32_t index, const Arrival& arrival, std::uint32_t direction, Ps now);
  void finish_bridge_instant(std::uint32_t node, Ps now);
  void run_ingress(std::uint32_t node, Ps now, std::vector<Arrival*>& arrived);
  void check_order(const Arrival& arrival, Ps now);
  void check_at_most_once(const models::StreamRecoveryConfig& recovery, std::uint32_t node, const models::Frame& frame,
                          Ps now);
  void feed(const Recorded& recorded);
  void send(std::uint32_t index, const Recorded& recorded, std::uint32_t octets);
  void remove(std::uint32_t index, models::FrameIndex handle, Ps now);
  void forget_arrivals(std::uint32_t node, Ps now);
  bool order_is_kept(models::StreamIndex stream) const;

  const models::NetworkPlan& plan_;
  std::vector<Change> changes_;
  FrameLookup frame_of_;
  Violations violations_;
  std::vector<Place> places_;  // by component
  std::vector<std::unique_ptr<Direction>> directions_;
  static constexpr std::uint32_t no_direction = 0xFFFF'FFFF;
  std::vector<std::vector<std::uint32_t>>
      direction_of_port_;  // by node and port; a number between those of others may have no link
  std::vector<std::unique_ptr<Node>> nodes_;
  std::vector<std::uint32_t> reasons_down_;  // by link
  std::size_t next_change_ = 0;
  std::set<std::pair<Ps, std::uint32_t>> wakes_;  // when something arrives at a node
  Ps batch_time_ = 0;
  std::vector<Recorded> batch_;  // the records of the present instant
  std::vector<StreamAccount> accounts_;
  std::set<std::uint32_t> handles_;
  std::uint64_t transmissions_ = 0;
  bool routes_change_ = false;
  bool duplicates_ = false;
};

}  // namespace takt::wire_checker
