// SPDX-License-Identifier: Apache-2.0
// The messages of Programs with roles in UADP-Periodic-Fixed: announcements and the table of bindings. See README.md
// for the octets.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "handshake/binder.hpp"
#include "wire/program_format.hpp"

namespace takt::wire {

inline constexpr std::uint16_t announcement_writer_group = 0xFF00;
inline constexpr std::uint16_t table_writer_group = 0xFF01;

/// Octets of an announcement: life, leaving, skills.
inline constexpr std::uint32_t announcement_octets = fields_at + 4 + 1 + 4 * handshake::most_skills;
/// Octets of a table: the master's incarnation, candidate and life of each role, the used life of each candidate.
constexpr std::uint32_t table_octets(std::size_t roles, std::size_t candidates) {
  return fields_at + 4 + static_cast<std::uint32_t>(5 * roles + 4 * candidates);
}

/// What all nodes of the group must know alike.
struct RoleShape {
  ProgramShape program;                    ///< its participants are the master and the roles
  std::vector<handshake::SkillId> skills;  ///< that each role needs
  std::vector<std::string>
      candidates;  ///< names of the nodes that may have a role; their PublisherIds follow the participants'
};

struct AnnouncementMessage {
  std::uint8_t candidate = 0;
  std::uint16_t sequence = 0;
  handshake::Announcement announcement;
};

struct TableMessage {
  std::uint16_t sequence = 0;
  std::uint32_t incarnation = 0;                                       ///< of the master
  std::array<handshake::Binding, handshake::most_roles> bindings{};    ///< by role
  std::array<std::uint32_t, handshake::most_candidates> used_lives{};  ///< by candidate
};

/// Makes and reads them. Constant, so all nodes of a simulated group may share one.
class RoleFormat {
 public:
  explicit RoleFormat(RoleShape shape);

  const RoleShape& shape() const { return shape_; }
  std::size_t roles() const { return shape_.skills.size(); }
  std::size_t candidates() const { return announcements_.size(); }

  uadp::Octets encode(const AnnouncementMessage& message, std::span<std::byte> target) const;
  uadp::Octets encode(const TableMessage& message, std::span<std::byte> target) const;
  /// Nothing if the octets are neither, or say what nobody says.
  std::optional<std::variant<AnnouncementMessage, TableMessage>> decode(uadp::Octets octets) const;
  /// Why `decode` gives nothing for octets that are no message of the Program's participants either.
  Verdict refusal_of(uadp::Octets octets) const;

 private:
  std::optional<AnnouncementMessage> decode_announcement(uadp::Octets octets, std::uint8_t candidate) const;
  bool is_sound(const TableMessage& message) const;
  std::optional<TableMessage> decode_table(uadp::Octets octets) const;

  RoleShape shape_;
  std::vector<uadp::PeriodicFixedLayout> announcements_;  ///< by candidate
  std::vector<uadp::PeriodicFixedLayout> table_;          ///< the only one
};

}  // namespace takt::wire
