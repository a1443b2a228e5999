// SPDX-License-Identifier: Apache-2.0
// Plug and produce: which node has which role of a group. The master's part as a value without clock and network.
//
// Nodes announce themselves with their skills; a role needs one skill. The master binds roles to nodes while the group
// is Halted, and publishes the table of bindings. Rules: README.md, "Plug and produce".
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "handshake/participant.hpp"

namespace takt::handshake {

inline constexpr std::size_t most_roles = 64;
inline constexpr std::size_t most_candidates = 64;
inline constexpr std::size_t most_skills = 8;

/// A skill's name as it goes over the network; 0 is none. FNV-1a of the name.
using SkillId = std::uint32_t;
SkillId skill_id(std::string_view name);

/// Lives of a node have 24 bits and an order as of serial numbers. 0 is none.
constexpr bool is_later_life(std::uint32_t life, std::uint32_t than) {
  return static_cast<std::int32_t>((life - than) << 8) > 0;
}
constexpr bool is_life(std::uint32_t life) { return life >= 1 && life <= 0xFF'FFFF; }
constexpr std::uint32_t next_life(std::uint32_t life) { return life % 0xFFFFFFU + 1; }

/// What a node says of itself. A life serves in one role once: whoever was let go begins another one.
struct Announcement {
  std::uint32_t life = 0;                     ///< never 0; a later one after each restart and after each release
  bool leaving = false;                       ///< asks to be let go
  std::array<SkillId, most_skills> skills{};  ///< 0: no more
  bool operator==(const Announcement&) const = default;
};

/// Who has a role.
struct Binding {
  static constexpr std::uint8_t nobody = 0xFF;
  std::uint8_t candidate = nobody;
  std::uint32_t life = 0;
  bool bound() const { return candidate != nobody; }
  bool operator==(const Binding&) const = default;
};

/// The incarnation of a participant that a candidate's life is: no two candidates have the same one.
constexpr std::uint32_t incarnation_of(std::uint8_t candidate, std::uint32_t life) { return life << 8 | candidate; }

/// What the binder looks at in its master.
struct MasterView {
  PublishedState state = PublishedState::Halted;
  bool runs = false;         ///< is being started or Running
  PeerSet heard_halted = 0;  ///< peers whose last word said Halted
};

template <std::size_t MaxPeers>
MasterView master_view_of(const Participant<MaxPeers>& master) {
  MasterView view;
  view.state = master.state();
  view.runs = view.state == PublishedState::Running ||
              (view.state != PublishedState::Halted && master.intent().kind == IntentKind::Start);
  for (std::size_t peer = 0; peer < master.peer_count(); ++peer)
    if (master.peer_heard_in(peer, PublishedState::Halted)) view.heard_halted |= PeerSet{1} << peer;
  return view;
}

class Binder {
 public:
  /// `roles`: the skill that each role needs. `restarts`: starts the group again when a node that was lost in a start
  /// or in a run has been replaced.
  Binder(std::span<const SkillId> roles, std::size_t candidates, bool restarts);

  /// False for one that says nothing, because a later life is known. Only what says something keeps `silent` away: if
  /// nobody is heard of the later life, it was made up, or the clock that had given it was set back.
  bool announced(std::uint8_t candidate, const Announcement& announcement);
  /// Nothing was announced within the time-out.
  void silent(std::uint8_t candidate);
  /// The node that has this role has fallen silent as a participant.
  void role_silent(std::size_t role);

  /// What the master's participant must be told now; nothing if all is settled. Ask again after each of its steps.
  /// PeerReplaced says that the binding of that peer's role has changed.
  std::optional<Input> next(const MasterView& master);

  /// A client has called a method at the master: what it wants goes before a start that is still to come.
  void called() { restart_wanted_ = false; }

  std::size_t roles() const { return role_count_; }
  std::size_t candidates() const { return candidate_count_; }
  const Binding& binding(std::size_t role) const { return bindings_[role]; }
  std::span<const Binding> bindings() const { return {bindings_.data(), role_count_}; }
  /// The last life of a candidate that was let go, 0 if none: it goes into the table, or one that has never heard that
  /// it was bound would wait for ever.
  std::uint32_t used_life(std::uint8_t candidate) const { return candidates_[candidate].used_life; }
  /// All roles are bound to nodes that are there: a Start can succeed.
  bool complete() const;
  /// Announced, not leaving and not used up.
  bool present(std::uint8_t candidate) const;

  bool operator==(const Binder&) const = default;

 private:
  struct Candidate {
    Announcement last;
    std::uint32_t used_life = 0;  ///< the latest that was bound and let go; 0: none
    bool here = false;
    bool operator==(const Candidate&) const = default;
  };
  bool offers(std::uint8_t candidate, SkillId skill) const;
  bool is_lost(std::size_t role) const;
  void release(std::size_t role);
  void bind();

  std::uint8_t role_count_ = 0;
  std::uint8_t candidate_count_ = 0;
  bool restarts_ = false;
  bool restart_wanted_ = false;
  bool was_running_ = false;                    ///< when it was looked at last
  PeerSet changed_ = 0;                         ///< roles whose peer must be replaced
  std::array<SkillId, most_roles> skills_{};    ///< by role
  std::array<Binding, most_roles> bindings_{};  ///< by role
  std::array<Candidate, most_candidates> candidates_{};
};

/// A node that offers its skills, as a value: what it announces, and which role it has.
class Candidate {
 public:
  enum class Change : std::uint8_t { none, bound, released };

  /// `life`: the first one; a restarted node begins with another.
  Candidate(std::uint8_t number, std::uint32_t life, std::span<const SkillId> skills);

  void join() { joined_ = true, announcement_.leaving = false; }
  /// Asks to be let go; silent from then on.
  void leave();
  /// The master's table has come: its bindings by role, and the used life of this candidate (Binder::used_life).
  /// Released: the participant is to be dropped, Bound: another one begins, in `role`.
  Change table(std::span<const Binding> bindings, std::uint32_t used_life);

  bool announces() const { return joined_; }
  const Announcement& announcement() const { return announcement_; }
  /// From 0.
  std::optional<std::uint8_t> role() const { return role_; }
  std::uint32_t incarnation() const { return incarnation_of(number_, announcement_.life); }

  bool operator==(const Candidate&) const = default;

 private:
  std::uint8_t number_;
  bool joined_ = false;
  std::optional<std::uint8_t> role_;
  Announcement announcement_;
};

}  // namespace takt::handshake
