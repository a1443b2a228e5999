// SPDX-License-Identifier: Apache-2.0
// gPTP in a simulated node: gives the machines of node.hpp their timers, their frames and their timestamps, and
// disciplines the node's clock with what they find out.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "models/clock/node_clock.hpp"
#include "models/egress/egress_port.hpp"
#include "models/ethernet/link_local.hpp"
#include "models/gptp/clock_target.hpp"
#include "models/gptp/hot_standby.hpp"
#include "models/gptp/node.hpp"
#include "models/gptp/station_plan.hpp"
#include "models/host/cpu.hpp"
#include "sim/timer.hpp"

namespace takt::models::gptp {

/// What a node's clock is, for reports. A grandmaster's is locked to itself.
enum class ClockState : std::uint8_t { free_running, acquiring, locked, holdover, down };

class Station final : public sim::Component, public ClockListener, public LinkLocalReceiver, public CpuUser {
 public:
  /// `ports` are those of the node; `stream` is the one of all gPTP frames. All references outlive the station.
  Station(sim::Simulation& simulation, Traffic& traffic, std::span<EgressPort> ports, NodeClock& clock,
          const TimestampUnit& timestamps, const StationPlan& plan, NodeIndex node, StreamIndex stream,
          std::string_view path);

  static ClockIdentity identity_of(NodeIndex node) {
    return ClockIdentity::from_number(0x0200'5EFF'FE00'0000 + node.value);
  }
  static std::optional<NodeIndex> node_of(const ClockIdentity& identity);

  /// The machines begin; links are up. Call once, at time zero.
  void start();
  void handle(sim::Simulation& simulation, const sim::Event& event) override;
  void receive(sim::Simulation& simulation, FrameIndex frame, std::uint16_t port, sim::TrueTime last_bit) override;
  /// An event message begins to leave that port of the node.
  void transmission_starts(std::uint16_t port, FrameIndex frame);
  void clock_changed(const LocalClock& clock, sim::TrueTime now) override;

  /// The thread of the node's processor on which each message that comes is a job.
  void run_on(Cpu& cpu, std::uint32_t thread) {
    cpu_ = &cpu;
    thread_ = thread;
  }
  void job_ended(sim::Simulation& simulation, std::uint64_t job, Ending ending) override;

  void set_link(std::uint16_t port, bool up);
  /// A node that crashes forgets everything; its clock runs on.
  void set_up(bool up);

  // For reports.
  NodeIndex node() const { return node_; }
  sim::ComponentId id() const { return source_.id(); }
  ClockState state() const {
    return !up_                      ? ClockState::down
           : active_is_grandmaster() ? ClockState::locked
                                     : static_cast<ClockState>(target_.state());
  }
  /// The root of a tree that cannot be grandmaster gives time to nobody.
  bool active_is_grandmaster() const { return gives_time(active()); }
  /// Whom the node takes its time from, itself if it is grandmaster.
  NodeIndex grandmaster() const;
  /// Somebody gives the time that it takes: itself if it is grandmaster; nobody where the root of the tree cannot be
  /// grandmaster.
  bool has_grandmaster() const { return machine_.instance(active()).grandmaster_present(); }
  const Node& machine() const { return machine_; }
  /// asCapable of a port (from 0) in the domain that the time comes from: why not, and since when it has been as it is.
  NotCapable obstacle(std::uint16_t port) const {
    return machine_.obstacle(active(), static_cast<PortNumber>(port + 1));
  }
  sim::TrueTime capability_changed(std::uint16_t port) const { return capability_[port].since; }
  const ClockTarget& target() const { return target_; }
  const std::optional<HotStandby>& standby() const { return standby_; }
  const LocalClock& disciplined() const { return clock_->disciplined(); }
  bool is_up() const { return up_; }
  std::uint64_t messages_sent() const { return messages_sent_; }
  std::uint64_t steps() const { return steps_; }

  /// What changed, for histories.
  struct Change {
    sim::TrueTime time;
    NodeIndex grandmaster;
    ClockState state = ClockState::free_running;
  };
  const std::vector<Change>& changes() const { return changes_; }

 private:
  struct Waiting {  // a message between decision and egress queue, or between queue and egress
    SendMessage send;
    FrameIndex frame;  // from the egress queue on, of event messages
    std::uint64_t sequence = 0;
  };
  struct PortCapability {
    bool is_capable = false;
    sim::TrueTime since;
  };
  struct Armed {
    TimerId timer;
    sim::LocalTime at;
  };
  struct Arrived {
    FrameIndex frame;
    std::uint16_t port = 0;
    sim::TrueTime last_bit;
  };
  void receive_after_timestamp(sim::Simulation& simulation, const Arrived& arrived);
  void receive_all();
  void receive_one(const Arrived& arrived);
  bool gives_time(std::size_t instance) const {
    return machine_.instance(instance).is_grandmaster() && machine_.instance(instance).grandmaster_present();
  }
  std::size_t active() const { return standby_ ? static_cast<std::size_t>(standby_->active()) : 0; }
  /// Further domains have no part in the hot standby.
  bool has_standby_role(std::size_t instance) const { return standby_ && instance < standby_role_count; }
  sim::LocalTime local() const { return clock_->free_running().local_at(simulation_->now()); }
  void carry_out();
  void send(const SendMessage& message);
  sim::Duration processing_of(const SendMessage& message);
  void hand_over(std::uint64_t argument);
  /// The argument of an event that concerns a message, and is void after a crash.
  std::uint64_t of_this_life(std::uint32_t slot) const { return static_cast<std::uint64_t>(epoch_) << 32 | slot; }
  void report_egress(std::uint64_t argument);
  void discipline(const SyncSample& sample);
  /// A record of this node for the digest.
  void note(Occurrence kind, std::uint64_t what) const;
  void give_time();
  void expire();
  void rearm();
  void note_change();
  void note_capability();
  void ask_for_intervals(const TimedIntervalRequest& asked);
  std::uint32_t keep(const SendMessage& message);

  sim::Simulation* simulation_;
  Traffic* traffic_;
  std::span<EgressPort> ports_;
  NodeClock* clock_;
  TimestampUnit timestamps_;
  StationPlan plan_;
  NodeConfig config_;
  NodeIndex node_;
  StreamIndex stream_;
  sim::EventSource source_;
  std::vector<sim::RandomStream> egress_chance_;  // of each port
  std::vector<sim::RandomStream> ingress_chance_;
  Node machine_;
  ClockTarget target_;
  std::optional<HotStandby> standby_;
  std::vector<sim::RandomStream> processing_chance_;  // by port, kind of message and domain, so that it does not matter
                                                      // which of several is looked at first; empty if nothing is drawn
  sim::Timer timer_;
  std::vector<Armed> armed_;
  std::vector<Armed> due_;  // at this instant
  bool is_expiring_ = false;
  std::vector<Waiting> waiting_;  // by slot
  std::vector<std::uint32_t> free_slots_;
  std::vector<sim::LocalTime> egress_of_slot_;
  std::vector<Arrived> arrived_;  // and not yet taken in
  std::vector<bool> link_is_up_;  // by port
  std::vector<Output> outputs_;
  std::vector<std::byte> octets_;
  std::vector<Change> changes_;
  std::vector<PortCapability> capability_;  // by port
  std::vector<std::uint64_t> sent_by_port_;
  std::uint64_t messages_sent_ = 0;
  std::uint64_t steps_ = 0;
  std::uint32_t epoch_ = 0;  // of the machines; a crash begins another one
  bool up_ = true;
  Cpu* cpu_ = nullptr;  // null: what comes takes no time of a processor
  std::uint32_t thread_ = 0;
  std::vector<std::optional<Arrived>> on_cpu_;  // by job
};

}  // namespace takt::models::gptp
