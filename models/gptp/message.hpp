// SPDX-License-Identifier: Apache-2.0
// The messages of IEEE 802.1AS-2020 as values; codec.hpp turns them into octets and back.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "models/gptp/identity.hpp"
#include "models/gptp/ptp_time.hpp"

namespace takt::models::gptp {

enum class MessageType : std::uint8_t {
  sync = 0x0,
  pdelay_req = 0x2,
  pdelay_resp = 0x3,
  follow_up = 0x8,
  pdelay_resp_follow_up = 0xA,
  announce = 0xB,
  signaling = 0xC,
};

/// The top nibble of the header: 802.1AS, or the common mean link delay service.
enum class MajorSdoId : std::uint8_t { gptp = 1, cmlds = 2 };

/// What all messages carry. The flags that belong to one type stand with it.
struct Header {
  MajorSdoId major_sdo_id = MajorSdoId::gptp;
  std::uint8_t minor_sdo_id = 0;
  std::uint8_t minor_version = 1;  // IEEE 1588-2019: version 2.1
  std::uint8_t domain = 0;
  Correction correction = {};
  PortIdentity source = {};
  std::uint16_t sequence_id = 0;
  std::int8_t log_message_interval = 0x7F;
  bool operator==(const Header&) const = default;
};

/// Follow_Up information TLV (11.4.4.3).
struct FollowUpInformation {
  std::int32_t cumulative_scaled_rate_offset = 0;  // (rate ratio - 1) * 2^41
  std::uint16_t gm_time_base_indicator = 0;
  std::array<std::uint8_t, 12> last_gm_phase_change = {};  // ScaledNs: 2^-16 ns, 96 bits
  std::int32_t scaled_last_gm_freq_change = 0;             // 2^-41
  bool operator==(const FollowUpInformation&) const = default;
};

/// Drift_Tracking TLV (IEEE 802.1ASdm): how fast the sender's rate ratio to the grandmaster changes.
struct DriftTracking {
  Timestamp sync_egress = {};  // by the sender's clock; what is below a nanosecond is left out
  ClockIdentity grandmaster = {};
  std::uint16_t steps_removed = 0;
  std::int32_t rate_ratio_drift = 0;  // per second, 2^-41
  bool operator==(const DriftTracking&) const = default;
};

/// Two-step without contents (the Follow_Up has them), or one-step with.
struct Sync {
  Header header = {};
  struct OneStep {
    Timestamp origin = {};
    FollowUpInformation information = {};
    std::optional<DriftTracking> drift = {};
    bool operator==(const OneStep&) const = default;
  };
  std::optional<OneStep> one_step = {};
  bool operator==(const Sync&) const = default;
};

struct FollowUp {
  Header header = {};
  Timestamp precise_origin = {};
  FollowUpInformation information = {};
  std::optional<DriftTracking> drift = {};
  bool operator==(const FollowUp&) const = default;
};

struct PdelayReq {
  Header header = {};
  bool operator==(const PdelayReq&) const = default;
};

struct PdelayResp {
  Header header = {};
  Timestamp request_receipt = {};
  PortIdentity requesting_port = {};
  bool operator==(const PdelayResp&) const = default;
};

struct PdelayRespFollowUp {
  Header header = {};
  Timestamp response_origin = {};
  PortIdentity requesting_port = {};
  bool operator==(const PdelayRespFollowUp&) const = default;
};

struct ClockQuality {
  std::uint8_t clock_class = 248;
  std::uint8_t clock_accuracy = 0xFE;
  std::uint16_t offset_scaled_log_variance = 0x436A;
  auto operator<=>(const ClockQuality&) const = default;
};

/// What an Announce says of its grandmaster's time besides (IEEE 1588 timePropertiesDS): passed on as received.
struct TimeProperties {
  std::int16_t current_utc_offset = 37;
  std::uint8_t time_source = 0xA0;  // internal oscillator
  std::uint8_t flags = 0x08;  // second flag octet: leap61 0x01, leap59 0x02, UTC offset valid 0x04, time scale PTP
                              // 0x08, time traceable 0x10, frequency traceable 0x20
  bool operator==(const TimeProperties&) const = default;
};

struct Announce {
  static constexpr std::size_t longest_path_trace = 179;  // 68 + 8 * 179 = 1500 octets

  Header header = {};
  TimeProperties time = {};
  std::uint8_t grandmaster_priority1 = 248;
  ClockQuality grandmaster_quality = {};
  std::uint8_t grandmaster_priority2 = 248;
  ClockIdentity grandmaster = {};
  std::uint16_t steps_removed = 0;
  std::vector<ClockIdentity> path_trace = {};  // grandmaster first
  bool operator==(const Announce&) const = default;
};

/// gPTP-capable TLV (10.6.4.4).
struct GptpCapable {
  std::int8_t log_interval = 0;  // of the messages that carry it
  std::uint8_t flags = 0;
  bool operator==(const GptpCapable&) const = default;
};

/// Message-interval request TLV (10.6.4.3): what the neighbour is asked to send, as logarithms; see MessageInterval for
/// values that are no intervals.
struct IntervalRequest {
  std::int8_t link_delay = -128;
  std::int8_t time_sync = -128;
  std::int8_t announce = -128;
  std::uint8_t flags = 0x07;  // computeNeighborRateRatio, computeMeanLinkDelay, oneStepReceiveCapable
  bool operator==(const IntervalRequest&) const = default;
};

struct Signaling {
  Header header = {};
  PortIdentity target = PortIdentity::all();
  std::optional<GptpCapable> capable = {};
  std::optional<IntervalRequest> request = {};
  bool operator==(const Signaling&) const = default;
};

using Message = std::variant<Sync, FollowUp, PdelayReq, PdelayResp, PdelayRespFollowUp, Announce, Signaling>;

inline const Header& header_of(const Message& message) {
  return std::visit([](const auto& each) -> const Header& { return each.header; }, message);
}
inline Header& header_of(Message& message) {
  return std::visit([](auto& each) -> Header& { return each.header; }, message);
}
/// Event messages are timestamped when they leave and when they arrive.
inline bool is_event(const Message& message) {
  return std::holds_alternative<Sync>(message) || std::holds_alternative<PdelayReq>(message) ||
         std::holds_alternative<PdelayResp>(message);
}

}  // namespace takt::models::gptp
