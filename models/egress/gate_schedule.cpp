// SPDX-License-Identifier: Apache-2.0
#include "models/egress/gate_schedule.hpp"

namespace takt::models {
namespace {

using sim::Duration;
using sim::LocalTime;

/// Does a frame of that duration that starts at `start` end by `close`?
bool fits(LocalTime start, LocalTime close, Duration duration) {
  return close == LocalTime::never() || start <= close - duration;
}

}  // namespace

ConfigChange GateSchedule::request_change(LocalTime now, const AdminConfig& admin) {
  move_to(now);
  known_ = {};
  const ConfigChange change = schedule_.request_change(now, admin);
  move_to(now);
  return change;
}

LocalTime GateSchedule::close_time(TrafficClass q, LocalTime now) {
  Place place = here(now);
  return is_open_in(place, q) ? walk_to_toggle(place, q) : now;
}

LocalTime GateSchedule::open_time(TrafficClass q, LocalTime now) {
  Place place = here(now);
  return is_open_in(place, q) ? now : walk_to_toggle(place, q);
}

GateWindow GateSchedule::window(TrafficClass q, LocalTime now) {
  Place place = here(now);
  const LocalTime from = is_open_in(place, q) ? now : walk_to_toggle(place, q);
  return {from, from == LocalTime::never() ? from : walk_to_toggle(place, q)};
}

LocalTime GateSchedule::next_change(LocalTime now) {
  const Place& place = here(now);
  LocalTime next = LocalTime::never();
  for (TrafficClass q = 0; q < traffic_class_count; ++q) {
    Place walk = place;
    next = std::min(next, walk_to_toggle(walk, q));
  }
  return next;
}

LocalTime GateSchedule::next_hold_change(LocalTime now) {
  Place place = here(now);
  return walk_to_hold_change(place);
}

HoldRequest GateSchedule::hold_request(LocalTime now, Duration hold_advance, Duration release_advance) {
  Place place = here(now);
  bool begun = holds_in(place);  // the period that is looked at has begun, whatever the advance
  LocalTime begin = begun ? now : walk_to_hold_change(place);
  LocalTime end = now;  // of the request, as far as it is known
  bool hold = false;
  for (;;) {
    if (begin == LocalTime::never()) return {hold, hold ? end : begin};
    const LocalTime requested = begun ? now : begin - hold_advance;
    if (hold ? requested > end : requested > now) return {hold, hold ? end : requested};
    const LocalTime release = walk_to_hold_change(place);
    if (release == LocalTime::never()) return {true, release};
    if (release - release_advance > now) {
      end = hold ? std::max(end, release - release_advance) : release - release_advance;
      hold = true;
    }
    begin = walk_to_hold_change(place);
    begun = false;
    const Schedule::Span& span = schedule_.span_of(place);
    if (!hold || begin == LocalTime::never() || !span.repeats ||
        begin - std::max(now, span.from) <= 2 * span.list->cycle_time())
      continue;
    // The advances are longer than each gap of the cycle: what has joined for a whole cycle joins as long as the list
    // runs.
    if (span.until == LocalTime::never()) return {true, span.until};
    const LocalTime near_end = span.until - 2 * span.list->cycle_time();
    if (near_end <= begin) continue;
    place = schedule_.place_in(place.span, near_end);
    if (holds_in(place)) walk_to_hold_change(place);
    begin = walk_to_hold_change(place);
    end = begin - hold_advance;
  }
}

OpenShare GateSchedule::open_share(TrafficClass q, LocalTime now) {
  const Place& place = here(now);
  if (const GateControlList* const list = schedule_.oper_control_list()) return list->open_share(q);
  return {Duration::from_ps(is_open_in(place, q) ? 1 : 0), Duration::from_ps(1)};
}

void GateSchedule::move_to(LocalTime now) {
  while (schedule_.present_is_over(now)) {
    hold_before_present_ = inherited_hold(1);
    schedule_.drop_present();
  }
  schedule_.seek(now);
}

/// Within one span: the instant of the next change of gate q, and the place that makes it; never() if the list has
/// none.
LocalTime GateSchedule::toggle_in_span(Place& place, TrafficClass q) const {
  const Schedule::Span& span = schedule_.span_of(place);
  if (span.list == nullptr) return LocalTime::never();
  const CyclicIntervals& intervals = span.list->intervals();
  if (span.repeats) {
    const GateControlList::Ahead& ahead = span.list->ahead(place.entry, q);
    if (ahead.toggle_ps == GateControlList::no_toggle_ps) return LocalTime::never();
    const LocalTime toggle = place.cycle_start + Duration::from_ps(ahead.toggle_ps);
    place.entry = ahead.toggled_by;
    place.cycle_start = toggle - intervals.start(place.entry);
    return toggle;
  }
  const bool open = is_open_in(place, q);
  while (++place.entry < intervals.count())
    if (is_open_in(place, q) != open) return place.cycle_start + intervals.start(place.entry);
  return LocalTime::never();
}

/// Moves to where gate q next takes its other state, and says when that is; never() if it keeps the state.
LocalTime GateSchedule::walk_to_toggle(Place& place, TrafficClass q) const {
  const bool open = is_open_in(place, q);
  for (;;) {
    const LocalTime until = schedule_.span_of(place).until;
    const LocalTime toggle = toggle_in_span(place, q);
    if (toggle < until) return toggle;
    if (until == LocalTime::never()) return until;
    place = schedule_.place_after(place.span);
    if (is_open_in(place, q) != open) return until;
  }
}

/// Looks at one window after the other; in a list whose windows are all too short only at those near its end.
StartAnswer GateSchedule::may_start_by_search(const Place& place, TrafficClass q, LocalTime now,
                                              Duration duration) const {
  TAKT_CHECK(duration >= Duration(), "a frame lasts for some time");
  Place walk = place;
  if (is_open_in(walk, q) && fits(now, walk_to_toggle(walk, q), duration)) return {true, now};
  // Now `walk` is where the gate closes, or still in the closed place of now: either way the next toggle opens it.
  for (LocalTime open = walk_to_toggle(walk, q); open != LocalTime::never(); open = walk_to_toggle(walk, q)) {
    const Schedule::Span& span = schedule_.span_of(walk);
    if (span.repeats && duration > span.list->longest_window(q)) {
      if (span.until == LocalTime::never()) break;
      // Only the window that goes on into the next span can be long enough; it begins in the last cycle.
      const LocalTime near_end = span.until - 2 * span.list->cycle_time();
      if (near_end > open) {
        walk = schedule_.place_in(walk.span, near_end);
        if (is_open_in(walk, q)) walk_to_toggle(walk, q);
        continue;
      }
    }
    if (fits(open, walk_to_toggle(walk, q), duration)) return {false, open};
  }
  return {false, LocalTime::never()};
}

bool GateSchedule::holds_in(const Place& place) const {
  const Schedule::Span& span = schedule_.span_of(place);
  if (span.list == nullptr) return inherited_hold(place.span);
  const GateControlList& list = *span.list;
  if (span.repeats) {
    const std::uint32_t first = list.first_hold_or_release();
    const bool first_cycle = place.cycle_start <= span.from;
    if (first == list.intervals().executed() || (first_cycle && place.entry < first)) return inherited_hold(place.span);
    return list.holds(place.entry);
  }
  for (std::uint32_t entry = place.entry + 1; entry-- > 0;) {
    const GateOperation operation = list.entries()[entry].operation;
    if (operation != GateOperation::set_gate_states) return operation == GateOperation::set_and_hold_mac;
  }
  return inherited_hold(place.span);
}

/// Whether the MAC held when that span began.
bool GateSchedule::inherited_hold(std::uint32_t span) const {
  if (span == 0) return hold_before_present_;
  const Schedule::Span& former = schedule_.span(span - 1);
  if (former.until <= former.from) return inherited_hold(span - 1);
  return holds_in(schedule_.place_in(span - 1, former.until - Duration::from_ps(1)));
}

/// Moves to where holds() changes next, and says when that is; never() if it does not.
LocalTime GateSchedule::walk_to_hold_change(Place& place) const {
  bool hold = holds_in(place);
  const bool before = hold;
  const auto changes = [&] {
    const GateOperation operation = schedule_.span_of(place).list->entries()[place.entry].operation;
    if (operation != GateOperation::set_gate_states) hold = operation == GateOperation::set_and_hold_mac;
    return hold != before;
  };
  for (;;) {
    const Schedule::Span& span = schedule_.span_of(place);
    // After two cycles without a change there is none until the span ends.
    const std::uint32_t entries = span.list == nullptr ? 0 : 2 * span.list->intervals().count();
    for (std::uint32_t i = 0; i < entries && schedule_.next_entry(place); ++i)
      if (changes()) return schedule_.start_of(place);
    if (span.until == LocalTime::never()) return span.until;
    const LocalTime until = span.until;
    place = schedule_.place_after(place.span);
    if (changes()) return until;
  }
}

}  // namespace takt::models
