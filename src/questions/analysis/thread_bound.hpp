// SPDX-License-Identifier: Apache-2.0
// What threads of applications do for certain: that each call takes place, how long its response lasts, that a
// subscribing one finds every value.
#pragma once

#include <optional>
#include <string>

#include "analysis/bounds.hpp"

namespace takt::analysis {

/// Of the calls that are due at an instant or later.
struct ThreadBound {
  sim::Duration least_response;  ///< of a call that takes place, on the clock of its host
  sim::Duration greatest_response;
  bool is_always_done = false;              ///< each call that is due takes place, and there is one
  bool is_tested = false;                   ///< and a window is a test of criterion 1: it counts 100 %
  std::string reason;                       ///< why one of these is not certain
  std::optional<std::uint64_t> most_found;  ///< values that a call of a subscription over OPC UA finds at most
  bool loses_nothing = false;  ///< of such a subscription: each value that is published is taken, or is still under way
  std::string values_reason;
  Assumptions assumptions;
};

/// `thread` in resolved.applications[application]. `bounds` has its streams.
ThreadBound thread_bound(const scenario::Resolved& resolved, const Bounds& bounds, std::size_t application,
                         std::size_t thread, sim::Duration from);

}  // namespace takt::analysis
