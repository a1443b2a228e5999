// SPDX-License-Identifier: Apache-2.0
// What the decoder says about a message, and how often it said so.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace takt::dds {

enum class MessageStatus : std::uint8_t {
  ok,
  truncated,  ///< the octets end before the message or a submessage does
  not_rtps,   ///< does not begin with "RTPS"
  version,    ///< not RTPS 2.x
  malformed,  ///< contradicts itself or the standard's rules of validity (8.3.7)
  unknown,  ///< a submessage of a kind that the standard does not know, or with a payload that is not CDR; skipped, the
            ///< rest is taken
  secured,  ///< a submessage of DDS Security: not supported; the rest of the message is dropped
};

inline constexpr std::size_t message_status_count = 7;
inline constexpr std::array<std::string_view, message_status_count> message_status_names{
    "ok", "truncated", "not_rtps", "version", "malformed", "unknown", "secured"};

constexpr std::size_t index_of(MessageStatus verdict) { return static_cast<std::size_t>(verdict); }
constexpr std::string_view name_of(MessageStatus verdict) { return message_status_names[index_of(verdict)]; }
static_assert(index_of(MessageStatus::secured) + 1 == message_status_count);

/// How many messages (of `unknown`: submessages) got which verdict.
struct MessageStatusCounts {
  std::array<std::uint64_t, message_status_count> of{};
  void count(MessageStatus verdict, std::uint64_t times = 1) { of[index_of(verdict)] += times; }
  std::uint64_t operator[](MessageStatus verdict) const { return of[index_of(verdict)]; }
};

}  // namespace takt::dds
