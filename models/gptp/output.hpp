// SPDX-License-Identifier: Apache-2.0
// What the state machines ask of their host.
#pragma once

#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "models/gptp/drifting_rate.hpp"
#include "models/gptp/message.hpp"

namespace takt::models::gptp {

/// Ports are numbered from 1, as in PortIdentity; 0 stands for the instance as a whole.
using PortNumber = std::uint16_t;

enum class TimerPurpose : std::uint8_t {
  pdelay_interval,
  sync_interval,
  sync_receipt,
  announce_interval,
  announce_receipt,
  gptp_capable_interval,
  gptp_capable_receipt
};

/// A timer of a machine, at most one pending of each. Timers run on the free-running clock of the node.
struct TimerId {
  static constexpr std::uint8_t no_instance = 0xFF;  // timers of the link, which all instances share
  std::uint8_t instance = no_instance;               // index of the PTP instance in its node
  PortNumber port = 0;
  TimerPurpose purpose = TimerPurpose::pdelay_interval;
  auto operator<=>(const TimerId&) const = default;
};

/// How a one-step Sync changes while it leaves: its correction grows by what passes on the grandmaster's clock from
/// `since` to the egress, and its rate ratio is the one at the egress.
struct OneStepPatch {
  sim::LocalTime since;
  DriftingRate rate_ratio;
  /// Precondition: a one-step Sync.
  void apply(Message& message, sim::LocalTime egress) const {
    Sync& sync = std::get<Sync>(message);
    sync.header.correction = sync.header.correction + Correction::of(rate_ratio.times(egress - since));
    sync.one_step->information.cumulative_scaled_rate_offset = rate_ratio.after(egress - since).minus_one().scaled_41();
  }
};

/// Send the message at `port`. If it is an event message report its egress with EgressReport.
struct SendMessage {
  PortNumber port = 0;
  Message message;
  std::optional<OneStepPatch> one_step = {};
};
struct ArmTimer {
  TimerId timer;
  sim::LocalTime at;
};
struct CancelTimer {
  TimerId timer;
};

/// A Sync has been taken in at the port that is time receiver: at the local instant `at` the grandmaster showed
/// `grandmaster_time`, and it runs at rate_ratio against the free-running clock.
struct SyncSample {
  std::uint8_t instance = 0;
  sim::LocalTime at;
  sim::PtpTime grandmaster_time;
  ClockRate rate_ratio;
  std::int8_t log_sync_interval = -3;
  ClockIdentity grandmaster = {};
};

enum class PortRole : std::uint8_t { disabled, time_transmitter, time_receiver, passive };

struct RoleChange {
  std::uint8_t instance = 0;
  PortNumber port = 0;
  PortRole role = PortRole::disabled;
};
struct GrandmasterChange {
  std::uint8_t instance = 0;
  ClockIdentity grandmaster = {};
  std::uint16_t steps_removed = 0;  // 0: this node is it
};
/// No Sync for the receipt time-out: from now on there is holdover, until the next SyncSample.
struct SyncLost {
  std::uint8_t instance = 0;
};
struct AsCapableChange {
  PortNumber port = 0;
  bool as_capable = false;
};

using Output = std::variant<SendMessage, ArmTimer, CancelTimer, SyncSample, RoleChange, GrandmasterChange, SyncLost,
                            AsCapableChange>;
/// The caller gives an empty one and may use it again: it keeps its memory.
using Outputs = std::vector<Output>;

/// An event message has left. `egress` is its timestamp by the free-running clock.
struct EgressReport {
  PortNumber port = 0;
  MessageType type = MessageType::sync;
  std::uint8_t domain = 0;
  std::uint16_t sequence_id = 0;
  sim::LocalTime egress;
};

}  // namespace takt::models::gptp
