// SPDX-License-Identifier: Apache-2.0
// Who gives its place when places are short: connections, sessions and subscriptions by one rule.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim/time.hpp"

namespace takt::opcua {

struct Place {
  std::string account;   ///< the user; without one the host
  int rank = 0;          ///< of the account
  int progress = 0;      ///< within an account, the least goes first
  bool is_left = false;  ///< nobody has been connected to it for the grace time
  sim::LocalTime since;
};
struct Newcomer {
  std::string account;
  int rank = 0;
};

/// The index of the place that goes for the newcomer: one that was left, or of less rank, or of the same rank where its
/// account has at least two more than the newcomer's. Among these: what was left first, then the least rank, then the
/// account with most, then progress, then the oldest. Nothing: the newcomer stays outside.
std::optional<std::size_t> place_to_give(const std::vector<Place>& places, const Newcomer& newcomer);

/// "127.0.0.1:5000" without the port.
inline std::string host_of(std::string_view source) { return std::string(source.substr(0, source.rfind(':'))); }

}  // namespace takt::opcua
