// SPDX-License-Identifier: Apache-2.0
// Files of captures, pcap and pcapng, in either byte order: their frames, with the time, the interface and the length
// of each.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "sim/octets.hpp"

namespace takt::interchange {

struct CapturedFrame {
  std::uint32_t interface = 0;  ///< counted over all sections of the file
  std::int64_t time_ns = 0;     ///< rounded down
  std::uint32_t length = 0;     ///< on the wire, whatever was captured of it
  sim::OctetSpan octets = {};   ///< what was captured
};

/// Hands on the frames of Ethernet in the order of the file, until `take` says no. Returns an empty text, or what is
/// wrong with the file; blocks that are not known are passed over.
std::string read_captured_frames(std::string_view file, const std::function<bool(const CapturedFrame&)>& take);

}  // namespace takt::interchange
