// SPDX-License-Identifier: Apache-2.0
// What the server of a node says of itself to the cycle, and `takt ctl status` to people.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "json/type.hpp"

namespace takt::node {

struct ServerState {
  bool is_running = true;
  std::uint64_t restarts = 0;
  std::optional<std::string> failure;  ///< why it began anew last
  std::uint64_t connections = 0;
  std::uint64_t sessions = 0;
  std::uint64_t subscriptions = 0;
  std::uint64_t octets = 0;  ///< that sessions hold
  std::uint64_t refused = 0;
  std::uint64_t rejected = 0;  ///< certificates among them
};
const json::Record& describe(json::Type<ServerState>);

}  // namespace takt::node
