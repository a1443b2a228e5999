// SPDX-License-Identifier: Apache-2.0
// When the gate of a class lets frames start, as a service that repeats: windows and the gaps between them, at the
// worst phase.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "analysis/picoseconds.hpp"
#include "models/egress/shaping_config.hpp"

namespace takt::analysis {

/// Windows of one class in one cycle of a gate list, by the node's own clock.
struct GateOpening {
  Ps from = 0;
  Ps until = 0;  ///< may lie beyond the end of the cycle, in which it began
};

/// The gates of a list as they repeat.
class GateCycle {
 public:
  /// Precondition: a sound list (checked by the scenario).
  explicit GateCycle(const models::GateConfig& gates);

  Ps cycle() const { return cycle_; }
  /// When a cycle begins.
  Ps base() const { return base_; }
  bool is_always_open(models::TrafficClass q) const { return open_[q] == cycle_; }
  Ps open(models::TrafficClass q) const { return open_[q]; }
  const std::vector<GateOpening>& windows(models::TrafficClass q) const { return windows_[q]; }
  /// Whether both gates are open at one time.
  bool overlap(models::TrafficClass a, models::TrafficClass b) const;
  /// How long a frame of class `other`, begun before a window of q opens, may run into it: at most `frame`, since it
  /// must end before its own gate closes, and `gap` in any case, the inter-packet gap of a frame that ends at the
  /// close.
  Ps overhang(models::TrafficClass q, models::TrafficClass other, Ps frame, Ps gap) const;
  /// The same for one window of q, to the ps: nothing if the gate of `other`, which may be q itself, has been closed
  /// for a gap.
  Ps overhang_at(std::size_t window, models::TrafficClass q, models::TrafficClass other, Ps frame, Ps gap) const;

 private:
  bool is_open_at(models::TrafficClass q, Ps time) const;
  Ps close_after(models::TrafficClass q, Ps time) const;

  Ps cycle_ = 0;
  Ps base_ = 0;
  std::array<Ps, models::traffic_class_count> open_{};
  std::array<std::vector<GateOpening>, models::traffic_class_count> windows_;
};

/// Stretches of usable time at known phases.
class PhasedSupply {
 public:
  /// `base` is when a cycle of the list begins. Of each window what is left when what is taken of its start, `error`
  /// and `lost_at_end` are taken off its ends.
  PhasedSupply(const GateCycle& gates, models::TrafficClass q, Ps base, const std::vector<Ps>& taken_at_starts,
               Ps error, Ps lost_at_end);
  /// The time from `from` on in which `need` of usable time passes. Unbounded if there is none.
  Ps time_from(Ps from, Ps need) const;
  /// When the windows of a cycle end.
  std::vector<Ps> ends() const;

 private:
  Ps cycle_ = 0;
  Ps base_ = 0;
  Ps usable_ = 0;
  std::vector<GateOpening> windows_;
};

/// What a class certainly sends in a window in which frames wait all the time, in which frames that together last so
/// long end: at least that less the longest frame.
using PackedWork = std::function<Ps(Ps room)>;

/// Stretches of usable time that repeat.
class PeriodicSupply {
 public:
  /// Of each window what is left when what is taken of its start, `error` and `lost_at_end` are taken off its ends;
  /// shrunk and stretched by the worst rates of the clock (parts in 10^12). A busy period may begin when nothing fits
  /// any more into a window, `guard` before its end; but from the windows that begin later it takes all that `packed`
  /// says.
  PeriodicSupply(const GateCycle& gates, models::TrafficClass q, const std::vector<Ps>& taken_at_starts, Ps error,
                 Ps lost_at_end, std::int64_t slowest_ppt, std::int64_t fastest_ppt, Ps guard = 0,
                 const PackedWork& packed = {});

  /// The longest time, from any phase, in which `need` of usable time passes. Unbounded if there is none.
  Ps time_for(Ps need) const;
  /// The part of all time that is usable.
  double share() const { return cycle_ == 0 ? 0.0 : static_cast<double>(usable_) / static_cast<double>(cycle_); }
  std::size_t windows() const { return windows_.size(); }
  Ps cycle() const { return cycle_; }
  Ps usable() const { return usable_; }

 private:
  struct Window {
    Ps gap_before = 0;
    Ps fits = 0;  // up to here the longest frame fits
    Ps length = 0;
    Ps lost_first = 0;  // of the window before it, if a busy period begins in that
  };
  Ps cycle_ = 0;
  Ps usable_ = 0;
  std::vector<Window> windows_;
};

}  // namespace takt::analysis
