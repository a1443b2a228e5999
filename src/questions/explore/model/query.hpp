// SPDX-License-Identifier: Apache-2.0
// What is asked of an exploration: which group, what the adversary may do, and how far to look.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "handshake/participant.hpp"

namespace takt::explore {

/// The classes of faults. Each fault costs one of the budget of a run.
enum class Fault : std::uint8_t { loss, duplicate, reorder, crash, restart, timeout, forge, replay };

inline constexpr std::size_t fault_count = 8;
inline constexpr std::array<std::string_view, fault_count> fault_names{"loss",    "duplicate", "reorder", "crash",
                                                                       "restart", "timeout",   "forge",   "replay"};
constexpr std::string_view name_of(Fault fault) { return fault_names[static_cast<std::size_t>(fault)]; }

struct FaultSet {
  std::uint8_t bits = 0;
  constexpr bool contains(Fault fault) const { return ((bits >> static_cast<unsigned>(fault)) & 1U) != 0; }
  constexpr void insert(Fault fault) { bits = static_cast<std::uint8_t>(bits | 1U << static_cast<unsigned>(fault)); }
  constexpr bool operator==(const FaultSet&) const = default;
};

inline constexpr std::size_t most_slaves = 4;
/// Of a star that is explored in parts (parts/parts_model.hpp), where slaves have no names.
inline constexpr std::size_t most_equal_slaves = 12;
inline constexpr std::uint32_t most_commands = 12;
inline constexpr std::uint32_t most_faults = 7;
inline constexpr std::uint64_t most_states = 0xFFFF'FFF0ULL;

/// How words travel. `registers`: each channel holds the last published word, as cyclic publishing and sampling does.
/// `channels`: each channel holds the messages in flight, at most `capacity`, and each is heard once.
enum class Network : std::uint8_t { registers, channels };
/// Where runs begin: in every state in which a group can rest, or only where everybody has just been switched on.
enum class Beginnings : std::uint8_t { all, switched_on };

inline constexpr std::uint8_t most_capacity = 4;
/// With all-to-all subscription a group has n (n + 1) channels.
inline constexpr std::size_t most_slaves_all_to_all = 3;
/// With an inner group: outer slaves, of which the last one is the node, and slaves of the inner group.
inline constexpr std::size_t most_outer_slaves = 2;
inline constexpr std::size_t most_inner_slaves = 2;

/// A group with roles.
inline constexpr std::size_t most_explored_roles = 2;
inline constexpr std::size_t most_explored_candidates = 3;
inline constexpr std::size_t most_inner_candidates = 2;

struct Query {
  handshake::Variant variant = handshake::Variant::robust;
  std::uint8_t slaves =
      1;  ///< 1 to most_slaves, in parts to most_equal_slaves, with all-to-all subscription to most_slaves_all_to_all
  handshake::Subscription subscription = handshake::Subscription::star;
  Network network = Network::registers;
  std::uint8_t capacity = 2;  ///< `channels`: messages in flight in each of them, 1 to most_capacity
  Beginnings beginnings = Beginnings::all;
  FaultSet faults;
  std::uint32_t fault_budget = 1;      ///< faults in a run, of all classes together
  std::uint32_t commands = 2;          ///< accepted method calls and ends of the Program in a run, after its beginning
  bool finishes = true;                ///< Programs may end by themselves; each end counts as a call
  std::uint32_t depth = ~0U;           ///< steps after the beginning
  std::uint64_t states = 100'000'000;  ///< to store at most
  bool symmetry = true;                ///< slaves that play the same part are one state
  std::uint8_t inner_slaves =
      0;                 ///< 0: one group. Else the last slave is the master of an inner group with so many slaves
  bool joining = false;  ///< the last slave (of the inner group, if there is one) is down at the beginning, and comes
                         ///< up at any time or never
  std::uint8_t candidates = 0;  ///< 0: fixed slaves. Else so many nodes may have the roles: the places of the slaves,
                                ///< with an inner group of its slaves
  std::array<std::uint8_t, most_explored_candidates> offers{
      0xFF, 0xFF, 0xFF};       ///< by candidate: the roles that it can have, bit i for role i
  std::uint8_t joined = 0xFF;  ///< candidates that announce themselves when they are switched on, bit i for candidate i
  bool starts_again =
      false;               ///< the master starts the group again when a node that was lost in a run has been replaced
  bool is_signed = false;  ///< with the fault `replay`: who hears a message takes it only if it is newer than all that
                           ///< it took of its sender, and its key is known
  std::uint8_t key_changes = 0;  ///< signed: of a run, at any time at each participant, 0 to most_key_changes
  bool operator==(const Query&) const = default;
  /// What was said is kept with each state, for a stranger who replays: `robust`, registers, one group, no delayed
  /// copies, slaves told apart.
  bool has_recordings() const { return faults.contains(Fault::replay); }
  /// Explored by the model of groups with roles (roles_model.hpp): `robust`, star, registers, no delayed copies.
  bool has_roles() const { return candidates != 0; }
  bool nested() const { return inner_slaves != 0; }
  /// Roles are those of the inner group, if there is one.
  std::uint8_t roles() const { return nested() ? inner_slaves : slaves; }
  /// Explored by the model of groups in groups (tree_model.hpp): `robust`, star, registers, no delayed copies, slaves
  /// told apart.
  bool is_tree() const { return (nested() && !has_roles()) || joining; }
  /// It can be explored in parts: a star of equal slaves on sampled registers, without a stranger.
  bool can_have_parts() const {
    return variant == handshake::Variant::robust && subscription == handshake::Subscription::star &&
           network == Network::registers && !faults.contains(Fault::forge) && !has_recordings() && !has_roles() &&
           !is_tree();
  }
  /// It is explored so.
  bool has_parts() const { return slaves > most_slaves && can_have_parts(); }
  /// Somebody may fall silent, so that F1 says something.
  constexpr bool asks_for_silence() const {
    return joining || (fault_budget > 0 && (faults.contains(Fault::crash) || faults.contains(Fault::timeout)));
  }
};

}  // namespace takt::explore
