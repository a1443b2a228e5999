// SPDX-License-Identifier: Apache-2.0
// What bounds memory and time for any scenario. More is a diagnostic.
#pragma once

#include <cstddef>
#include <cstdint>

namespace takt::scenario {

inline constexpr std::uint64_t most_nodes = 200'000;
inline constexpr std::uint64_t most_links = 400'000;
inline constexpr std::uint64_t most_streams = 1'000'000;
inline constexpr std::uint32_t most_ports = 4'096;        ///< of one node
inline constexpr std::size_t most_end_station_ports = 8;  ///< of a host or a station
inline constexpr std::uint64_t most_trace_entries = 10'000'000;

inline constexpr std::uint64_t most_path_nodes = 20'000'000;  ///< of all streams together

}  // namespace takt::scenario
