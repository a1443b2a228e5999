// SPDX-License-Identifier: Apache-2.0
// The stream filter instance table of per-stream filtering and policing (IEEE 802.1Q clause 8.6.5.3, formerly Qci):
// which gate, meter and scheduler does a frame meet, and is it too long?
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "models/ethernet/frame.hpp"
#include "models/ingress/stream_identification.hpp"

namespace takt::models {

using StreamFilterIndex = Index<struct StreamFilterTag>;
using StreamGateIndex = Index<struct StreamGateTag>;
using FlowMeterIndex = Index<struct FlowMeterTag>;
using AtsSchedulerIndex = Index<struct AtsSchedulerTag>;

/// What management sets of one stream filter.
struct StreamFilterConfig {
  std::optional<StreamHandle> stream_handle;  ///< nothing: the wildcard, which matches frames of no stream too
  std::optional<Priority> priority;           ///< nothing: the wildcard
  Octets maximum_sdu_size{0};                 ///< octets of the MSDU after the EtherType; 0: any
  bool stream_blocked_due_to_oversize_frame_enable = false;
  StreamGateIndex stream_gate;      ///< mandatory in the standard; none: a gate that is always open
  FlowMeterIndex flow_meter;        ///< or none
  AtsSchedulerIndex ats_scheduler;  ///< or none
  bool operator==(const StreamFilterConfig&) const = default;
};

/// matching = passing_sdu + not_passing_sdu; passing_sdu = passing + not_passing; red frames are among the passing
/// (they have passed the gate). A frame of a blocked stream counts as not passing the SDU filter.
struct StreamFilterCounters {
  std::uint64_t matching_frames = 0;
  std::uint64_t passing_frames = 0;      ///< passed the stream gate
  std::uint64_t not_passing_frames = 0;  ///< discarded by the stream gate
  std::uint64_t passing_sdu = 0;
  std::uint64_t not_passing_sdu = 0;
  std::uint64_t red_frames = 0;  ///< discarded by the flow meter
  bool operator==(const StreamFilterCounters&) const = default;
};

/// One filter. The caller asks it in the order of the standard: accept, then the gate, then the meter.
class StreamFilter {
 public:
  explicit StreamFilter(const StreamFilterConfig& config) : config_(config) { find_limit(); }

  bool matches(StreamHandle handle, Priority priority) const {
    return (!config_.stream_handle || *config_.stream_handle == handle) &&
           (!config_.priority || *config_.priority == priority);
  }

  /// Counts a matching frame with an MSDU of that many octets. False: discard it, because it is too long or because an
  /// earlier one was and the stream is blocked since.
  bool accept(Octets msdu) {
    ++counters_.matching_frames;
    const bool oversize = config_.maximum_sdu_size.count != 0 && msdu > config_.maximum_sdu_size;
    if (oversize && config_.stream_blocked_due_to_oversize_frame_enable) {
      blocked_ = true;
      find_limit();
    }
    const bool accepted = !oversize && !blocked_;
    ++(accepted ? counters_.passing_sdu : counters_.not_passing_sdu);
    return accepted;
  }
  /// accept() would say true.
  bool accepts_fast(Octets msdu) const { return msdu.count < accepted_below_; }
  /// accept() has said true, and so has the stream gate.
  void count_passed() { ++passed_; }
  /// What the stream gate said of an accepted frame.
  void count_gate(bool passed) { ++(passed ? counters_.passing_frames : counters_.not_passing_frames); }
  /// The flow meter has discarded a frame that passed the gate.
  void count_red() { ++counters_.red_frames; }

  /// StreamBlockedDueToOversizeFrame: latched by accept if enabled, cleared by management.
  bool stream_blocked_due_to_oversize_frame() const { return blocked_; }
  void clear_stream_blocked_due_to_oversize_frame() {
    blocked_ = false;
    find_limit();
  }

  const StreamFilterConfig& config() const { return config_; }
  StreamFilterCounters counters() const {
    StreamFilterCounters counters = counters_;
    counters.matching_frames += passed_;
    counters.passing_sdu += passed_;
    counters.passing_frames += passed_;
    return counters;
  }

 private:
  void find_limit() {
    const std::uint32_t most = config_.maximum_sdu_size.count;
    accepted_below_ = blocked_ ? 0 : most == 0 || most == 0xFFFF'FFFF ? 0xFFFF'FFFF : most + 1;
  }

  std::uint64_t passed_ = 0;          // by count_passed(); the others are in counters_
  std::uint32_t accepted_below_ = 0;  // MSDUs of fewer octets pass
  bool blocked_ = false;
  StreamFilterConfig config_;
  StreamFilterCounters counters_;
};

/// The filters of a node in the order of their instance identifiers; the first that matches is the frame's. A frame
/// that none matches goes on as if there were no policing.
class StreamFilterTable {
 public:
  StreamFilterIndex add(const StreamFilterConfig& config) {
    filters_.emplace_back(config);
    return {static_cast<std::uint32_t>(filters_.size() - 1)};
  }
  /// The first filter that matches, or null.
  StreamFilter* match(StreamHandle handle, Priority priority) {
    for (StreamFilter& filter : filters_)
      if (filter.matches(handle, priority)) return &filter;
    return nullptr;
  }
  StreamFilter& operator[](StreamFilterIndex index) { return filters_[index.value]; }
  const StreamFilter& operator[](StreamFilterIndex index) const { return filters_[index.value]; }
  std::size_t size() const { return filters_.size(); }

 private:
  std::vector<StreamFilter> filters_;
};

}  // namespace takt::models
