// SPDX-License-Identifier: Apache-2.0
// How long messages of a DDS writer are and how many of them answer what a reader asks for, as src/protocol/dds/rtps makes them.
#pragma once

#include <algorithm>
#include <cstdint>

namespace takt::analysis::dds_messages {

using Payload = std::uint32_t;  ///< octets

inline constexpr Payload greatest_message = 1472;
// RTPS header, INFO_DST, INFO_TS, the submessage, inline QoS, as src/protocol/dds/rtps/stateful_writer.cpp counts them; a
// HEARTBEAT that goes with a sample.
inline constexpr Payload beside_sample = 20 + 16 + 12 + 24 + 32;
inline constexpr Payload beside_fragment = 20 + 16 + 12 + 36 + 32;
inline constexpr Payload heartbeat = 32;
inline constexpr Payload least_sample_message = 20 + 12 + 24;
// HEARTBEAT with HEARTBEAT_FRAG, GAP, ACKNACK with all its bits: header and INFO_DST are 36, the longest of the
// rest 60.
inline constexpr Payload control_message = 128;
inline constexpr std::int64_t numbers_in_a_request =
    256 + 16;  ///< of an ACKNACK, and of as many NACK_FRAGs as a reader may send (ReceiveLimits::max_reassemblies)

/// What happens once per match, once per greeting of a reader and once per heartbeat period.
struct Rates {
  std::int64_t matches = 0;
  std::int64_t greetings = 0;
  std::int64_t periods = 0;

  Rates times(std::int64_t n) const { return {matches * n, greetings * n, periods * n}; }
  void add(const Rates& more) {
    matches += more.matches;
    greetings += more.greetings;
    periods += more.periods;
  }
};

/// What a reliable writer has that a reader may ask for.
struct Offer {
  std::int64_t samples = -1;           ///< in its history at most; below 0: without a limit
  std::int64_t fragments = 1;          ///< of a sample
  Payload message = greatest_message;  ///< of the longest

  /// Samples and GAPs that answer one ACKNACK.
  std::int64_t samples_in_an_answer() const {
    return fragments * (samples < 0 ? numbers_in_a_request : std::min(samples, numbers_in_a_request));
  }
  std::int64_t gaps_in_an_answer() const {
    return samples < 0 ? numbers_in_a_request : std::min(samples + 1, numbers_in_a_request);
  }
};

}  // namespace takt::analysis::dds_messages
