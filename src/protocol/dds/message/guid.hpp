// SPDX-License-Identifier: Apache-2.0
// Who is who in RTPS (DDSI-RTPS 8.2.4, 9.3.1): participants, and entities within a participant.
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <string>

namespace takt::dds {

/// Names a participant. The first two octets are its vendor's id, as 9.3.1.5 asks for.
struct GuidPrefix {
  std::array<std::uint8_t, 12> octets{};
  constexpr auto operator<=>(const GuidPrefix&) const = default;
  constexpr bool is_unknown() const { return *this == GuidPrefix{}; }
};

/// The last octet of an EntityId, without the bits that say who made the entity (9.3.1.2).
enum class EntityKind : std::uint8_t {
  unknown = 0x00,
  participant = 0x01,
  writer_with_key = 0x02,
  writer_no_key = 0x03,
  reader_no_key = 0x04,
  reader_with_key = 0x07,
  writer_group = 0x08,
  reader_group = 0x09,
};

/// Three octets of key and one of kind; `value` is what they are as a big-endian number, so that printed ids look as in
/// the standard.
struct EntityId {
  std::uint32_t value = 0;

  /// An entity of the user (not built in); `key` has 24 bits.
  static constexpr EntityId user(std::uint32_t key, EntityKind kind) {
    return {(key & 0xFF'FFFFU) << 8 | static_cast<std::uint32_t>(kind)};
  }

  constexpr auto operator<=>(const EntityId&) const = default;
  constexpr std::uint32_t key() const { return value >> 8; }
  constexpr EntityKind kind() const { return static_cast<EntityKind>(value & 0x3F); }
  constexpr bool is_built_in() const { return (value & 0xC0) == 0xC0; }
  constexpr bool is_unknown() const { return value == 0; }
  constexpr bool is_writer() const {
    return kind() == EntityKind::writer_with_key || kind() == EntityKind::writer_no_key;
  }
  constexpr bool is_reader() const {
    return kind() == EntityKind::reader_with_key || kind() == EntityKind::reader_no_key;
  }
  constexpr bool has_key() const {
    return kind() == EntityKind::writer_with_key || kind() == EntityKind::reader_with_key;
  }
};

/// The built-in entities (9.3.1.3, table 9.2).
namespace entity_id {
inline constexpr EntityId unknown{0};
inline constexpr EntityId participant{0x0001C1};
inline constexpr EntityId spdp_writer{0x0100C2};
inline constexpr EntityId spdp_reader{0x0100C7};
inline constexpr EntityId sedp_publications_writer{0x0003C2};
inline constexpr EntityId sedp_publications_reader{0x0003C7};
inline constexpr EntityId sedp_subscriptions_writer{0x0004C2};
inline constexpr EntityId sedp_subscriptions_reader{0x0004C7};
inline constexpr EntityId participant_message_writer{0x0200C2};
inline constexpr EntityId participant_message_reader{0x0200C7};
}  // namespace entity_id

/// Names an entity in the whole world; ordered by value, which is the deterministic order of all that is matched.
struct Guid {
  GuidPrefix prefix;
  EntityId entity;
  constexpr auto operator<=>(const Guid&) const = default;
  constexpr bool is_unknown() const { return *this == Guid{}; }
};

/// "01020304.05060708.090a0b0c" and "....|000001c1", as tools write them.
std::string to_string(const GuidPrefix& prefix);
std::string to_string(EntityId id);
std::string to_string(const Guid& guid);

}  // namespace takt::dds
