// What a port has besides strict priority: transmission gates, credit-based shapers, maximum SDU sizes (IEEE 802.1Q 8.6.8).
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "models/clock/local_clock.hpp"
#include "models/egress/credit_based_shaper.hpp"
#include "models/egress/gate_schedule.hpp"
#include "models/egress/shaping_config.hpp"
#include "models/egress/transmission_selection.hpp"
#include "models/ethernet/sizes.hpp"

namespace takt::models {

/// Lengths (DA to FCS) of the frames at the heads of the queues; only those of candidate classes count.
using HeadLengths = std::array<std::uint16_t, traffic_class_count>;

class PortShaping {
 public:
  /// All references outlive it. The gates run on `clock`.
  PortShaping(const ShapingConfig& config, const LocalClock& clock, sim::Duration octet_time);

  /// Management sets ConfigChange at `now`.
  ConfigChange request_gates(sim::TrueTime now, const GateConfig& gates);

  /// The most urgent of `candidates` whose gate is open for long enough and whose credit is not negative; otherwise the instant
  /// at which one of them may become ready.
  ///
  /// A frame may start if its last bit leaves before or when the gate closes: preamble and SFD count, the gap after it does not.
  Selection select(sim::TrueTime now, ClassSet candidates, const HeadLengths& heads);

  /// The same for one class whose first frame has that length: `now` if it may start, otherwise when to ask again.
  sim::TrueTime ready_time(sim::TrueTime now, TrafficClass q, std::uint32_t length);

  /// A frame of the class waits, or stands at the port to be selected.
  void frame_waits(sim::TrueTime now, TrafficClass q) {
    if (Shaper* const shaper = shapers_[q].get()) {
      follow_gate(*shaper, q, now);
      shaper->credit.frame_enqueued(now);
    }
  }
  /// The frame that waited was dropped, and no other waits.
  void none_waits(sim::TrueTime now, TrafficClass q) {
    if (Shaper* const shaper = shapers_[q].get()) {
      follow_gate(*shaper, q, now);
      shaper->credit.queue_emptied(now);
    }
  }
  /// A frame of the class starts; `queue_is_empty`: none of the class is left.
  void started(sim::TrueTime now, TrafficClass q, std::uint32_t length, bool queue_is_empty) {
    if (Shaper* const shaper = shapers_[q].get()) {
      follow_gate(*shaper, q, now);
      shaper->credit.transmission_started(now, occupancy(length), queue_is_empty);
    }
  }

  bool fits_max_sdu(TrafficClass q, std::uint32_t msdu) const {
    return config_->queue_max_sdu[q].count == 0 || msdu <= config_->queue_max_sdu[q].count;
  }

  GateSchedule& gates() { return gates_; }
  /// Credit of a class in bits, rounded down; for displays. Precondition: the class has a shaper.
  std::int64_t credit_bits(sim::TrueTime now, TrafficClass q);

 private:
  struct Shaper {
    CreditBasedShaper credit;
    GateSchedule gates;                        // a follower of its own, since its time lags behind
    const GateControlList* slope_of = nullptr; // the list for which the slope was computed
    sim::LocalTime followed;                   // the time up to which the credit knows the gate
  };

  sim::Duration occupancy(std::uint32_t length) const { return octet_time_ * wire_length(Octets{length}).count; }
  void follow_gate(Shaper& shaper, TrafficClass q, sim::TrueTime now);
  void set_slope(Shaper& shaper, TrafficClass q, sim::TrueTime now);

  const ShapingConfig* config_;
  const LocalClock* clock_;
  sim::Duration octet_time_;
  bool has_gates_;
  GateSchedule gates_;
  std::vector<std::unique_ptr<GateControlList>> lists_;  // all that were ever requested; spans point to them
  std::array<std::unique_ptr<Shaper>, traffic_class_count> shapers_;
};

}  // namespace takt::models
