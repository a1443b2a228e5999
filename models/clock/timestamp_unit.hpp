// SPDX-License-Identifier: Apache-2.0
// What a network interface makes of the instant at which a frame passes: granularity, jitter, latencies of the PHY.
#pragma once

#include <cstdint>

#include "sim/check.hpp"
#include "sim/random.hpp"
#include "sim/time.hpp"

namespace takt::models {

/// Turns the clock's time of a frame's timestamp point at the wire (the first symbol after the SFD) into the timestamp
/// that software reads. The unit sits behind the PHY: it sees a frame egress_latency before the wire and
/// ingress_latency after it, reads a counter of `granularity`, and adds what it believes the latencies to be. Where
/// belief and latency differ, time transfer is wrong by it; with equal belief and latency only granularity and jitter
/// remain. Latencies are lengths of local time: over a microsecond at 100 ppm that is 0.1 ps.
struct TimestampUnit {
  sim::Duration granularity = sim::Duration::from_ps(1);  // 1 ps: exact; 8 ns, 40 ns ... of a real counter
  sim::Duration grid_offset = {};                         // the counter ticks at grid_offset + n * granularity
  sim::Duration jitter = {};                              // dynamic error, uniform in [-jitter, jitter]
  sim::Duration egress_latency = {};
  sim::Duration ingress_latency = {};
  sim::Duration egress_correction = {};   // what is added to an egress timestamp; ideally egress_latency
  sim::Duration ingress_correction = {};  // what is subtracted from an ingress timestamp

  sim::LocalTime egress(sim::LocalTime at_wire, sim::RandomStream& chance) const {
    return counted(at_wire - egress_latency, chance) + egress_correction;
  }
  sim::LocalTime ingress(sim::LocalTime at_wire, sim::RandomStream& chance) const {
    return counted(at_wire + ingress_latency, chance) - ingress_correction;
  }

  bool operator==(const TimestampUnit&) const = default;

 private:
  /// One draw if there is jitter, none otherwise.
  sim::LocalTime counted(sim::LocalTime time, sim::RandomStream& chance) const {
    TAKT_CHECK(granularity > sim::Duration() && jitter >= sim::Duration(), "a counter that ticks");
    if (jitter > sim::Duration())
      time += sim::Duration::from_ps(
          static_cast<std::int64_t>(chance.below(2 * static_cast<std::uint64_t>(jitter.ps()) + 1)) - jitter.ps());
    const sim::Duration phase = (time - grid_offset).since_start() % granularity;
    return time - (phase < sim::Duration() ? phase + granularity : phase);
  }
};

}  // namespace takt::models
