// SPDX-License-Identifier: Apache-2.0
// What a group of distributed Programs has been told to do: the greatest intent that somebody knows.
//
// Intents are ordered and a participant's intent only grows, so loss, duplication and reordering of messages cannot
// undo an agreement. Their numbers go round, so that no number, whoever has made it up, is the last one. Rules:
// handshake/README.md.
#pragma once

#include <array>
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

/// The number behind this one. 0 stands for "none" and is left out where the numbers begin again.
constexpr std::uint32_t next_number(std::uint32_t number) { return number == 0xFFFF'FFFFU ? 1 : number + 1; }

/// How one intent, or its number, stands to another one.
enum class Standing : std::uint8_t {
  same,
  later,
  earlier,
  apart,  ///< so far away that nobody can say which one is the later: of another history, or made up
};

/// As sequence numbers (OPC 10000-14, 7.2.3): less than a quarter of the circle ahead is later, less than a quarter
/// behind is earlier. Each of two finds the other one apart, or one finds the other later and is found earlier. 0 is
/// earlier than all.
constexpr Standing standing_of(std::uint32_t number, std::uint32_t to) {
  constexpr std::uint32_t quarter = 1U << 30;
  if (number == to) return Standing::same;
  if (number == 0 || to == 0) return to == 0 ? Standing::later : Standing::earlier;
  const std::uint32_t ahead = number - to;
  if (ahead < quarter) return Standing::later;
  return ahead > 3 * quarter ? Standing::earlier : Standing::apart;
}

/// An intent of the group. The default one stands for "nothing was ever asked": number 0, and everybody is Halted.
/// The order (standing_of) is that of number, kind, origin and run.
struct Intent {
  std::uint32_t number = 0;  ///< 1 more than the greatest number that its origin knew
  std::uint32_t run = 0;     ///< the run it opens (Start) or belongs to; 0 for Halt
  IntentKind kind = IntentKind::Halt;
  std::uint8_t origin = 0;  ///< participant that raised it: 0 the master, 1..n the slaves

  constexpr Intent() = default;
  constexpr Intent(std::uint32_t of_number, IntentKind of_kind, std::uint8_t by, std::uint32_t in_run)
      : number(of_number), run(in_run), kind(of_kind), origin(by) {}

  /// As the default one. Nearly every step compares two, so neighbours are compared as one number.
  constexpr bool operator==(const Intent& other) const { return what() == other.what() && who() == other.who(); }

 private:
  constexpr std::uint64_t what() const { return number | std::uint64_t{run} << 32; }
  constexpr std::uint16_t who() const {
    return static_cast<std::uint16_t>(static_cast<unsigned>(kind) | static_cast<unsigned>(origin) << 8);
  }
};

constexpr Standing standing_of(const Intent& intent, const Intent& to) {
  if (intent.number != to.number) return standing_of(intent.number, to.number);
  if (intent == to) return Standing::same;
  const bool is_later = intent.kind != to.kind       ? intent.kind > to.kind
                        : intent.origin != to.origin ? intent.origin > to.origin
                                                     : intent.run > to.run;
  return is_later ? Standing::later : Standing::earlier;
}

/// The identity of the run that a Start intent opens; never 0. It contains the master's incarnation, because a
/// restarted master may give a number a second time, and words of its former life must not count in the new run.
constexpr std::uint32_t run_of(std::uint32_t master_incarnation, std::uint32_t number) {
  return ((master_incarnation & 0xFFFFU) << 16) | ((number - 1) % 0xFFFFU + 1);
}

/// False for what `run_of` never makes.
constexpr bool is_run(std::uint32_t run) { return (run & 0xFFFFU) != 0; }

}  // namespace takt::handshake
