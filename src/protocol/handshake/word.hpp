// SPDX-License-Identifier: Apache-2.0
// The word: what a participant of a distributed Program publishes about itself.
//
// `robust` publishes all of it; `paper` publishes the state as one integer and leaves the rest at its default.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "handshake/intent.hpp"
#include "program/machine.hpp"

namespace takt::handshake {

/// The state as others see it: the four StateNumbers of OPC UA, and Halted.INIT with the next free number.
enum class PublishedState : std::uint8_t { Halted = 11, Ready = 12, Running = 13, Suspended = 14, HaltedInit = 15 };

inline constexpr std::size_t published_state_count = 5;
inline constexpr std::array<std::string_view, published_state_count> published_state_names{"Halted", "Ready", "Running",
                                                                                           "Suspended", "Halted.INIT"};

/// Position in tables over all published states, 0 to 4.
constexpr std::size_t index_of(PublishedState state) {
  return static_cast<std::size_t>(state) - static_cast<std::size_t>(PublishedState::Halted);
}
constexpr PublishedState published_state_at(std::size_t index) {
  return static_cast<PublishedState>(index + static_cast<std::size_t>(PublishedState::Halted));
}
constexpr std::string_view name_of(PublishedState state) { return published_state_names[index_of(state)]; }

/// The published state with this integer; nothing if there is none (a foreign or damaged message).
constexpr std::optional<PublishedState> published_state_from_number(std::uint32_t number) {
  if (number < static_cast<std::uint32_t>(PublishedState::Halted)) return std::nullopt;
  if (number > static_cast<std::uint32_t>(PublishedState::HaltedInit)) return std::nullopt;
  return static_cast<PublishedState>(number);
}

/// The state of the base machine: INIT belongs to Halted.
constexpr program::State base_state(PublishedState state) {
  return state == PublishedState::HaltedInit ? program::State::Halted
                                             : static_cast<program::State>(static_cast<std::uint8_t>(state));
}

constexpr PublishedState published_state(const program::Machine& machine) {
  return machine.initialising() ? PublishedState::HaltedInit
                                : static_cast<PublishedState>(program::number_of(machine.state()));
}

/// Two handshakes: that of the paper, and one that agrees on intents (participant.hpp).
enum class Variant : std::uint8_t { paper, robust };

struct Word {
  std::uint32_t incarnation = 0;  ///< of the sender; another one after each restart, none used twice
  std::uint32_t run = 0;          ///< in which the sender is, or was, Ready; 0 if none
  PublishedState state = PublishedState::Halted;
  Intent intent;  ///< the greatest that the sender knows

  constexpr Word() = default;
  constexpr Word(std::uint32_t of_incarnation, PublishedState in_state, const Intent& of_intent, std::uint32_t in_run)
      : incarnation(of_incarnation), run(in_run), state(in_state), intent(of_intent) {}

  constexpr bool operator==(const Word&) const = default;
};

namespace detail {
inline constexpr std::array<PublishedState, intent_kind_count> goals{PublishedState::Running,   PublishedState::Running,
                                                                     PublishedState::Suspended, PublishedState::Ready,
                                                                     PublishedState::Ready,     PublishedState::Halted};
}  // namespace detail

/// The state that an intent names as the goal of the whole group.
constexpr PublishedState goal_of(IntentKind kind) { return detail::goals[index_of(kind)]; }

/// Whether one who holds an intent, which is valid by itself, can be in this state and in this run (README.md,
/// "Words"): whoever follows an intent does so at once.
constexpr bool may_hold(const Intent& intent, PublishedState state, std::uint32_t run) {
  if (intent.kind == IntentKind::Halt) return state == PublishedState::Halted && run == 0;
  if (intent.kind != IntentKind::Start) return state == goal_of(intent.kind) && run == intent.run;
  switch (state) {
    case PublishedState::HaltedInit:
      return run == 0;
    case PublishedState::Ready:
      return is_run(run);  // or that of the run before, while others are not there yet
    case PublishedState::Running:
      return run == intent.run;
    default:
      return false;
  }
}

/// Whether there is such an intent in a group with so many slaves.
constexpr bool is_valid(const Intent& intent, std::size_t slaves) {
  if (index_of(intent.kind) >= intent_kind_count || intent.origin > slaves) return false;
  if (intent.number == 0) return intent == Intent{};
  if (intent.kind == IntentKind::Halt) return intent.run == 0;
  return is_run(intent.run) && (intent.kind != IntentKind::Start ||
                                (intent.origin == 0 && intent.run == run_of(intent.run >> 16, intent.number)));
}

/// Whether a participant of a group with so many slaves can say this word: every field by itself, and what they say
/// together. One that is not is hostile or damaged, not takt's error, and nothing of it is believed. `paper` says its
/// state only.
constexpr bool is_valid(const Word& word, Variant variant, std::size_t slaves) {
  if (!published_state_from_number(static_cast<std::uint32_t>(word.state))) return false;
  return variant == Variant::paper || (is_valid(word.intent, slaves) && may_hold(word.intent, word.state, word.run));
}

}  // namespace takt::handshake
