// SPDX-License-Identifier: Apache-2.0
// The keys that a server gives (OPC 10000-14, 8.3): those of files, by the time of day, so that nodes with the file and
// nodes that pull agree.
#pragma once

#include <functional>

#include "node/config.hpp"
#include "opcua/server/outside.hpp"

namespace takt::node {

class ServedKeys final : public opcua::KeyService {
 public:
  /// `now_ns`: since 1970 on the clock that the files are for.
  ServedKeys(const std::vector<LoadedGroup>& groups, std::uint32_t future_keys, std::function<std::int64_t()> now_ns)
      : groups_(groups), future_keys_(future_keys), now_ns_(std::move(now_ns)) {}

  /// From the token that is asked for on, if it is the one before the current one or any behind it that may be given;
  /// of a token that is none of these the oldest.
  opcua::Answer<opcua::SecurityKeys> keys(const opcua::SecurityKeysRequest& request, std::string_view user) override;

 private:
  std::vector<LoadedGroup> groups_;
  std::uint32_t future_keys_;
  std::function<std::int64_t()> now_ns_;
};

/// Nanoseconds since 1970 on the clock of a node's keys: CLOCK_TAI or CLOCK_REALTIME, which outlive the machine's
/// start.
std::int64_t key_time_ns(ClockName clock);

}  // namespace takt::node
