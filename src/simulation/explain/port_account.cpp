// SPDX-License-Identifier: Apache-2.0
#include "explain/port_account.hpp"

#include <algorithm>

#include "sim/check.hpp"

namespace takt::explain {
namespace {

Cause cause_of(models::BlockReason hindrance, bool has_launch_time) {
  switch (hindrance) {
    case models::BlockReason::gate_closed:
      return Cause::gate_closed;
    case models::BlockReason::guard:
      return Cause::guard;
    case models::BlockReason::credit:
      return Cause::credit;
    case models::BlockReason::not_eligible:
      return has_launch_time ? Cause::launch_time : Cause::ats;
    case models::BlockReason::hold:
      return Cause::hold;
    case models::BlockReason::count:
      break;
  }
  TAKT_CHECK(false, "a hindrance that the models know");
  return Cause::hold;
}

void append(std::vector<Part>& parts, Part part) {
  if (part.length == Duration()) return;
  if (!parts.empty()) {
    Part& last = parts.back();
    if (last.cause == part.cause && last.who == part.who && last.amount == part.amount &&
        last.begin + last.length == part.begin) {
      last.length += part.length;
      return;
    }
  }
  parts.push_back(part);
}

}  // namespace

PortAccount::Decision& PortAccount::decision_at(TrueTime now) {
  if (decisions_.empty() || decisions_.back().at != now) decisions_.push_back({.at = now});
  return decisions_.back();
}

void PortAccount::started(TrueTime now, TrueTime free_at, FrameName frame, models::TrafficClass q, bool is_rest) {
  Decision& decision = decision_at(now);
  decision.starts = true;
  decision.frame = frame;
  decision.free_at = free_at;
  decision.traffic_class = q;
  decision.is_rest = is_rest;
}

void PortAccount::cut(Duration occupied) {
  const auto last =
      std::find_if(decisions_.rbegin(), decisions_.rend(), [](const Decision& decision) { return decision.starts; });
  TAKT_CHECK(last != decisions_.rend(), "what is cut has started");
  last->free_at = last->at + occupied;
}

void PortAccount::refused(TrueTime now, TrueTime until, const models::BlockedRecord& refusal) {
  decision_at(now).refusals.emplace_back(refusal, until);
}

std::optional<FrameName> PortAccount::last_started() const {
  const auto last =
      std::find_if(decisions_.rbegin(), decisions_.rend(), [](const Decision& decision) { return decision.starts; });
  return last != decisions_.rend() ? std::optional(last->frame) : std::nullopt;
}

void PortAccount::forget(TrueTime now) {
  if (decisions_.empty() || (decisions_.size() == 1 && decisions_.front().starts)) return;
  const bool has_present = decisions_.back().at == now;
  const auto present = decisions_.end() - (has_present ? 1 : 0);
  auto behind = present;  // the last start before
  while (behind != decisions_.begin() && !std::prev(behind)->starts) --behind;
  const auto kept = behind == decisions_.begin() ? behind : std::prev(behind);
  const auto first = static_cast<std::size_t>(kept - decisions_.begin());
  decisions_.erase(behind, present);
  decisions_.erase(decisions_.begin(), decisions_.begin() + static_cast<std::ptrdiff_t>(first));
}

/// Two decisions from then or before are kept: that in force then, and the last start up to it. Each one is looked at
/// and erased once, near the front.
void PortAccount::forget_before(TrueTime earliest) {
  const auto is_past = [&](std::size_t number) {
    return number < decisions_.size() && decisions_[number].at <= earliest;
  };
  while (is_past(1)) {
    if (decisions_[1].starts || !decisions_.front().starts)
      decisions_.pop_front();
    else if (is_past(2))
      decisions_.erase(decisions_.begin() + 1);
    else
      return;
  }
}

void PortAccount::explain(const Waiting& waiting, std::vector<Part>& parts) const {
  // The decision that is in force when it begins to wait: one of that very instant counts.
  auto next = std::upper_bound(decisions_.begin(), decisions_.end(), waiting.from,
                               [](TrueTime time, const Decision& decision) { return time < decision.at; });
  const Decision* on_medium = nullptr;
  for (auto d = next; on_medium == nullptr && d != decisions_.begin();)
    if (--d; d->starts) on_medium = &*d;
  const auto is_ours = [&](const std::pair<models::BlockedRecord, TrueTime>& told) {
    return told.first.traffic_class == waiting.traffic_class && told.first.of_rest == waiting.is_rest;
  };
  TrueTime at = waiting.from;
  while (at < waiting.until) {
    TAKT_CHECK(next != decisions_.begin(), "a frame that waits has a reason");
    const Decision& decision = *std::prev(next);
    const TrueTime end = next == decisions_.end() ? waiting.until : std::min(waiting.until, next->at);
    for (const auto& told : decision.refusals) {
      const auto& [refusal, until] = told;
      if (!is_ours(told) || until <= at) continue;
      const bool has_amount =
          refusal.hindrance == models::BlockReason::credit ||
          ((refusal.hindrance == models::BlockReason::gate_closed || refusal.hindrance == models::BlockReason::guard) &&
           refusal.amount != models::BlockedRecord::no_entry);
      const TrueTime so_far = std::min(until, end);
      append(parts, {cause_of(refusal.hindrance, waiting.has_launch_time),
                     at,
                     so_far - at,
                     {},
                     has_amount ? refusal.amount : Part::no_amount});
      at = so_far;
    }
    if (at < end) {
      TAKT_CHECK(on_medium != nullptr && on_medium->free_at >= end,
                 "a frame waits for the medium only while another one has it");
      const models::TrafficClass q = on_medium->traffic_class;
      // An express frame, or a class that shares bandwidth, may go before a higher class; the rest of a frame that was
      // cut was on the medium before.
      const bool might_start =
          on_medium->at >= waiting.from && !on_medium->is_rest && std::ranges::none_of(on_medium->refusals, is_ours);
      const Cause cause = q > waiting.traffic_class    ? Cause::higher_class
                          : q == waiting.traffic_class ? Cause::own_class
                          : might_start                ? Cause::precedence
                                                       : Cause::lower_class;
      append(parts, {cause, at, end - at, on_medium->frame});
      at = end;
    }
    if (next != decisions_.end()) {
      if (next->starts) on_medium = &*next;
      ++next;
    }
  }
}

}  // namespace takt::explain
