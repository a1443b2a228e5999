// What the decoder says about a message, and how often it said so.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace takt::dds {

enum class Verdict : std::uint8_t {
  ok,
  truncated,  ///< the octets end before the message or a submessage does
  not_rtps,   ///< does not begin with "RTPS"
  version,    ///< not RTPS 2.x
  malformed,  ///< contradicts itself or the standard's rules of validity (8.3.7)
  unknown,    ///< a submessage of a kind that the standard does not know, or with a payload that is not CDR; skipped, the rest is taken
  secured,    ///< a submessage of DDS Security: not supported; the rest of the message is dropped
};

inline constexpr std::size_t verdict_count = 7;
inline constexpr std::array<std::string_view, verdict_count> verdict_names{"ok", "truncated", "not_rtps", "version", "malformed", "unknown", "secured"};

constexpr std::size_t index_of(Verdict verdict) { return static_cast<std::size_t>(verdict); }
constexpr std::string_view name_of(Verdict verdict) { return verdict_names[index_of(verdict)]; }
static_assert(index_of(Verdict::secured) + 1 == verdict_count);

/// How many messages (of `unknown`: submessages) got which verdict.
struct VerdictCounts {
  std::array<std::uint64_t, verdict_count> of{};
  void count(Verdict verdict, std::uint64_t times = 1) { of[index_of(verdict)] += times; }
  std::uint64_t operator[](Verdict verdict) const { return of[index_of(verdict)]; }
};

}  // namespace takt::dds
