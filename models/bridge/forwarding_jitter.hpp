// SPDX-License-Identifier: Apache-2.0
// The part of a bridge's forwarding delay that differs from frame to frame.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "models/ethernet/frame.hpp"
#include "models/host/os_latency.hpp"
#include "sim/check.hpp"

namespace takt::models {

/// Frames that come in by one port take one way through the bridge: none overtakes another one there, whatever is drawn
/// for it, so what has drawn little waits behind what has drawn much. Frames of different ports do not mind each other.
/// Each port draws from a stream of chance of its own, so that it does not matter which of two ports is looked at
/// first.
class ForwardingJitter {
 public:
  /// The distribution outlives it.
  ForwardingJitter(const sim::Distribution& distribution, std::uint64_t seed, std::string_view path,
                   std::size_t ports) {
    ways_.reserve(ports);
    for (std::size_t port = 0; port < ports; ++port)
      ways_.emplace_back(distribution, seed, std::string(path) + ":" + std::to_string(port));
  }

  /// Frames that have come in by the port at `now`, from one arrival: when they are through, no later than the greatest
  /// jitter after `now`, which is not 0, and later than `now`, so that what a bridge decides when an instant is
  /// complete does not come back to it.
  sim::TrueTime enter(std::uint16_t port, sim::TrueTime now, std::span<const FrameIndex> frames) {
    Way& way = ways_[port];
    for (std::size_t i = 0; i < frames.size(); ++i) way.push({frames[i], i + 1 == frames.size()});
    return std::max(way.line.pass(now), now + sim::Duration::from_ps(1));
  }
  /// The frames that are through now, one after the other: those of one call of enter(), the first one that is left. So
  /// it does not matter in which order two of these are due at one instant.
  template <class Forward>
  void leave(std::uint16_t port, const Forward& forward) {
    for (bool is_last = false; !is_last;) {
      const Waiting next = ways_[port].pop();
      is_last = next.is_last;
      forward(next.frame);
    }
  }

 private:
  struct Waiting {
    FrameIndex frame;
    bool is_last = false;  ///< of those that came together
  };
  struct Way {
    Way(const sim::Distribution& distribution, std::uint64_t seed, const std::string& path)
        : line(distribution, seed, path, "forwarding") {}
    void push(Waiting waiting) {
      if (count == ring.size()) grow();
      ring[(first + count++) & (ring.size() - 1)] = waiting;
    }
    Waiting pop() {
      TAKT_CHECK(count > 0, "who leaves has entered");
      const Waiting next = ring[first];
      first = (first + 1) & (ring.size() - 1);
      --count;
      return next;
    }
    void grow() {
      std::vector<Waiting> wider(ring.empty() ? 8 : 2 * ring.size());
      for (std::size_t i = 0; i < count; ++i) wider[i] = ring[(first + i) & (ring.size() - 1)];
      ring = std::move(wider);
      first = 0;
    }
    LatencyLine line;
    std::vector<Waiting> ring;  // a power of two
    std::size_t first = 0;
    std::size_t count = 0;
  };
  std::vector<Way> ways_;  // by ingress port
};

}  // namespace takt::models
