// SPDX-License-Identifier: Apache-2.0
// Whether a node checks each arrival with its link.
#pragma once

#include <cstdint>

#include "sim/check.hpp"

namespace takt::models {

/// Arrivals are checked always in nodes that do more than forward, and in all nodes while a cancelled arrival is
/// pending: a frame was cut, so it does not arrive when it was scheduled to (Link::receive). Frames that might be cut
/// cost nothing until one is.
class ReceptionChecks {
 public:
  bool is_needed() const { return reasons_ != 0; }
  /// The node does more than forward.
  void require_always() { reasons_ |= always; }
  bool is_always_required() const { return (reasons_ & always) != 0; }
  /// The arrival of some frame that was cut is still pending.
  bool has_cancelled_arrivals() const { return (reasons_ & ~always) != 0; }
  void arrival_cancelled() {
    TAKT_CHECK((reasons_ & ~always) != ~always, "fewer than 2^31 frames that were cut are under way to a node");
    ++reasons_;
  }
  /// The instant of a cancelled arrival has come, and the link has reported it.
  void cancelled_arrival_is_over() {
    TAKT_CHECK(has_cancelled_arrivals(), "a cancelled arrival ends once");
    --reasons_;
  }

 private:
  static constexpr std::uint32_t always = 1u << 31;
  std::uint32_t reasons_ = 0;  // the other bits count the cancelled arrivals that are pending
};

}  // namespace takt::models
