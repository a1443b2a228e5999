// Whether a node must look at what comes to it.
#pragma once

#include <cstdint>

#include "sim/check.hpp"

namespace takt::models {

/// A node looks at each arrival if it does more than pass frames on, and as long as one of the frames that it was told of has been cut: that one will not come when it was said to, so
/// the node asks the link of each (Link::receive). So frames that might be cut cost nothing until one is.
class Attention {
 public:
  bool is_needed() const { return reasons_ != 0; }
  /// The node does more than pass frames on.
  void demand() { reasons_ |= demanded; }
  bool is_demanded() const { return (reasons_ & demanded) != 0; }
  /// Some arrival will not be.
  bool asks_links() const { return (reasons_ & ~demanded) != 0; }
  void arrival_withdrawn() {
    TAKT_CHECK((reasons_ & ~demanded) != ~demanded, "fewer than 2^31 frames that were cut are under way to a node");
    ++reasons_;
  }
  /// The instant of such an arrival is there, and the link has said so.
  void withdrawn_arrival_is_over() {
    TAKT_CHECK(asks_links(), "an arrival that will not be is over once");
    --reasons_;
  }

 private:
  static constexpr std::uint32_t demanded = 1u << 31;
  std::uint32_t reasons_ = 0;   // the others are a count of arrivals that will not be
};

}  // namespace takt::models
