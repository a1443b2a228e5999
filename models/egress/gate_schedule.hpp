// SPDX-License-Identifier: Apache-2.0
// The transmission gates of a port as a function of the node's own synchronised time (IEEE 802.1Q
// clauses 8.6.8.4, 8.6.9).
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <optional>

#include "models/egress/cyclic_schedule.hpp"
#include "models/egress/gate_control_list.hpp"

namespace takt::models {

/// May a frame start now, and if not, when can that become true?
struct StartAnswer {
  bool may_start = false;
  /// If not: the earliest instant after now at which the same question is answered by yes, unless the configuration
  /// changes before; never() if there is none.
  sim::LocalTime ask_again = sim::LocalTime::never();
  bool operator==(const StartAnswer&) const = default;
};

/// A stretch of time, [from, until), in which a gate is open.
struct GateWindow {
  sim::LocalTime from;
  sim::LocalTime until;
  bool operator==(const GateWindow&) const = default;
};

/// Whether the MAC Merge sublayer is asked to hold preemptable frames (MM_CTL.request), and until when that stays so.
struct HoldRequest {
  bool hold = false;
  sim::LocalTime until = sim::LocalTime::never();
  bool operator==(const HoldRequest&) const = default;
};

/// The gates of one port. Before the first list runs they are in `admin_gate_states`; the MAC does not hold then.
///
/// All queries take the node's time, which does not decrease from call to call; the list is exchanged by the first call
/// at or after ConfigChangeTime. Answers about the future assume that no other change is requested; a caller that keeps
/// one asks again after request_change(). A window is open up to its end and not at it: a frame may end exactly when
/// its gate closes.
class GateSchedule {
 public:
  using AdminConfig = CyclicSchedule<GateControlList>::AdminConfig;

  explicit GateSchedule(GateStates admin_gate_states = all_gates_open) : admin_gate_states_(admin_gate_states) {}

  /// Management sets ConfigChange. The list outlives the schedule. A request while a change is pending takes its place.
  ConfigChange request_change(sim::LocalTime now, const AdminConfig& admin);

  GateStates gate_states(sim::LocalTime now) { return states_in(here(now)); }
  /// The entry of the list that is in force, from 0; nothing before the first list.
  std::optional<std::size_t> entry(sim::LocalTime now) {
    const Place& place = here(now);
    return schedule_.span_of(place).list == nullptr ? std::nullopt : std::optional<std::size_t>(place.entry);
  }
  bool is_open(TrafficClass q, sim::LocalTime now) { return is_open_in(here(now), q); }
  /// The first instant at or after `now` at which gate q is closed, looking through consecutive open entries, over the
  /// ends of cycles and a pending change; never() if it stays open.
  sim::LocalTime close_time(TrafficClass q, sim::LocalTime now);
  /// The first instant at or after `now` at which gate q is open; never() if it stays closed.
  sim::LocalTime open_time(TrafficClass q, sim::LocalTime now);
  /// From `now` on, or from the next opening, to the close; {never, never} if gate q stays closed.
  GateWindow window(TrafficClass q, sim::LocalTime now);
  /// The first instant after `now` at which any gate changes its state.
  sim::LocalTime next_change(sim::LocalTime now);

  /// True if such a frame may start since it fits into the window in which may_start() has last said that one of the
  /// class may, or into the one a cycle later, which is the one that is known from then on. False: no answer.
  bool starts_in_known_window(TrafficClass q, sim::LocalTime now, sim::Duration duration) {
    return is_in_known_window(q, now, duration) || is_in_next_known_window(q, now, duration);
  }
  /// May a frame of class q that lasts for `duration` (not negative) start now and end before its gate closes
  /// (8.6.8.4)? Which octets are part of the duration is the caller's choice.
  StartAnswer may_start(TrafficClass q, sim::LocalTime now, sim::Duration duration) {
    const Schedule::Span& present = schedule_.present();
    if (present.repeats && present.until == sim::LocalTime::never()) [[likely]]
      return may_start_in_list(present, q, now, duration);
    const Place& place = here(now);
    const Schedule::Span& span = schedule_.present();
    if (span.repeats) {
      const GateControlList::Ahead& ahead = span.list->ahead(place.entry, q);
      const std::int64_t left_ps = ahead.toggle_ps - (now - place.cycle_start).ps();
      const sim::LocalTime latest_start = span.until - duration;  // of what ends before the list does
      if (ahead.open && duration.ps() <= left_ps && now <= latest_start) return {true, now};
      const sim::LocalTime open = place.cycle_start + sim::Duration::from_ps(ahead.next_open_ps);
      if (duration.ps() <= ahead.next_window_ps && open <= latest_start && open < span.until) return {false, open};
    }
    return may_start_by_search(place, q, now, duration);
  }

  /// An entry Set-And-Hold-MAC is in force, and no Set-And-Release-MAC has come after it.
  bool holds(sim::LocalTime now) { return holds_in(here(now)); }
  /// The first instant after `now` at which holds() changes.
  sim::LocalTime next_hold_change(sim::LocalTime now);
  /// What the MAC is asked for: hold from hold_advance before the entry that holds to release_advance before the entry
  /// that releases; periods that meet by that are one. Costs a walk along the list: the caller keeps the answer until
  /// `until`.
  HoldRequest hold_request(sim::LocalTime now, sim::Duration hold_advance, sim::Duration release_advance);

  /// The part of the running list's cycle in which gate q is open; {1, 1} or {0, 1} before the first list.
  OpenShare open_share(TrafficClass q, sim::LocalTime now);

  const GateControlList* oper_control_list(sim::LocalTime now) {
    here(now);
    return schedule_.oper_control_list();
  }
  sim::LocalTime oper_base_time(sim::LocalTime now) {
    here(now);
    return schedule_.oper_base_time();
  }
  sim::Duration oper_cycle_time_extension(sim::LocalTime now) {
    here(now);
    return schedule_.oper_cycle_time_extension();
  }
  bool config_pending(sim::LocalTime now) {
    here(now);
    return schedule_.config_pending();
  }
  sim::LocalTime config_change_time() const { return schedule_.config_change_time(); }
  std::uint64_t config_change_error() const { return schedule_.config_change_error(); }

 private:
  using Schedule = CyclicSchedule<GateControlList>;
  using Place = Schedule::Place;

  const Place& here(sim::LocalTime now) {
    if (!schedule_.is_at(now)) [[unlikely]]
      move_to(now);
    return schedule_.here();
  }
  void move_to(sim::LocalTime now);

  GateStates states_in(const Place& place) const {
    const GateControlList* const list = schedule_.span_of(place).list;
    return list == nullptr ? admin_gate_states_ : list->entries()[place.entry].gate_states;
  }
  bool is_open_in(const Place& place, TrafficClass q) const { return (states_in(place) >> q & 1) != 0; }
  sim::LocalTime walk_to_toggle(Place& place, TrafficClass q) const;
  sim::LocalTime toggle_in_span(Place& place, TrafficClass q) const;
  /// The same under a list that runs for ever: one look at the windows of the class.
  StartAnswer may_start_in_list(const Schedule::Span& span, TrafficClass q, sim::LocalTime now,
                                sim::Duration duration) {
    const GateControlList& list = *span.list;
    if (cursor_list_ != &list || cursor_anchor_ != span.anchor) [[unlikely]] {
      cursor_list_ = &list;
      cursor_anchor_ = cursor_ = span.anchor;
    }
    const std::int64_t cycle_ps = list.cycle_time().ps();
    std::int64_t at_ps = (now - cursor_).ps();
    if (at_ps < 0 || at_ps >= cycle_ps) {
      cursor_ += at_ps >= 0 && at_ps < 2 * cycle_ps
                     ? list.cycle_time()
                     : list.cycle_time() * list.intervals().cycles_in(sim::Duration::from_ps(at_ps));
      at_ps = (now - cursor_).ps();
    }
    const std::span<const GateControlList::Window> windows = list.windows(q);
    const std::int64_t duration_ps = duration.ps();
    for (const GateControlList::Window& window : windows) {
      if (at_ps >= window.from_ps) {
        if (at_ps < window.until_ps && at_ps + duration_ps <= window.until_ps) {
          know(q, window, list.cycle_time());
          return {true, now};
        }
      } else if (window.from_ps + duration_ps <= window.until_ps) {
        know(q, window, list.cycle_time());
        return {false, cursor_ + sim::Duration::from_ps(window.from_ps)};
      }
    }
    for (const GateControlList::Window& window : windows) {
      if (window.from_ps + cycle_ps <= at_ps || window.from_ps + duration_ps > window.until_ps) continue;
      know(q, {window.from_ps + cycle_ps, window.until_ps + cycle_ps}, list.cycle_time());
      return {false, cursor_ + sim::Duration::from_ps(window.from_ps + cycle_ps)};
    }
    return {false, sim::LocalTime::never()};
  }
  /// Windows may begin in the cycle before, and times before 0; never() beyond the last instant.
  static sim::LocalTime moved(sim::LocalTime time, std::int64_t ps) {
    std::int64_t sum = 0;
    return __builtin_add_overflow(time.ps(), ps, &sum) ? sim::LocalTime::never() : sim::LocalTime::from_ps(sum);
  }
  void know(TrafficClass q, const GateControlList::Window& window, sim::Duration cycle) {
    if (window.from_ps > -CyclicIntervals::longest.ps()) {
      const sim::LocalTime from = moved(cursor_, window.from_ps);
      known_ = {q, cycle, from, moved(cursor_, window.until_ps), moved(from, cycle.ps())};
    } else {
      known_ = {q, cycle, sim::LocalTime::from_ps(std::numeric_limits<std::int64_t>::min()), sim::LocalTime::never(),
                sim::LocalTime::never()};  // it is always open
    }
  }
  bool is_in_known_window(TrafficClass q, sim::LocalTime now, sim::Duration duration) const {
    return q == known_.traffic_class && now >= known_.from && now <= known_.until - duration;
  }
  bool is_in_next_known_window(TrafficClass q, sim::LocalTime now, sim::Duration duration) {
    if (now < known_.next_from) return false;
    known_.from = known_.next_from;
    known_.until = moved(known_.until, known_.cycle.ps());
    known_.next_from = moved(known_.from, known_.cycle.ps());
    return is_in_known_window(q, now, duration);
  }
  StartAnswer may_start_by_search(const Place& place, TrafficClass q, sim::LocalTime now, sim::Duration duration) const;
  bool holds_in(const Place& place) const;
  bool inherited_hold(std::uint32_t span) const;
  sim::LocalTime walk_to_hold_change(Place& place) const;

  Schedule schedule_;
  GateStates admin_gate_states_;
  // Where may_start_in_list() looked last: the start of a cycle of that list.
  const GateControlList* cursor_list_ = nullptr;
  sim::LocalTime cursor_anchor_;
  sim::LocalTime cursor_;
  /// A window of a list that runs for ever.
  struct KnownWindow {
    TrafficClass traffic_class = 0;
    sim::Duration cycle;
    sim::LocalTime from = sim::LocalTime::never();  // at first one that holds no instant
    sim::LocalTime until;
    sim::LocalTime next_from = sim::LocalTime::never();  // a cycle later
  };
  KnownWindow known_;
  bool hold_before_present_ = false;  // whether the MAC held when the present span began
};

}  // namespace takt::models
