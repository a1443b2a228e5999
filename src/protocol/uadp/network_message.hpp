// SPDX-License-Identifier: Apache-2.0
// NetworkMessage: what one frame or datagram carries (OPC 10000-14, 7.2.4.4).
//
// Decoded, it is a view of octets that somebody else owns. UADP has no total length: what stands behind the last
// DataSetMessage (padding of Ethernet) belongs to nobody.
#pragma once

#include <optional>

#include "uadp/decode_status.hpp"
#include "uadp/publisher_id.hpp"
#include "uadp/value.hpp"

namespace takt::uadp {

/// OPC 10000-14, 7.2.4.4.2; the value is the code in ExtendedFlags2, bits 2 to 4.
enum class NetworkMessageType : std::uint8_t { DataSetMessages, DiscoveryProbe, DiscoveryAnnouncement };

struct GroupHeader {
  std::optional<std::uint16_t> writer_group_id;
  std::optional<std::uint32_t> group_version;           ///< VersionTime: seconds since 2000-01-01 UTC
  std::optional<std::uint16_t> network_message_number;  ///< 1, 2, ... within a PublishingInterval
  std::optional<std::uint16_t> sequence_number;         ///< of the group's NetworkMessages; wraps
  bool operator==(const GroupHeader&) const = default;
};

/// Recognised so that the message can be refused by its name. No key, nonce or signature is looked at.
struct SecurityHeader {
  std::uint8_t flags = 0;  ///< 1 signed, 2 encrypted, 4 footer, 8 force key reset
  std::uint32_t token_id = 0;
  Octets nonce;
  std::uint16_t footer_size = 0;
};

/// All that stands before the payload, but for the DataSetWriterIds.
struct NetworkMessageHeader {
  std::optional<PublisherId> publisher_id;
  std::optional<Guid> data_set_class_id;
  std::optional<GroupHeader> group;
  std::optional<DateTime> timestamp;
  std::optional<std::uint16_t> picoseconds;  ///< 10 ps, 0 to 9999
  std::optional<Octets> promoted_fields;     ///< Variants, one behind the other
};

struct NetworkMessage {
  NetworkMessageType type = NetworkMessageType::DataSetMessages;
  NetworkMessageHeader header;
  std::optional<SecurityHeader> security;
  /// UInt16 each; nothing if there is no PayloadHeader, and then the receiver must know what the payload holds.
  std::optional<Octets> writer_ids;
  Octets sizes;                    ///< UInt16 each, of two and more DataSetMessages; else empty
  Octets payload;                  ///< the DataSetMessages and what may stand behind them
  std::size_t payload_offset = 0;  ///< of `payload` in the NetworkMessage

  /// DataSetMessages of the payload; 1 without a PayloadHeader (others follow only by configuration).
  std::size_t count() const { return writer_ids ? writer_ids->size() / 2 : 1; }
  std::optional<std::uint16_t> writer_id(std::size_t index) const {
    if (!writer_ids) return std::nullopt;
    return load_little_endian<std::uint16_t>(writer_ids->data() + 2 * index);
  }
  /// The octets of a DataSetMessage; of a single one all the rest.
  Octets data_set_message(std::size_t index) const;
};

/// Reads the headers and finds the DataSetMessages; `message` is meaningful as far as the verdict lets it be: with
/// `secured`, `chunked`, `discovery` and `action` the PublisherId is.
DecodeStatus decode(Octets octets, NetworkMessage& message);

}  // namespace takt::uadp
