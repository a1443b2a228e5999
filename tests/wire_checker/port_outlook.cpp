// SPDX-License-Identifier: Apache-2.0
// When a frame that waits may start, and when one under way must be cut: what PortChecker derives from the
// configuration.
#include <algorithm>

#include "tests/wire_checker/port_checker.hpp"

namespace takt::wire_checker {

using models::traffic_class_count;
using models::TrafficClass;

bool PortChecker::gate_open(TrafficClass q, const ListMachine& gates) const {
  return forced_[q].value_or(gates.is_open(q));
}

/// The earliest instant at or after `from` at which gate q is open for so long; never if the lists show none.
Ps PortChecker::fit(TrafficClass q, Ps from, Ps duration, ListMachine gates) const {
  if (forced_[q]) return *forced_[q] ? from : never;
  if (!has_gates_) return from;
  gates.run_to(from);
  const Ps horizon = gates.horizon();
  for (;;) {
    while (!gates.is_open(q)) {
      const Ps next = gates.next_event();
      if (next > horizon) return never;
      gates.run_to(next);
    }
    const Ps start = std::max(from, gates.now());
    do {
      const Ps next = gates.next_event();
      if (next == never || next - start >= duration) return start;
      gates.run_to(next);
    } while (gates.is_open(q));
  }
}

/// Takes an account and its list on to `time`.
void PortChecker::follow(TrafficClass q, CreditAccount& credit, ListMachine& gates, Ps time) const {
  for (;;) {
    const Ps next = std::min(gates.next_event(), time);
    credit.flow(next, gate_open(q, gates));
    if (next == time) return;
    gates.run_to(next);
    credit.follow_list(gates.oper());
  }
}

/// The earliest instant at or after `from` at which a frame of that duration may start in class q, preemption aside.
Ps PortChecker::ready_time(TrafficClass q, Ps from, Ps eligible, Ps duration) const {
  Outlook outlook{credits_[q], gates_};
  return ready_time(q, from, eligible, duration, outlook);
}

/// The same; `outlook` comes along, for whoever asks again for later. Where the gate is open for a little in each
/// cycle, a slow account needs thousands of cycles, so they are gone through once.
Ps PortChecker::ready_time(TrafficClass q, Ps from, Ps eligible, Ps duration, Outlook& outlook) const {
  Ps time = is_timed(q) ? std::max(from, eligible) : from;
  for (int attempt = 0; attempt < 1000; ++attempt) {
    time = fit(q, time, duration, outlook.gates);
    if (time == never || !outlook.credit) return time;
    follow(q, *outlook.credit, outlook.gates, time);
    const Ps growth = outlook.credit->growth_needed();
    if (growth == 0) return time;
    if (growth > never - time) return never;
    time += growth;
  }
  return never;
}

bool PortChecker::is_ready(TrafficClass q, const Item& item) const {
  if (ready_time(q, now_, item.eligible, duration_of(item.length)) != now_) return false;
  return !is_preemptable(q) || (!rest_ && !hold_at(now_, gates_).asked);
}

/// Whether the MAC is asked to hold at `time`, and until when that stays so. A release that comes in advance of the
/// whole time of a hold leaves nothing of it.
PortChecker::HoldState PortChecker::hold_at(Ps time, ListMachine gates) const {
  if (!may_hold_ || !config_.preemption) return {};
  const Ps release_advance = config_.preemption->release_advance.ps();
  gates.run_to(std::max(time, gates.now()));
  const Ps horizon = gates.horizon() + hold_advance_;
  Ps asked_from = gates.holds() ? long_ago : never;
  for (;;) {
    const Ps next = gates.next_event();
    if (next > horizon) return {asked_from <= time, asked_from > time ? asked_from : never};
    const bool before = gates.holds();
    gates.run_to(next);
    if (gates.holds() == before) continue;
    if (gates.holds()) {
      asked_from = next - hold_advance_;
    } else {
      const Ps released = next - release_advance;
      if (asked_from < released && time < released)
        return {asked_from <= time, asked_from <= time ? released : asked_from};
      asked_from = never;
    }
  }
}

/// When the medium, free from `from` on, is due to be used.
Ps PortChecker::idle_due(Ps from) const {
  const auto beyond_hold = [&](TrafficClass q, Ps eligible, Ps duration, bool is_rest) {
    Ps time = from;
    Outlook outlook{credits_[q], gates_};
    outlook.gates.run_to(std::max(from, outlook.gates.now()));
    const Ps horizon = outlook.gates.horizon() + hold_advance_;
    for (int attempt = 0; attempt < 1000; ++attempt) {
      time = is_rest ? fit(q, time, duration, outlook.gates) : ready_time(q, time, eligible, duration, outlook);
      if (time == never) return never;
      const HoldState hold = hold_at(time, outlook.gates);
      if (!hold.asked) return time;
      if (hold.until == never || (!outlook.credit && hold.until > horizon))
        return never;  // holds that join for a whole cycle join for ever
      time = hold.until;
    }
    return never;
  };
  Ps due = never;
  for (TrafficClass q = 0; q < traffic_class_count; ++q) {
    if (queues_[q].empty()) continue;
    const Item& head = queues_[q].front();
    if (!is_preemptable(q))
      due = std::min(due, ready_time(q, from, head.eligible, duration_of(head.length)));
    else if (!rest_)
      due = std::min(due, beyond_hold(q, head.eligible, duration_of(head.length), false));
  }
  if (rest_) due = std::min(due, beyond_hold(rest_->q, long_ago, duration_of(rest_->remaining), true));
  return due;
}

/// The data of the fragment under way if it is cut as early as possible, the decision being taken at `time`; nothing if
/// the frame has to go on to its end.
std::optional<std::uint32_t> PortChecker::cut_after(Ps time) const {
  const Ps begun =
      (time - under_way_->start + octet_ - 1) / octet_ - 8;  // octets of the frame that are out or under way
  const Ps least = 64 * (1 + Ps{config_.preemption->add_frag_size.value()}) - 4;
  const Ps data = std::max(begun, least);
  if (Ps{under_way_->remaining} - data < 64) return std::nullopt;
  return static_cast<std::uint32_t>(data);
}

/// When the frame under way is due to be cut.
Ps PortChecker::cut_due() const {
  if (!under_way_) return never;
  Ps due = never;
  const auto consider = [&](Ps time) {
    if (time < last_bit_ && cut_after(time)) due = std::min(due, time);
  };
  if (const HoldState hold = hold_at(now_, gates_); hold.asked || hold.until != never)
    consider(hold.asked ? now_ : hold.until);
  for (TrafficClass q = 0; q < traffic_class_count; ++q) {
    if (is_preemptable(q) || queues_[q].empty()) continue;
    const Item& head = queues_[q].front();
    // Its gate must be open when the cut is decided and until the frame has left, which is before this.
    consider(ready_time(q, now_, head.eligible, free_at_ - now_ + duration_of(head.length)));
  }
  return due;
}

}  // namespace takt::wire_checker
