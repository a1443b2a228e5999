// SPDX-License-Identifier: Apache-2.0
// A stream gate instance (IEEE 802.1Q clause 8.6.5.4): its schedule, the octets of the present interval, and what
// closes it for good.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "models/ingress/ingress_config.hpp"

namespace takt::models {

class StreamGate {
 public:
  enum class Outcome : std::uint8_t { passed, closed, octets_exceeded };
  struct Verdict {
    Outcome outcome = Outcome::passed;
    std::optional<Priority> ipv;  ///< if passed: the internal priority value, if the gate gives one
    bool operator==(const Verdict&) const = default;
  };
  struct Counters {
    std::uint64_t passed = 0;
    std::uint64_t closed = 0;           ///< came while it was closed, by its list or for good
    std::uint64_t octets_exceeded = 0;  ///< came while it was open, beyond IntervalOctetMax
    bool operator==(const Counters&) const = default;
  };

  /// The list of the configuration is requested at time 0 of the node's clock; one that is running, before its base
  /// time.
  explicit StreamGate(const StreamGateConfig& config);

  /// Decides about an MSDU of that many octets whose last bit came at `now`, which does not decrease from call to call.
  Verdict admit(Octets msdu, sim::LocalTime now) {
    const StreamGateEntry* const entry = schedule_.entry(now);
    if (is_latched() || (entry != nullptr ? !entry->open || entry->interval_octet_max : !schedule_.admin_gate_open()))
        [[unlikely]]
      return admit_slow(msdu, now);
    ++counters_.passed;
    return {Outcome::passed, entry != nullptr ? entry->ipv : schedule_.admin_ipv()};
  }

  /// Management sets ConfigChange with another list, cycle time, extension and base time.
  ConfigChange request_change(sim::LocalTime now, const StreamGateConfig& config);

  /// Latched by a frame if enabled, cleared by management.
  bool closed_due_to_invalid_rx() const { return closed_due_to_invalid_rx_; }
  bool closed_due_to_octets_exceeded() const { return closed_due_to_octets_exceeded_; }
  void clear_closed_due_to_invalid_rx() { closed_due_to_invalid_rx_ = false; }
  void clear_closed_due_to_octets_exceeded() { closed_due_to_octets_exceeded_ = false; }

  const StreamGateConfig& config() const { return config_; }
  const Counters& counters() const { return counters_; }
  StreamGateSchedule& schedule() { return schedule_; }

 private:
  bool is_latched() const { return closed_due_to_invalid_rx_ || closed_due_to_octets_exceeded_; }
  Verdict admit_slow(Octets msdu, sim::LocalTime now);

  StreamGateConfig config_;
  std::vector<std::unique_ptr<const StreamGateList>> lists_;  // of all requests: the schedule refers to them
  StreamGateSchedule schedule_;
  IntervalOctets interval_octets_;
  bool closed_due_to_invalid_rx_ = false;
  bool closed_due_to_octets_exceeded_ = false;
  Counters counters_;
};

}  // namespace takt::models
