// SPDX-License-Identifier: Apache-2.0
// logMessageInterval of what a port sends, which its neighbour may change. IEEE 802.1AS-2020 10.3.17, 10.3.18
// and 11.2.21: SyncIntervalSetting, AnnounceIntervalSetting and LinkDelayIntervalSetting.
#pragma once

#include <algorithm>
#include <cstdint>

#include "models/gptp/ptp_time.hpp"

namespace takt::models::gptp {

/// One kind of message at one port. When the interval gets longer, `lingering` more messages go out at the former one,
/// so that the neighbour, which learns of it from these messages, does not take the first long gap for a loss
/// (syncSlowdown).
class MessageInterval {
 public:
  static constexpr std::int8_t as_it_is = -128;  ///< of a request: no change
  static constexpr std::int8_t initial = 126;    ///< of a request: as the port began
  static constexpr std::int8_t none = 127;       ///< of a request, and as announced: the port sends no more
  static constexpr int shortest = -7;            ///< what a port can do, 2^-7 s; a request for less gets this
  static constexpr int longest = 4;

  MessageInterval(int log_initial, int lingering) : initial_(log_initial), lingering_(lingering), log_(log_initial) {}

  void reset() { *this = MessageInterval(initial_, lingering_); }
  /// True if it is another one now. Values that are no interval and have no meaning change nothing.
  bool request(std::int8_t log_interval) {
    const bool has_meaning =
        log_interval == initial || log_interval == none || (log_interval >= -24 && log_interval <= 24);
    if (!has_meaning) return false;
    const int before = log_;
    const bool was_stopped = stopped_;
    stopped_ = log_interval == none;
    if (!stopped_)
      log_ = log_interval == initial
                 ? initial_
                 : std::clamp<int>(log_interval, std::min(shortest, initial_), std::max(longest, initial_));
    if (stopped_ == was_stopped && log_ == before) return false;
    left_ = !stopped_ && !was_stopped && log_ > before ? lingering_ : 0;
    former_ = before;
    return true;
  }

  bool is_stopped() const { return stopped_; }
  bool is_initial() const { return !stopped_ && log_ == initial_; }
  bool lingers() const { return left_ > 0; }
  int log() const { return log_; }
  /// logMessageInterval of a message that is sent now.
  std::int8_t announced() const { return stopped_ ? none : static_cast<std::int8_t>(log_); }
  /// From a message to the next.
  sim::Duration length() const { return interval_of(lingers() ? former_ : log_); }
  /// The same, of a message that is sent now.
  sim::Duration sent() {
    const sim::Duration until_next = length();
    if (lingers()) --left_;
    return until_next;
  }

 private:
  int initial_;
  int lingering_;
  int log_;
  int former_ = 0;
  int left_ = 0;  // messages at the former interval
  bool stopped_ = false;
};

}  // namespace takt::models::gptp
