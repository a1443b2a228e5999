// SPDX-License-Identifier: Apache-2.0
// The MAC Merge sublayer of a sending port (IEEE 802.3 clause 99): which preemptable frame is under way, which one has
// been cut and waits for its continuation, whether the MAC is asked to hold.
#pragma once

#include <optional>

#include "models/egress/gate_schedule.hpp"
#include "models/egress/preemption.hpp"
#include "models/egress/shaping_config.hpp"
#include "sim/time.hpp"

namespace takt::models {

class MacMerge {
 public:
  /// A fragment on the medium, the last of its frame unless it is cut.
  struct UnderWay {
    FrameIndex frame;
    TrafficClass traffic_class = 0;
    sim::TrueTime start;    ///< first bit of its preamble
    Octets remaining{0};    ///< of the frame at the start of the fragment, FCS included
    sim::TrueTime arrival;  ///< when the frame's arrival was scheduled at the peer
  };
  /// What is left of a frame that was cut.
  struct Rest {
    FrameIndex frame;
    TrafficClass traffic_class = 0;
    Octets remaining{0};
  };
  struct Cut {
    Octets data{0};         ///< octets of the frame in the fragment that ends
    sim::TrueTime free_at;  ///< when mCRC and gap are over
  };

  MacMerge(const PreemptionConfig& config, sim::Duration octet_time)
      : config_(config),
        octet_time_(octet_time),
        hold_advance_(config.hold_advance.value_or(octet_time * longest_express_wait(config.add_frag_size).count)) {}

  bool is_preemptable(TrafficClass q) const { return contains(config_.preemptable, q); }
  ClassSet preemptable() const { return config_.preemptable; }

  /// A fragment starts; also the first and the last one of a frame is a fragment.
  void started(const UnderWay& fragment) {
    under_way_ = fragment;
    rest_.reset();
  }
  /// Another frame starts: what was under way is out.
  void express_started() { under_way_.reset(); }

  const std::optional<UnderWay>& under_way() const { return under_way_; }
  const std::optional<Rest>& rest() const { return rest_; }
  /// The rest is given up: its link has gone down.
  void forget_rest() { rest_.reset(); }

  /// The earliest end of the fragment under way, or nothing if it goes to the frame's end.
  /// Precondition: a preemptable frame is under way.
  std::optional<Cut> earliest_cut(sim::TrueTime now) const {
    const sim::Duration elapsed = now - under_way_->start;
    const std::int64_t octets = (elapsed.ps() + octet_time_.ps() - 1) / octet_time_.ps();
    const std::optional<Octets> data =
        cut_after({static_cast<std::uint32_t>(octets)}, under_way_->remaining, config_.add_frag_size);
    if (!data) return std::nullopt;
    return Cut{*data, under_way_->start + octet_time_ * wire_length_of_cut_fragment(*data).count};
  }
  void cut(const Cut& cut) {
    rest_ = Rest{under_way_->frame, under_way_->traffic_class, under_way_->remaining - cut.data};
    under_way_.reset();
    ++fragments_cut_;
  }

  /// Whether the MAC is asked to hold preemptable frames at `now`, and until when that stays so. The gates run on local
  /// time; their answer is kept until it may change.
  HoldRequest hold_request(GateSchedule& gates, sim::LocalTime now) {
    if (now >= hold_.until || now < hold_asked_) {
      hold_ = gates.hold_request(now, hold_advance_, config_.release_advance);
      hold_asked_ = now;
    }
    return hold_;
  }
  /// Other gates: the answer that is kept holds no longer.
  void gates_changed() { hold_.until = sim::LocalTime::from_ps(std::numeric_limits<std::int64_t>::min()); }

  sim::Duration hold_advance() const { return hold_advance_; }
  std::uint64_t fragments_cut() const { return fragments_cut_; }

 private:
  PreemptionConfig config_;
  sim::Duration octet_time_;
  sim::Duration hold_advance_;
  std::optional<UnderWay> under_way_;
  std::optional<Rest> rest_;
  HoldRequest hold_{false, sim::LocalTime::from_ps(std::numeric_limits<std::int64_t>::min())};
  sim::LocalTime hold_asked_;
  std::uint64_t fragments_cut_ = 0;
};

}  // namespace takt::models
