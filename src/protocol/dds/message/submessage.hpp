// SPDX-License-Identifier: Apache-2.0
// The submessages of RTPS as plain values (DDSI-RTPS 8.3.7, 9.4.5). Payloads are views of octets that somebody else
// owns.
#pragma once

#include <array>
#include <optional>
#include <variant>
#include <vector>

#include "dds/message/guid.hpp"
#include "dds/message/locator.hpp"
#include "dds/message/octets.hpp"
#include "dds/message/sequence_number.hpp"
#include "dds/message/time.hpp"

namespace takt::dds {

struct ProtocolVersion {
  std::uint8_t major = 2;
  std::uint8_t minor = 1;  ///< what every implementation in use understands
  constexpr auto operator<=>(const ProtocolVersion&) const = default;
};

struct VendorId {
  std::uint16_t value = 0;  ///< 0 is unknown
  constexpr auto operator<=>(const VendorId&) const = default;
};

/// takt has no id of the OMG. 0x01FA lies behind all that are assigned (0x0101 to 0x0115 in 2025); 0x0000 would mean
/// "unknown", which some receivers drop.
inline constexpr VendorId takt_vendor{0x01FA};

/// The header of each message (8.3.3): who sends.
struct MessageHeader {
  ProtocolVersion version;
  VendorId vendor = takt_vendor;
  GuidPrefix prefix;
  bool operator==(const MessageHeader&) const = default;
};

enum class SubmessageKind : std::uint8_t {
  pad = 0x01,
  ack_nack = 0x06,
  heartbeat = 0x07,
  gap = 0x08,
  info_timestamp = 0x09,
  info_source = 0x0C,
  info_reply_ip4 = 0x0D,
  info_destination = 0x0E,
  info_reply = 0x0F,
  nack_frag = 0x12,
  heartbeat_frag = 0x13,
  data = 0x15,
  data_frag = 0x16,
};

using KeyHash = std::array<std::uint8_t, 16>;

/// PID_STATUS_INFO (9.6.3.9): what a change does to its instance.
namespace status_info {
inline constexpr std::uint32_t disposed = 1;
inline constexpr std::uint32_t unregistered = 2;
}  // namespace status_info

/// PID_ORIGINAL_WRITER_INFO: who wrote a change that a persistence service brings, and as which of its changes.
struct OriginalWriter {
  Guid writer;
  SequenceNumber number;
  bool operator==(const OriginalWriter&) const = default;
};

/// Parameters that travel with a change; others are skipped. The key hash is the instance's name where the payload does
/// not tell it.
struct InlineQos {
  std::optional<std::uint32_t> status_info;
  std::optional<KeyHash> key_hash;
  std::optional<OriginalWriter> original_writer = std::nullopt;
  bool operator==(const InlineQos&) const = default;
  bool is_empty() const { return !status_info && !key_hash && !original_writer; }
};

enum class PayloadKind : std::uint8_t {
  none,
  data,  ///< the whole sample
  key,   ///< only the key fields: the sample disposes or unregisters
};

struct Pad {
  bool operator==(const Pad&) const = default;
};

/// One change.
struct Data {
  EntityId reader;  ///< unknown: all that are matched
  EntityId writer;
  SequenceNumber sequence_number;
  InlineQos inline_qos;
  PayloadKind payload_kind = PayloadKind::none;
  Octets payload;  ///< encapsulation header and CDR; any length, filled up to a multiple of 4 when written
};

/// One or more neighbouring fragments of a change.
struct DataFrag {
  EntityId reader;
  EntityId writer;
  SequenceNumber sequence_number;
  InlineQos inline_qos;
  PayloadKind payload_kind = PayloadKind::data;  ///< data or key
  FragmentNumber first_fragment{1};
  std::uint16_t fragment_count = 1;  ///< in this submessage
  std::uint16_t fragment_size = 0;   ///< of all but the last one
  std::uint32_t sample_size = 0;     ///< of the whole sample with its encapsulation header
  Octets payload;                    ///< the fragments
};

/// What a writer has: all from `first` to `last` (nothing if `last` is the one before `first`).
struct Heartbeat {
  EntityId reader;
  EntityId writer;
  SequenceNumber first{1};
  SequenceNumber last{0};
  std::uint32_t count = 0;
  bool is_final = false;       ///< no answer is needed
  bool is_liveliness = false;  ///< asserts the writer's liveliness by hand
  bool operator==(const Heartbeat&) const = default;
};

struct HeartbeatFrag {
  EntityId reader;
  EntityId writer;
  SequenceNumber sequence_number;
  FragmentNumber last_fragment;
  std::uint32_t count = 0;
  bool operator==(const HeartbeatFrag&) const = default;
};

/// A reader has all below the base and asks for the members of the set.
struct AckNack {
  EntityId reader;
  EntityId writer;
  SequenceNumberSet missing{first_sequence_number};
  std::uint32_t count = 0;
  bool is_final = false;  ///< no answer is needed
  bool operator==(const AckNack&) const = default;
};

struct NackFrag {
  EntityId reader;
  EntityId writer;
  SequenceNumber sequence_number;
  FragmentNumberSet missing{FragmentNumber{1}};
  std::uint32_t count = 0;
  bool operator==(const NackFrag&) const = default;
};

/// Changes that do not come (any more): `start` to before the base of `list`, and the members of `list`.
struct Gap {
  EntityId reader;
  EntityId writer;
  SequenceNumber start{1};
  SequenceNumberSet list{first_sequence_number};
  bool operator==(const Gap&) const = default;
};

/// The source timestamp of what follows; nothing: of what follows none is known.
struct InfoTimestamp {
  std::optional<Time> time;
  bool operator==(const InfoTimestamp&) const = default;
};

/// What follows comes from another participant.
struct InfoSource {
  ProtocolVersion version;
  VendorId vendor;
  GuidPrefix prefix;
  bool operator==(const InfoSource&) const = default;
};

/// What follows is for this participant alone; unknown: for all again.
struct InfoDestination {
  GuidPrefix prefix;
  bool operator==(const InfoDestination&) const = default;
};

/// Where answers to what follows go.
struct InfoReply {
  std::vector<Locator> unicast;
  std::optional<std::vector<Locator>> multicast;
  bool operator==(const InfoReply&) const = default;
};

using Submessage = std::variant<Pad, Data, DataFrag, Heartbeat, HeartbeatFrag, AckNack, NackFrag, Gap, InfoTimestamp,
                                InfoSource, InfoDestination, InfoReply>;

}  // namespace takt::dds
