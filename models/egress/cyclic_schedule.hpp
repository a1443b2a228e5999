// SPDX-License-Identifier: Apache-2.0
// A cyclic list of intervals as a function of time, and how one list takes the place of another (IEEE 802.1Q
// clause 8.6.9).
//
// The standard describes three state machines: Cycle Timer, List Execute and List Config. Between two requests for a
// change everything that they will do is known, so no machine runs here: a request lays out the time from now on as a
// few spans, in each of which one list either repeats or runs once, and a query only asks where in its span an instant
// lies. Transmission gates and stream gates share this file; what an entry of a list means is theirs.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "sim/check.hpp"
#include "sim/time.hpp"

namespace takt::models {

/// Floor and ceiling of a / b for b > 0 and any a.
constexpr std::int64_t floor_quotient(sim::Duration a, sim::Duration b) {
  return a / b - (a % b < sim::Duration() ? 1 : 0);
}
constexpr std::int64_t ceil_quotient(sim::Duration a, sim::Duration b) {
  return a / b + (a % b > sim::Duration() ? 1 : 0);
}
/// The first start of a cycle that is no earlier than `now`: the base time itself, or that of the cycle that begins
/// next (ConfigChangeTime, 8.6.9.1.1).
constexpr sim::LocalTime first_cycle_from(sim::LocalTime now, sim::LocalTime base_time, sim::Duration cycle) {
  return base_time < now ? base_time + cycle * ceil_quotient(now - base_time, cycle) : base_time;
}
/// When management asks for a list with which a device starts: at the start, or, if it is running then, so long ago
/// that its base time had still to come.
constexpr sim::LocalTime first_request(sim::LocalTime start, sim::LocalTime base_time, bool is_running) {
  return is_running ? std::min(start, base_time) : start;
}

/// When the entries of a list begin, counted from the start of its cycle.
///
/// Only the entries that begin before the end of the cycle are `executed` in a regular cycle: what lies beyond is cut
/// off by the next CycleStart, and if all intervals together are shorter than the cycle the last entry stays (8.6.9.2).
/// A cycle that is stretched before a change of lists goes on through all entries. An interval of zero counts as one
/// tick of 1 ns.
///
/// Cycle times are whole picoseconds. One that is not would join where cycles are counted, in cycles_in() and in the
/// few lines of CyclicSchedule that multiply a cycle time: the start of cycle k becomes
/// base + floor(k * numerator * 10^12 / denominator), so that nothing accumulates.
class CyclicIntervals {
 public:
  /// The range of a 16-bit index, and what devices announce (SupportedListMax).
  static constexpr std::size_t entry_limit = 65'536;
  /// Longest cycle, extension and total of intervals: about 13 days. Keeps all sums within 64 bits.
  static constexpr sim::Duration longest = sim::Duration::from_ps(std::int64_t{1} << 60);

  /// 1 to entry_limit intervals, none negative; cycle_time > 0. The scenario's checks have seen to that.
  CyclicIntervals(std::span<const sim::Duration> intervals, sim::Duration cycle_time) : cycle_time_(cycle_time) {
    TAKT_CHECK(!intervals.empty() && intervals.size() <= entry_limit, "a control list has 1 to 65536 entries");
    TAKT_CHECK(cycle_time > sim::Duration() && cycle_time <= longest, "a cycle time is positive and at most 13 days");
    starts_.reserve(intervals.size());
    sim::Duration start;
    for (const sim::Duration interval : intervals) {
      TAKT_CHECK(interval >= sim::Duration() && interval <= longest - start,
                 "intervals are not negative and at most 13 days");
      if (start < cycle_time) ++executed_;
      starts_.push_back(start);
      start += interval == sim::Duration() ? sim::Duration::from_ps(1'000) : interval;
    }
    inverse_ = std::numeric_limits<std::uint64_t>::max() / static_cast<std::uint64_t>(cycle_time.ps());
  }

  sim::Duration cycle_time() const { return cycle_time_; }
  std::uint32_t count() const { return static_cast<std::uint32_t>(starts_.size()); }
  /// How many entries begin before the end of a regular cycle; at least 1.
  std::uint32_t executed() const { return executed_; }
  sim::Duration start(std::uint32_t entry) const { return starts_[entry]; }
  /// The end of an executed entry in a regular cycle.
  sim::Duration end_in_cycle(std::uint32_t entry) const {
    return entry + 1 < executed_ ? starts_[entry + 1] : cycle_time_;
  }
  /// The entry in force at `offset` after the start of a cycle, among the first `entries`; the first one for negative
  /// offsets.
  std::uint32_t entry_at(sim::Duration offset, std::uint32_t entries) const {
    std::uint32_t low = 0;
    for (std::uint32_t size = entries; size > 1;) {
      const std::uint32_t half = size / 2;
      if (starts_[low + half] <= offset) low += half;
      size -= half;
    }
    return low;
  }
  /// How many whole cycles lie in `elapsed`, rounded down. A multiplication by the reciprocal is at most two short of
  /// it.
  std::int64_t cycles_in(sim::Duration elapsed) const {
    if (elapsed < sim::Duration()) return floor_quotient(elapsed, cycle_time_);
    auto cycles =
        static_cast<std::int64_t>(static_cast<sim::uint128>(static_cast<std::uint64_t>(elapsed.ps())) * inverse_ >> 64);
    while (elapsed - cycle_time_ * cycles >= cycle_time_) ++cycles;
    return cycles;
  }

 private:
  std::vector<sim::Duration> starts_;
  sim::Duration cycle_time_;
  std::uint64_t inverse_ = 0;  // floor((2^64 - 1) / cycle)
  std::uint32_t executed_ = 0;
};

/// The answer to a request for a change (SetConfigChangeTime, 8.6.9.3.1).
struct ConfigChange {
  sim::LocalTime config_change_time;
  bool error_counted = false;  ///< the base time lay in the past while a list was running: ConfigChangeError + 1
};

/// Which list is in force when. List is a type with `const CyclicIntervals& intervals() const`.
///
/// Time is that of the node's own synchronised clock. `now` does not decrease from call to call; if a clock is set back
/// all the same, the span in force is continued backwards. Within one instant the order is List Config, Cycle Timer,
/// List Execute. A list whose time has come is installed before a request of that instant is looked at; if the
/// request's own time has come too, its list takes over at once and no entry of the former one is executed in that
/// instant.
template <class List>
class CyclicSchedule {
 public:
  /// What management writes before it sets ConfigChange. Base times lie within 2^61 ps (26 days) of the clock's zero.
  struct AdminConfig {
    const List* admin_control_list = nullptr;  ///< with its cycle time; outlives the schedule
    sim::LocalTime admin_base_time;
    sim::Duration admin_cycle_time_extension;  ///< not negative
  };

  /// A stretch of time, [from, until), in which one list is in force.
  struct Span {
    const List* list = nullptr;  ///< none: the states before the first list
    sim::LocalTime from = sim::LocalTime::from_ps(std::numeric_limits<std::int64_t>::min());
    sim::LocalTime until = sim::LocalTime::never();
    sim::LocalTime anchor;  ///< a start of a cycle
    bool repeats = false;   ///< false: the cycle at `anchor` runs alone, and its last states stay until `until`
  };

  /// Where an instant lies: in which span, in which cycle, in which entry.
  struct Place {
    sim::LocalTime cycle_start;
    std::uint32_t entry = 0;
    std::uint32_t span = 0;
  };

  /// Accepts a change. Precondition: move_to(now) has been called. Calls move_to(now) again after it.
  ConfigChange request_change(sim::LocalTime now, const AdminConfig& admin) {
    TAKT_CHECK(admin.admin_control_list != nullptr, "a configuration has a list");
    TAKT_CHECK(magnitude_is_fine(admin.admin_base_time), "a base time lies within 26 days of the clock's zero");
    const sim::Duration extension = admin.admin_cycle_time_extension;
    TAKT_CHECK(extension >= sim::Duration() && extension <= CyclicIntervals::longest,
               "a cycle time extension is not negative and at most 13 days");
    const bool running = spans_[0].list != nullptr;
    const sim::Duration cycle = admin.admin_control_list->intervals().cycle_time();
    const ConfigChange change{first_cycle_from(now, admin.admin_base_time, cycle),
                              running && admin.admin_base_time < now};
    if (change.error_counted) ++config_change_error_;
    if (running) {
      lay_out_last_cycles(now, change.config_change_time);
    } else {
      span_count_ = 1;
      spans_[0].until = change.config_change_time;
    }
    append({admin.admin_control_list, change.config_change_time, sim::LocalTime::never(), change.config_change_time,
            true});
    pending_extension_ = extension;
    pending_base_time_ = admin.admin_base_time;
    forget_place();
    return change;
  }

  /// True if here() is the place of `now`. The hot path is this one test.
  bool is_at(sim::LocalTime now) const { return now >= here_from_ && now < here_until_; }
  /// The place of the latest `now`.
  const Place& here() const { return here_; }
  /// When the entry of here() ends or its span does.
  sim::LocalTime here_until() const { return here_until_; }

  /// The present span is over at `now`: drop_present() comes next.
  bool present_is_over(sim::LocalTime now) const { return now >= spans_[0].until; }
  void drop_present() {
    TAKT_CHECK(span_count_ > 1, "only a span that another one follows can end");
    for (std::uint32_t i = 1; i < span_count_; ++i) spans_[i - 1] = spans_[i];
    --span_count_;
    if (span_count_ == 1) {  // UPDATE_CONFIG
      oper_base_time_ = pending_base_time_;
      oper_cycle_time_extension_ = pending_extension_;
      latched_for_ = sim::LocalTime::never();
    }
    forget_place();
  }
  /// Makes here() the place of `now`, which lies in the present span.
  void seek(sim::LocalTime now) {
    const Span& present = spans_[0];
    if (!present.repeats) [[unlikely]] {
      here_ = place_in(0, now);
      here_from_ = start_of(here_);
      here_until_ = end_of(here_);
      return;
    }
    const CyclicIntervals& intervals = present.list->intervals();
    sim::Duration offset = now - here_.cycle_start;
    if (offset < sim::Duration() || offset >= intervals.cycle_time()) {
      here_.cycle_start += intervals.cycle_time() * intervals.cycles_in(offset);
      offset = now - here_.cycle_start;
    }
    here_.entry = intervals.entry_at(offset, intervals.executed());
    here_from_ = here_.cycle_start + intervals.start(here_.entry);
    here_until_ = std::min(here_.cycle_start + intervals.end_in_cycle(here_.entry), present.until);
  }
  void move_to(sim::LocalTime now) {
    while (present_is_over(now)) drop_present();
    seek(now);
  }

  const Span& span(std::uint32_t index) const { return spans_[index]; }
  const Span& span_of(const Place& place) const { return spans_[place.span]; }
  const Span& present() const { return spans_[0]; }
  /// The list that is running, or none.
  const List* oper_control_list() const { return spans_[0].list; }
  sim::LocalTime oper_base_time() const { return oper_base_time_; }
  sim::Duration oper_cycle_time_extension() const { return oper_cycle_time_extension_; }
  bool config_pending() const { return span_count_ > 1; }
  /// Of the pending change, or of the last one; means nothing before the first request.
  sim::LocalTime config_change_time() const { return spans_[span_count_ - 1].from; }
  std::uint64_t config_change_error() const { return config_change_error_; }

  /// The place of `time` in span `index`, which is in force then.
  Place place_in(std::uint32_t index, sim::LocalTime time) const {
    const Span& span = spans_[index];
    if (span.list == nullptr) return {span.from, 0, index};
    const CyclicIntervals& intervals = span.list->intervals();
    if (!span.repeats) return {span.anchor, intervals.entry_at(time - span.anchor, intervals.count()), index};
    const sim::LocalTime start = span.anchor + intervals.cycle_time() * intervals.cycles_in(time - span.anchor);
    return {start, intervals.entry_at(time - start, intervals.executed()), index};
  }
  /// The first place of the span after this one.
  Place place_after(std::uint32_t index) const { return place_in(index + 1, spans_[index + 1].from); }

  /// When the entry of this place began.
  sim::LocalTime start_of(const Place& place) const {
    const List* const list = spans_[place.span].list;
    return list == nullptr ? place.cycle_start : place.cycle_start + list->intervals().start(place.entry);
  }
  /// When the entry of this place ends, or the span does.
  sim::LocalTime end_of(const Place& place) const {
    const Span& span = spans_[place.span];
    if (span.list == nullptr) return span.until;
    const CyclicIntervals& intervals = span.list->intervals();
    if (!span.repeats && place.entry + 1 == intervals.count()) return span.until;
    const sim::Duration end = span.repeats ? intervals.end_in_cycle(place.entry) : intervals.start(place.entry + 1);
    return std::min(place.cycle_start + end, span.until);
  }
  /// Moves to the entry that follows in the same span; false if none does.
  bool next_entry(Place& place) const {
    const Span& span = spans_[place.span];
    if (span.list == nullptr || end_of(place) >= span.until) return false;
    const CyclicIntervals& intervals = span.list->intervals();
    ++place.entry;
    if (span.repeats && place.entry == intervals.executed()) {
      place.entry = 0;
      place.cycle_start += intervals.cycle_time();
    }
    return true;
  }

 private:
  // The present span up to a cycle that must still begin, one irregular cycle, regular cycles, the stretched one, the
  // new list.
  static constexpr std::uint32_t span_limit = 5;

  static constexpr bool magnitude_is_fine(sim::LocalTime time) {
    return time.ps() <= std::int64_t{1} << 61 && time.ps() >= -(std::int64_t{1} << 61);
  }

  void append(const Span& span) {
    TAKT_CHECK(span_count_ < span_limit, "the spans up to a change are at most five");
    spans_[span_count_++] = span;
  }

  /// The cycle start after `start` that the base time gives: oper_base_time + N * oper_cycle_time.
  sim::LocalTime next_regular_start(sim::LocalTime start) const {
    const sim::Duration cycle = spans_[0].list->intervals().cycle_time();
    return oper_base_time_ + cycle * (floor_quotient(start - oper_base_time_, cycle) + 1);
  }

  /// How the running list goes on to its end at `change` (SetCycleStartTime, 8.6.9.1.1).
  ///
  /// CycleStartTime is chosen when a cycle starts, and stays: a request in the middle of a cycle moves only the starts
  /// after the next one. From the first start on from which the change is at most a cycle and the extension away, no
  /// other follows.
  void lay_out_last_cycles(sim::LocalTime now, sim::LocalTime change) {
    const List* const list = spans_[0].list;
    const sim::Duration cycle = list->intervals().cycle_time();
    const sim::Duration reach = cycle + oper_cycle_time_extension_;
    const sim::LocalTime present_start = place_in(0, now).cycle_start;
    sim::LocalTime start = present_start;  // the first start that takes the change into account
    if (now != present_start) {
      if (latched_for_ != present_start) {  // no request in this cycle yet: what is pending was so when it started
        const sim::LocalTime former = config_change_time();
        const bool former_counts = config_pending() && former <= present_start + reach;
        latched_start_ = former_counts ? former : next_regular_start(present_start);
        latched_for_ = present_start;
      }
      start = latched_start_;
    }
    span_count_ = 1;
    spans_[0].until = std::min(start, change);
    while (start < change) {
      const sim::LocalTime next = next_regular_start(start);
      if (change <= start + reach) {
        append({list, start, change, start, false});
        start = change;
      } else if (next == start + cycle) {
        const sim::LocalTime last = start + cycle * ceil_quotient(change - reach - start, cycle);
        append({list, start, last, start, true});
        start = last;
      } else {
        append({list, start, next, start, false});
        start = next;
      }
    }
  }

  void forget_place() {
    here_ = {spans_[0].anchor, 0, 0};
    here_from_ = sim::LocalTime::never();  // an interval that holds no instant
    here_until_ = sim::LocalTime::from_ps(std::numeric_limits<std::int64_t>::min());
  }

  Place here_;
  sim::LocalTime here_from_ = sim::LocalTime::from_ps(std::numeric_limits<std::int64_t>::min());
  sim::LocalTime here_until_ = sim::LocalTime::never();
  std::array<Span, span_limit> spans_{};
  std::uint32_t span_count_ = 1;
  sim::LocalTime oper_base_time_;
  sim::Duration oper_cycle_time_extension_;
  sim::LocalTime pending_base_time_;
  sim::Duration pending_extension_;
  sim::LocalTime latched_for_ = sim::LocalTime::never();  // the cycle in which a request came
  sim::LocalTime latched_start_;                          // ... and the CycleStartTime that had been chosen for it
  std::uint64_t config_change_error_ = 0;
};

}  // namespace takt::models
