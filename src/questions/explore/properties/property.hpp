// SPDX-License-Identifier: Apache-2.0
// The properties that an exploration decides.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace takt::explore {

/// The first nine must always hold; the others must be reached sometimes, or a proof says nothing.
enum class Property : std::uint8_t {
  S1,
  S2,
  S3,
  S4,
  S5,
  F1,
  L1,
  B1,
  R1,
  all_running,
  T1,
  T2,
  T3,
  T4,
  T5,
  T6,
  T7,
  T8,
  T9,
  silence
};

inline constexpr std::size_t property_count = 20;
inline constexpr std::array<std::string_view, property_count> property_names{"S1",
                                                                             "S2",
                                                                             "S3",
                                                                             "S4",
                                                                             "S5",
                                                                             "F1",
                                                                             "L1",
                                                                             "B1",
                                                                             "R1",
                                                                             "all_running",
                                                                             "HaltedToReady",
                                                                             "ReadyToRunning",
                                                                             "RunningToHalted",
                                                                             "RunningToReady",
                                                                             "RunningToSuspended",
                                                                             "SuspendedToRunning",
                                                                             "SuspendedToHalted",
                                                                             "SuspendedToReady",
                                                                             "ReadyToHalted",
                                                                             "silence"};
inline constexpr std::array<std::string_view, property_count> property_texts{
    "nobody is Running in a run before all were Ready in it",
    "the master is Running only after all slaves were",
    "process data counts only between two that are Running in the same run",
    "from Halted to Running only through INIT",
    "only the nine transitions occur",
    "a silent peer halts everyone",
    "without new calls and faults all reach the state that was asked for",
    "a role is one node's, which offers its skill, and changes hands in Halted only",
    "a word that is older than one that has come of its sender moves nobody",
    "everybody is Running at once",
    "transition 1 fires",
    "transition 2 fires",
    "transition 3 fires",
    "transition 4 fires",
    "transition 5 fires",
    "transition 6 fires",
    "transition 7 fires",
    "transition 8 fires",
    "transition 9 fires",
    "a time-out expires at one who is not Halted"};

constexpr std::size_t index_of(Property property) { return static_cast<std::size_t>(property); }
constexpr std::string_view name_of(Property property) { return property_names[index_of(property)]; }
/// Asked only where somebody may crash or a time-out may expire.
constexpr bool is_of_silence(Property property) { return property == Property::F1 || property == Property::silence; }
/// Asked only of groups with roles.
constexpr bool is_of_roles(Property property) { return property == Property::B1; }
/// Asked only where a stranger replays what was said.
constexpr bool is_of_replays(Property property) { return property == Property::R1; }
constexpr bool must_always_hold(Property property) { return property <= Property::R1; }
constexpr Property transition_property(std::size_t number) {
  return static_cast<Property>(index_of(Property::T1) + number - 1);
}

/// A set of properties: violated, or reached.
struct PropertySet {
  std::uint32_t bits = 0;
  constexpr bool contains(Property property) const { return ((bits >> index_of(property)) & 1U) != 0; }
  constexpr void insert(Property property) { bits |= 1U << index_of(property); }
  constexpr void erase(Property property) { bits &= ~(1U << index_of(property)); }
  constexpr bool operator==(const PropertySet&) const = default;
};

enum class PropertyVerdict : std::uint8_t {
  holds,
  violated,
  reached,
  unreached,
  unknown,    ///< the search ended before it could be decided
  not_asked,  ///< nobody can fall silent here, so there is nothing to say about silence
};
inline constexpr std::array<std::string_view, 6> verdict_names{"holds",     "violated", "reached",
                                                               "unreached", "unknown",  "not asked"};
constexpr std::string_view name_of(PropertyVerdict verdict) { return verdict_names[static_cast<std::size_t>(verdict)]; }

}  // namespace takt::explore
