// SPDX-License-Identifier: Apache-2.0
// A PTP instance: one domain in one node, all its ports. IEEE 802.1AS-2020 clause 10 (BMCA, Announce, Sync) and 11
// (two- and one-step).
#pragma once

#include <optional>
#include <vector>

#include "models/gptp/link_delay.hpp"
#include "models/gptp/message_interval.hpp"
#include "models/gptp/output.hpp"
#include "models/gptp/port_selection.hpp"
#include "models/gptp/rate_ratio_drift.hpp"
#include "models/gptp/sync_information.hpp"

namespace takt::models::gptp {

struct InstanceConfig {
  std::uint8_t domain = 0;
  SystemIdentity system = {};     // its clock identity is that of the instance
  int log_sync_interval = -3;     // 125 ms
  int log_announce_interval = 0;  // 1 s
  int sync_receipt_timeout = 3;   // intervals of the sender
  int announce_receipt_timeout = 3;
  bool two_step = true;
  bool sync_locked = true;  // relays a Sync at once; otherwise at its own interval
  bool boundary = false;    // a boundary clock (IEEE 1588): gives the time of its own disciplined clock at its own
                            // interval, and relays nothing
  /// Syncs over which the drift of the rate ratio is measured and made up for, even; 0: not at all, as plain 802.1AS.
  std::size_t rate_ratio_drift_window = 0;
  bool drift_tracking = false;  // sends the Drift_Tracking TLV, and goes by that of others
  TimeProperties time = {};     // of the time that it gives as grandmaster
  /// externalPortConfigurationEnabled: the role of each port; BMCA is off. Without a time receiver it is the
  /// grandmaster.
  std::optional<std::vector<PortRole>> external_roles = {};
};

/// A value that is stepped: each call takes one input, `now` by the free-running clock of the node, and appends what is
/// to be done. It never looks at a clock. A clock that starts as grandmaster shows its local time until
/// set_source_time().
class PtpInstance {
 public:
  PtpInstance(const InstanceConfig& config, std::uint8_t index, PortNumber ports);

  void start(sim::LocalTime now, Outputs& outputs);
  /// The link is up and the neighbour speaks gPTP (asCapable), or not any more.
  void set_port_capable(PortNumber port, bool capable, sim::LocalTime now, Outputs& outputs);
  void received(const Announce& announce, PortNumber port, sim::LocalTime now, Outputs& outputs);
  void received(const Sync& sync, PortNumber port, sim::LocalTime ingress, const LinkMeasure& link, sim::LocalTime now,
                Outputs& outputs);
  void received(const FollowUp& follow_up, PortNumber port, sim::LocalTime now, Outputs& outputs);
  /// The neighbour asks for other intervals of Sync and Announce.
  void received(const IntervalRequest& request, PortNumber port, sim::LocalTime now, Outputs& outputs);
  void transmitted(const EgressReport& report, Outputs& outputs);
  void timer_expired(PortNumber port, TimerPurpose purpose, sim::LocalTime now, Outputs& outputs);

  /// The clock from which the instance gives time while it is grandmaster. When it becomes grandmaster it first goes on
  /// with the time of the grandmaster before (holdover); a host with a disciplined clock puts that one in its place.
  void set_source_time(const SourceTime& source) { source_ = source; }
  const SourceTime& source_time() const { return source_; }

  const InstanceConfig& config() const { return config_; }
  PortRole role(PortNumber port) const { return at(port).role; }
  bool is_grandmaster() const { return selection_.receiver == 0; }
  /// What it sends is the time of its source, not what it has received.
  bool gives_own_time() const { return is_grandmaster() || config_.boundary; }
  /// gmPresent (10.2.4.13): the root of the tree can be grandmaster; its priority1 is not 255.
  bool grandmaster_present() const { return selection_.grandmaster.root.priority1 < 255; }
  const PriorityVector& grandmaster() const { return selection_.grandmaster; }
  /// Of the time that it gives or gets.
  const TimeProperties& time_properties() const {
    return is_grandmaster() ? config_.time : at(selection_.receiver).time;
  }
  PortNumber receiver_port() const { return selection_.receiver; }
  const std::vector<ClockIdentity>& path_trace() const { return path_trace_; }
  /// The last Sync that was taken in; nothing since it was lost, and as grandmaster.
  const std::optional<SyncInformation>& last_sync() const { return sync_; }

 private:
  struct SyncWaiting {  // for its Follow_Up
    Header header = {};
    sim::LocalTime ingress = {};
    LinkMeasure link = {};
  };
  struct SyncLeaving {  // for its egress
    std::uint16_t sequence_id = 0;
    SyncInformation sync = {};
  };
  struct Port {
    MessageInterval sync_interval;
    MessageInterval announce_interval;
    PortRole role = PortRole::disabled;
    bool capable = false;
    std::vector<ClockIdentity> path_trace = {};  // of the Announce that is valid here
    TimeProperties time = {};                    // likewise
    std::uint16_t next_announce = 0;
    std::uint16_t next_sync = 0;
    std::optional<SyncWaiting> waiting = {};
    std::optional<SyncLeaving> leaving = {};
    bool has_own_interval = false;      // it has begun to send by a timer of its own
    sim::LocalTime next_own_sync = {};  // then
    sim::LocalTime next_timed_announce = {};
  };

  Port& at(PortNumber port);
  const Port& at(PortNumber port) const;
  PortInformation& information(PortNumber port) { return information_[port - 1u]; }
  ClockIdentity self() const { return config_.system.clock; }
  bool external() const { return config_.external_roles.has_value(); }
  PortNumber ports() const { return static_cast<PortNumber>(ports_.size()); }
  TimerId timer(PortNumber port, TimerPurpose purpose) const { return {index_, port, purpose}; }

  // Roles (ptp_instance.cpp)
  void reselect(sim::LocalTime now, Outputs& outputs);
  void select_external();
  void set_role(PortNumber port, PortRole role, Outputs& outputs);
  void adopt_grandmaster(const PriorityVector& before, PortNumber receiver_before, sim::LocalTime now,
                         Outputs& outputs);
  void expect_sync(const PriorityVector& before, PortNumber receiver_before, sim::LocalTime now, Outputs& outputs);
  bool update_announced(PortNumber port);
  bool is_qualified(const Announce& announce) const;
  bool is_accepted(const PriorityVector& priority, PortNumber port) const;
  void age(PortNumber port, sim::LocalTime now, Outputs& outputs);
  void announce_to_all(sim::LocalTime now, Outputs& outputs);
  void send_announce(PortNumber port, sim::LocalTime now, Outputs& outputs);

  // Time (ptp_instance_sync.cpp)
  void sync_complete(const SyncWaiting& waiting, const Timestamp& origin, Correction correction,
                     const FollowUpInformation& information, const std::optional<DriftTracking>& drift, PortNumber port,
                     sim::LocalTime now, Outputs& outputs);
  std::optional<DriftTracking> drift_of(const SyncInformation& sync, sim::LocalTime egress) const;
  void sync_receipt_expired(PortNumber port, sim::LocalTime now, Outputs& outputs);
  void sync_interval_elapsed(PortNumber port, sim::LocalTime now, Outputs& outputs);
  void arm_sync_receipt(PortNumber port, int log_interval, sim::LocalTime now, Outputs& outputs);
  bool goes_along(PortNumber port) const;
  void follow_sync_interval(PortNumber port, sim::LocalTime now, Outputs& outputs);
  void own_sync_interval_elapsed(PortNumber port, sim::LocalTime now, Outputs& outputs);
  void send_sync(PortNumber port, const SyncInformation& sync, Outputs& outputs);
  bool is_from_transmitter(const Header& header, PortNumber port) const;
  Header header(PortNumber port, std::uint16_t sequence_id, int log_interval) const;

  InstanceConfig config_;
  std::uint8_t index_;
  bool started_ = false;
  std::vector<Port> ports_;
  std::vector<PortInformation> information_;  // beside ports_
  Selection selection_;
  Selection next_selection_;
  std::vector<ClockIdentity> path_trace_;  // to this instance, itself included
  std::optional<SyncInformation> sync_;
  RateRatioDrift drift_;
  SourceTime source_;
  sim::LocalTime next_sync_;  // as grandmaster
};

}  // namespace takt::models::gptp
