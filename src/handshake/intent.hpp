// What a group of distributed Programs has been told to do: the greatest intent that somebody knows.
//
// Intents are totally ordered and a participant's intent only grows, so loss, duplication and reordering of messages
// cannot undo an agreement. Rules: handshake/README.md.
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "program/method.hpp"

namespace takt::handshake {

/// The kinds in rising precedence: of two intents with the same number the later kind wins.
/// Finish stands above Suspend because one who has finished is Ready and cannot follow to Suspended, whereas one who is
/// Suspended can follow to Ready; below Reset only to have an order, for both lead to Ready.
enum class IntentKind : std::uint8_t { Start, Resume, Suspend, Finish, Reset, Halt };

inline constexpr std::size_t intent_kind_count = 6;
inline constexpr std::array<std::string_view, intent_kind_count> intent_kind_names{"start",  "resume", "suspend",
                                                                                   "finish", "reset",  "halt"};
constexpr std::size_t index_of(IntentKind kind) { return static_cast<std::size_t>(kind); }
constexpr std::string_view name_of(IntentKind kind) { return intent_kind_names[index_of(kind)]; }

/// The intent that a called method raises.
constexpr IntentKind kind_of(program::Method method) {
  constexpr std::array<IntentKind, program::methods.size()> kinds{
      IntentKind::Start, IntentKind::Suspend, IntentKind::Resume, IntentKind::Halt, IntentKind::Reset};
  return kinds[program::index_of(method)];
}

/// An intent of the group. The default one stands for "nothing was ever asked": number 0, and everybody is Halted.
/// The order is that of the fields from first to last.
struct Intent {
  std::uint32_t number = 0;             ///< 1 more than the greatest number that its origin knew
  IntentKind kind = IntentKind::Halt;
  std::uint8_t origin = 0;              ///< participant that raised it: 0 the master, 1..n the slaves
  std::uint32_t run = 0;                ///< the run it opens (Start) or belongs to; 0 for Halt

  constexpr auto operator<=>(const Intent&) const = default;
};

/// The identity of the run that a Start intent opens; never 0. It contains the master's incarnation, because a
/// restarted master may give a number a second time, and words of its former life must not count in the new run.
constexpr std::uint32_t run_of(std::uint32_t master_incarnation, std::uint32_t number) {
  return ((master_incarnation & 0xFFFFU) << 16) | ((number - 1) % 0xFFFFU + 1);
}

}  // namespace takt::handshake
