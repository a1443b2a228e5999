// SPDX-License-Identifier: Apache-2.0
// What the decoder says about octets, and how often it said so: what is not understood is counted and dropped.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace takt::uadp {

enum class DecodeStatus : std::uint8_t {
  ok,
  truncated,  ///< the octets end before the message does
  version,    ///< not UADPVersion 1
  reserved,   ///< a bit or a code that the standard keeps for later; the message is to be skipped
  malformed,  ///< contradicts itself
  secured,    ///< signed or encrypted, or says so: not supported yet
  chunked,    ///< part of a message that is too long for one
  discovery,  ///< a probe or an announcement
  action,     ///< has an ActionHeader (v1.05.04)
};

inline constexpr std::size_t decode_status_count = 9;
inline constexpr std::array<std::string_view, decode_status_count> decode_status_names{
    "ok", "truncated", "version", "reserved", "malformed", "secured", "chunked", "discovery", "action"};

constexpr std::size_t index_of(DecodeStatus verdict) { return static_cast<std::size_t>(verdict); }
constexpr std::string_view name_of(DecodeStatus verdict) { return decode_status_names[index_of(verdict)]; }
static_assert(index_of(DecodeStatus::action) + 1 == decode_status_count);

/// How many messages got which verdict.
struct DecodeStatusCounts {
  std::array<std::uint64_t, decode_status_count> of{};
  void count(DecodeStatus verdict) { ++of[index_of(verdict)]; }
  std::uint64_t operator[](DecodeStatus verdict) const { return of[index_of(verdict)]; }
  std::uint64_t dropped() const {
    std::uint64_t sum = 0;
    for (std::size_t i = 1; i < decode_status_count; ++i) sum += of[i];
    return sum;
  }
};

}  // namespace takt::uadp
