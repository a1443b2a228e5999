// SPDX-License-Identifier: Apache-2.0
// What participants tell about themselves and their endpoints (DDSI-RTPS 8.5.3, 8.5.4, 9.6.2.2), as values and as
// PL_CDR.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dds/message/submessage.hpp"
#include "dds/qos/matching.hpp"
#include "dds/qos/policies.hpp"

namespace takt::dds {

/// BuiltinEndpointSet_t (9.3.2.10).
namespace builtin_endpoint {
inline constexpr std::uint32_t participant_announcer = 1U << 0;
inline constexpr std::uint32_t participant_detector = 1U << 1;
inline constexpr std::uint32_t publications_announcer = 1U << 2;
inline constexpr std::uint32_t publications_detector = 1U << 3;
inline constexpr std::uint32_t subscriptions_announcer = 1U << 4;
inline constexpr std::uint32_t subscriptions_detector = 1U << 5;
inline constexpr std::uint32_t participant_message_writer = 1U << 10;
inline constexpr std::uint32_t participant_message_reader = 1U << 11;
inline constexpr std::uint32_t spdp = participant_announcer | participant_detector;
inline constexpr std::uint32_t sedp =
    publications_announcer | publications_detector | subscriptions_announcer | subscriptions_detector;
inline constexpr std::uint32_t participant_message = participant_message_writer | participant_message_reader;
}  // namespace builtin_endpoint

/// SPDPdiscoveredParticipantData.
struct ParticipantData {
  ProtocolVersion version;
  VendorId vendor = takt_vendor;
  Guid guid;  ///< its entity is entity_id::participant
  std::optional<std::uint32_t> domain;
  sim::Duration lease_duration =
      sim::Duration::from_ps(100'000'000'000'000);  ///< 100 s, what holds where nothing is told
  std::uint32_t builtin_endpoints =
      builtin_endpoint::spdp | builtin_endpoint::sedp | builtin_endpoint::participant_message;
  std::vector<Locator> metatraffic_unicast;
  std::vector<Locator> metatraffic_multicast;
  std::vector<Locator> default_unicast;
  std::vector<Locator> default_multicast;
  std::uint32_t manual_liveliness_count = 0;
  bool expects_inline_qos = false;
  std::string entity_name;
  OpaqueData user_data;
  bool operator==(const ParticipantData&) const = default;
};

/// What DiscoveredWriterData and DiscoveredReaderData have in common.
struct EndpointData {
  Guid guid;
  Guid participant;  ///< unknown: the one whose prefix the guid has
  std::string topic_name;
  std::string type_name;
  std::vector<Locator> unicast;  ///< none: the default ones of its participant
  std::vector<Locator> multicast;
  std::vector<DataRepresentation> representations;  ///< none: XCDR1
  std::optional<std::uint32_t> type_max_size;
  Guid persistence_guid;  ///< the name that survives restarts; unknown: it has none
  std::string entity_name;
  bool operator==(const EndpointData&) const = default;
};

struct PublicationData {
  EndpointData endpoint;
  DataWriterQos qos;
  bool operator==(const PublicationData&) const = default;
};

/// ContentFilterProperty_t (9.6.4.1) of the filter class "DDSSQL" without parameters. The reader filters; writers send
/// it all samples.
struct ContentFilterProperty {
  std::string topic_name;     ///< of the content-filtered topic
  std::string related_topic;  ///< whose samples are filtered
  std::string expression;
  bool operator==(const ContentFilterProperty&) const = default;
};

struct SubscriptionData {
  EndpointData endpoint;
  DataReaderQos qos;
  bool expects_inline_qos = false;
  std::optional<ContentFilterProperty> content_filter = {};
  bool operator==(const SubscriptionData&) const = default;
};

Matching match(const PublicationData& publication, const SubscriptionData& subscription);

/// ParticipantMessageData (8.4.13): a participant is alive.
struct ParticipantMessageData {
  enum class Kind : std::uint32_t { unknown = 0, automatic = 1, manual = 2 };
  GuidPrefix prefix;
  Kind kind = Kind::automatic;
  std::vector<std::byte> data;
  bool operator==(const ParticipantMessageData&) const = default;
};

/// Whether data of discovery was taken, or why not.
enum class DataVerdict : std::uint8_t {
  ok,
  representation,  ///< not PL_CDR (of a ParticipantMessage: not CDR)
  truncated,       ///< ends before its sentinel
  malformed,       ///< a value that contradicts itself or the standard
  incomplete,      ///< no GUID, or no name of topic or type
  not_understood,  ///< a parameter that is not known and must be
};
std::string_view name_of(DataVerdict verdict);

// Each as a serialized payload, little-endian, into the caller's octets; nothing if it does not fit. QoS policies that
// have their default value are left out, as is usual, but for the reliability.
Octets encode(std::span<std::byte> target, const ParticipantData& data);
Octets encode(std::span<std::byte> target, const PublicationData& data);
Octets encode(std::span<std::byte> target, const SubscriptionData& data);
Octets encode(std::span<std::byte> target, const ParticipantMessageData& data);
/// The key alone, for what disposes and unregisters: of a participant or of an endpoint, as the entity of the GUID
/// says.
Octets encode_key(std::span<std::byte> target, const Guid& guid);

// Parameters that are not known are passed over. What is not ok leaves the data as far as it was read.
DataVerdict decode(Octets payload, ParticipantData& data);
DataVerdict decode(Octets payload, PublicationData& data);
DataVerdict decode(Octets payload, SubscriptionData& data);
DataVerdict decode(Octets payload, ParticipantMessageData& data);
DataVerdict decode_key(Octets payload, Guid& guid);

/// The instance's name where key hashes are asked for: the GUID.
KeyHash key_hash_of(const Guid& guid);
Guid guid_of(const KeyHash& hash);

}  // namespace takt::dds
