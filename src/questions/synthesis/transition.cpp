// SPDX-License-Identifier: Apache-2.0
#include "synthesis/transition.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

#include "json/node.hpp"
#include "scenario/gates/crossings.hpp"
#include "scenario/gates/layout.hpp"
#include "scenario/gates/list_limits.hpp"
#include "sim/check.hpp"

namespace takt::synthesis {
namespace {

using scenario::GateConflict;
using scenario::GateList;
using scenario::GateProblem;
using scenario::ScheduledStream;
using scenario::StreamWindow;

std::optional<Duration> common_multiple(Duration a, Duration b) {
  if (a == Duration()) return b;
  const sim::int128 common = static_cast<sim::int128>(a.ps()) / std::gcd(a.ps(), b.ps()) * b.ps();
  if (common > scenario::longest_gate_cycle.ps()) return std::nullopt;
  return Duration::from_ps(static_cast<std::int64_t>(common));
}

Duration next_multiple(Duration from, Duration of) { return of * ((from + of - Duration::from_ps(1)) / of); }

/// The states of a list at an instant of its cycle, and until when they last.
class Cursor {
 public:
  explicit Cursor(const GateList& list) : list_(list), left_(list.entries.front().interval) {}
  models::GateStates open() const { return list_.entries[entry_].open; }
  Duration left() const { return left_; }
  void advance(Duration by) {
    left_ -= by;
    if (left_ > Duration()) return;
    entry_ = (entry_ + 1) % list_.entries.size();
    left_ = list_.entries[entry_].interval;
  }

 private:
  const GateList& list_;
  std::size_t entry_ = 0;
  Duration left_;
};

/// A scheduled class is open where either list opens it, the others where both do.
std::optional<GateList> both(const GateList& a, const GateList& b, models::GateStates scheduled) {
  const auto cycle = common_multiple(a.cycle, b.cycle);
  if (!cycle) return std::nullopt;
  GateList made{*cycle, {}};
  Cursor at_a(a), at_b(b);
  for (Duration at; at < *cycle;) {
    const Duration step = std::min(at_a.left(), at_b.left());
    const auto open = static_cast<models::GateStates>(((at_a.open() | at_b.open()) & scheduled) |
                                                      (at_a.open() & at_b.open() & ~scheduled));
    if (!made.entries.empty() && made.entries.back().open == open)
      made.entries.back().interval += step;
    else
      made.entries.push_back({open, step});
    if (made.entries.size() > scenario::most_gate_entries) return std::nullopt;
    at_a.advance(step);
    at_b.advance(step);
    at += step;
  }
  return made;
}

class Planner {
 public:
  explicit Planner(const TransitionProblem& problem)
      : p_(problem),
        changes_(problem.changes),
        windows_(scenario::Crossings(problem.flows, scenario::Waiting::at_gates).windows()),
        latencies_(latencies_of_windows(problem.flows)),
        lists_(problem.lists),
        clock_(problem.begin),
        runs_(problem.flows.streams.size(), true),
        touched_(problem.flows.ports.size(), false) {
    TAKT_CHECK(p_.lists.size() == p_.flows.ports.size(), "a list for each port");
    for (const FlowChange& change : changes_) {
      if (change.comes) runs_[*change.comes] = false;
      for (const auto& flow : {change.leaves, change.comes})
        if (flow)
          for (const scenario::ScheduledHop& hop : p_.flows.streams[*flow].hops) touched_[hop.port] = true;
    }
  }

  Transition plan() {
    std::vector<std::size_t> open(changes_.size());
    std::iota(open.begin(), open.end(), std::size_t{0});
    while (!open.empty()) {
      const std::vector<std::size_t> round = choose(open);
      if (round.empty()) {
        if (pause(open)) continue;
        return {{}, p_.lists, {}, open, why_};
      }
      take(round);
      std::erase_if(open, [&](std::size_t c) { return std::find(round.begin(), round.end(), c) != round.end(); });
    }
    made_.lists = lists_;
    made_.end = clock_;
    return std::move(made_);
  }

 private:
  /// What can change over in one round: all; or what only goes; or one after the other as long as they fit together.
  std::vector<std::size_t> choose(const std::vector<std::size_t>& open) {
    if (lists_with(open)) return open;
    std::vector<std::size_t> going;
    std::copy_if(open.begin(), open.end(), std::back_inserter(going),
                 [&](std::size_t c) { return !changes_[c].comes; });
    if (!going.empty() && lists_with(going)) return going;
    going.clear();
    std::string first;
    for (const std::size_t c : open) {
      going.push_back(c);
      if (lists_with(going)) continue;
      going.pop_back();
      if (first.empty()) first = why_;
    }
    if (going.empty()) why_ = first;
    return going;
  }

  /// Streams whose frames are lost in any case make room first, and come later.
  bool pause(const std::vector<std::size_t>& open) {
    std::vector<std::size_t> pausing;
    for (const std::size_t c : open)
      if (changes_[c].may_pause && changes_[c].leaves) pausing.push_back(c);
    if (pausing.empty() || !are_empty_windows_safe(runs_, pausing)) return false;
    std::vector<std::optional<FlowIndex>> later;
    for (const std::size_t c : pausing) later.push_back(std::exchange(changes_[c].comes, std::nullopt));
    take(pausing);
    for (std::size_t i = 0; i < pausing.size(); ++i) changes_[pausing[i]] = {std::nullopt, later[i], false};
    return true;
  }

  void take(const std::vector<std::size_t>& round) {
    write(*lists_with(round), clock_);
    const Duration ready = clock_;
    TransitionStep step;
    for (const std::size_t c : round) {
      step.talkers.push_back(change_over(c, ready));
      const TalkerSwitch& made = step.talkers.back();
      if (made.first) clock_ = std::max(clock_, *made.first);
      if (made.last) clock_ = std::max(clock_, *made.last + longest_stay(*changes_[c].leaves));
      if (changes_[c].leaves) runs_[*changes_[c].leaves] = false;
      if (changes_[c].comes) runs_[*changes_[c].comes] = true;
    }
    made_.steps.push_back(std::move(step));
    // A device may take no list of what is left for now (a shorter cycle can be beyond its granularity): windows that
    // nobody needs do no harm.
    if (const auto lists = lists_with({})) write(*lists, clock_);
  }

  /// Nothing changes at a port whose list stays.
  void write(const std::vector<GateList>& lists, Duration at) {
    TransitionStep step;
    for (std::uint32_t port = 0; port < lists.size(); ++port) {
      if (!touched_[port] || lists[port] == lists_[port]) continue;
      const Duration cycle = lists[port].cycle;
      const Duration multiple = common_multiple(lists_[port].cycle, cycle).value_or(cycle);
      step.lists.push_back({port, lists[port], at, next_multiple(at + p_.lead, multiple)});
      clock_ = std::max(clock_, step.lists.back().holds_from);
      lists_[port] = lists[port];
    }
    if (!step.lists.empty()) made_.steps.push_back(std::move(step));
  }

  TalkerSwitch change_over(std::size_t number, Duration ready) const {
    const FlowChange& change = changes_[number];
    TalkerSwitch made{number, {}, {}};
    // What comes finds its window open, and nobody in it who began before the list held.
    Duration from = ready + p_.flows.margin;
    for (const scenario::GatedPort& port : p_.flows.ports) from = std::max(from, ready + p_.flows.margin + port.guard);
    const auto release_from = [](const ScheduledStream& flow, Duration at) {
      return flow.release + flow.period * models::ceil_quotient(at - flow.release, flow.period);
    };
    if (!change.comes) {
      const ScheduledStream& old = p_.flows.streams[*change.leaves];
      made.last = release_from(old, ready) - old.period;
      return made;
    }
    const ScheduledStream& fresh = p_.flows.streams[*change.comes];
    made.first = release_from(fresh, from + fresh.early);
    if (!change.leaves) return made;
    // As near to a period as the phases are, and so that the last frame is everywhere before the first one of the new
    // times.
    const ScheduledStream& old = p_.flows.streams[*change.leaves];
    Duration least = old.period / 2 + Duration::from_ps(1);
    least = std::max(
        least, latencies_[*change.leaves] - latencies_[*change.comes] + p_.flows.margin * 2 + Duration::from_ps(1));
    const auto& old_windows = windows_[*change.leaves];
    const auto& new_windows = windows_[*change.comes];
    for (std::size_t i = 0; i < old.hops.size(); ++i)
      for (std::size_t j = 0; j < fresh.hops.size(); ++j)
        if (old.hops[i].port == fresh.hops[j].port)
          least = std::max(least, old_windows[i].close - old.release + p_.flows.ports[old.hops[i].port].gap -
                                      (new_windows[j].open - fresh.release) + p_.flows.margin +
                                      (fresh.hops[j].previous ? Duration() : fresh.early));
    made.last = release_from(old, *made.first - least) - old.period;
    if (*made.first - (*made.last + old.period) >= least) made.last = *made.last + old.period;
    return made;
  }

  /// From the release until the frame is surely out, whatever the clocks say.
  Duration longest_stay(FlowIndex flow) const { return latencies_[flow] + p_.flows.margin * 2; }

  /// Of a window that is empty for a while, since its stream has not come or has gone, a frame that is early at the
  /// same talker could make use, and be at the next port before its time.
  bool are_empty_windows_safe(const std::vector<bool>& in, const std::vector<std::size_t>& changing) {
    for (const std::size_t c : changing)
      for (const auto& empty : {changes_[c].leaves, changes_[c].comes})
        for (FlowIndex f = 0; empty && f < in.size(); ++f) {
          if (!in[f] || f == *empty || !would_take(f, *empty)) continue;
          why_ = "frames of " + json::quote(p_.flows.streams[f].name) + " that are early could take the windows of " +
                 json::quote(p_.flows.streams[*empty].name) + " while these are empty";
          return false;
        }
    return true;
  }

  /// Whether a frame of `flow` can be at its talker early enough to fit into a window of the other there.
  bool would_take(FlowIndex flow, FlowIndex window_of) const {
    const ScheduledStream &early = p_.flows.streams[flow], &other = p_.flows.streams[window_of];
    const scenario::ScheduledHop &hop = early.hops.front(), &there = other.hops.front();
    if (early.early == Duration() || hop.port != there.port || hop.traffic_class != there.traffic_class) return false;
    const StreamWindow &own = windows_[flow].front(), &empty = windows_[window_of].front();
    const std::int64_t common = std::gcd(early.period.ps(), other.period.ps());
    const std::int64_t apart = scenario::modulo((own.open - empty.open).ps(), common);
    if (apart == 0) return false;  // it is its own, of another way
    // Two that overlap, as a stream's old and new one may, are one long window.
    if (apart < (empty.close - empty.open).ps() || common - apart < (own.close - own.open).ps()) return true;
    const Duration room = empty.close - empty.open - hop.transmission;
    if (room < Duration()) return false;
    // The latest start in that window that is not before the frame can be there.
    const Duration latest = Duration::from_ps(
        scenario::modulo((empty.close - hop.transmission - early.release + early.early).ps(), common));
    return latest - room < early.early;
  }

  /// Lists with the windows of all that runs and of what these bring; nothing, and why_, if there are none.
  std::optional<std::vector<GateList>> lists_with(const std::vector<std::size_t>& coming) {
    std::vector<bool> in = runs_, without_new = runs_, without_old = runs_;
    std::vector<std::pair<FlowIndex, FlowIndex>> twins;
    for (const std::size_t c : coming) {
      const FlowChange& change = changes_[c];
      if (!change.comes) continue;
      in[*change.comes] = true;
      if (change.leaves) {
        twins.push_back({*change.leaves, *change.comes});
        without_old[*change.leaves] = false;
      } else {
        without_new[*change.comes] = true;
      }
      without_old[*change.comes] = true;
    }
    if (!are_empty_windows_safe(in, coming)) return std::nullopt;
    std::vector<bool> has_twins(p_.flows.ports.size(), false);
    auto lists = lay_out(in, twins, has_twins);
    if (!lists || std::find(has_twins.begin(), has_twins.end(), true) == has_twins.end()) return lists;
    // A stream is never at both of its times: where these meet, the windows of both lists do.
    std::vector<bool> none(p_.flows.ports.size(), false);
    const auto old_lists = lay_out(without_new, {}, none);
    const auto new_lists = lay_out(without_old, {}, none);
    if (!old_lists || !new_lists) return std::nullopt;
    for (std::uint32_t port = 0; port < lists->size(); ++port) {
      if (!has_twins[port]) continue;
      models::GateStates scheduled = 0;
      bool has_waiting = false;
      std::map<std::uint32_t, models::GateStates> of_train;
      for (FlowIndex f = 0; f < in.size(); ++f)
        for (const scenario::ScheduledHop& hop : p_.flows.streams[f].hops) {
          if (!in[f] || hop.port != port) continue;
          const ScheduledStream& flow = p_.flows.streams[f];
          const auto own = static_cast<models::GateStates>(1u << hop.traffic_class);
          scheduled = static_cast<models::GateStates>(scheduled | own);
          models::GateStates& others = of_train[flow.train];
          has_waiting =
              has_waiting || (others & ~own) != 0 ||
              (!hop.previous && (flow.early > Duration() || flow.release != scenario::floor_ns(flow.release)));
          others = static_cast<models::GateStates>(others | own);
        }
      auto made = both((*old_lists)[port], (*new_lists)[port], scheduled);
      const scenario::ListLimits& limits = p_.flows.ports[port].limits;
      if (made && !scenario::keeps_to(*made, limits)) {
        scenario::FittedList fitted = scenario::fit_list(*made, scheduled, has_waiting, limits);
        if (fitted.obstacle == scenario::ListObstacle::none)
          made = std::move(fitted.list);
        else
          made.reset();
      }
      if (!made) {
        why_ = json::quote(p_.flows.ports[port].name) + " takes no list with old and new windows";
        return std::nullopt;
      }
      (*lists)[port] = std::move(*made);
    }
    return lists;
  }

  /// Of the ports that some change touches; the others keep their lists. Where only twins meet the list is missing and
  /// `meets` is set.
  std::optional<std::vector<GateList>> lay_out(const std::vector<bool>& in,
                                               const std::vector<std::pair<FlowIndex, FlowIndex>>& twins,
                                               std::vector<bool>& meets) {
    GateProblem problem{p_.flows.margin, p_.flows.ports, {}};
    std::vector<FlowIndex> flow_of;
    for (FlowIndex f = 0; f < in.size(); ++f) {
      const auto& hops = p_.flows.streams[f].hops;
      if (!in[f] ||
          std::none_of(hops.begin(), hops.end(), [&](const scenario::ScheduledHop& hop) { return touched_[hop.port]; }))
        continue;
      problem.streams.push_back(p_.flows.streams[f]);
      flow_of.push_back(f);
    }
    scenario::GateLayout layout = scenario::lay_out_gates(problem);
    for (const GateConflict& conflict : layout.conflicts) {
      if (!touched_[conflict.port]) continue;  // not all of its streams are there
      const FlowIndex first = flow_of[conflict.first], second = flow_of[conflict.second];
      const bool are_twins = std::any_of(twins.begin(), twins.end(), [&](const auto& pair) {
        return pair == std::pair(first, second) || pair == std::pair(second, first);
      });
      // Frames that may be early wait for one and the same window, whichever way they take behind it.
      const bool is_same_time =
          conflict.kind == GateConflict::Kind::order &&
          (p_.flows.streams[first].release - p_.flows.streams[second].release) % p_.flows.streams[first].period ==
              Duration();
      if (are_twins && (conflict.kind == GateConflict::Kind::overlap || is_same_time)) {
        meets[conflict.port] = true;
        continue;
      }
      const std::string at = json::quote(p_.flows.ports[conflict.port].name);
      why_ = conflict.kind == GateConflict::Kind::overlap || conflict.kind == GateConflict::Kind::order
                 ? json::quote(p_.flows.streams[first].name) + " and " + json::quote(p_.flows.streams[second].name) +
                       " meet at " + at
                 : at + " takes no list with all windows that are needed at a time";
      return std::nullopt;
    }
    std::vector<GateList> lists = lists_;
    for (std::uint32_t port = 0; port < lists.size(); ++port) {
      if (!touched_[port] || meets[port]) continue;
      lists[port] = std::move(layout.schedule.lists[port]);
      // Nobody has windows there: all gates are open, which a port with a list must be told.
      if (lists[port].entries.empty() && !lists_[port].entries.empty())
        lists[port] = {lists_[port].cycle, {{models::all_gates_open, lists_[port].cycle}}};
    }
    return lists;
  }

  const TransitionProblem& p_;
  std::vector<FlowChange> changes_;
  const std::vector<std::vector<StreamWindow>> windows_;  // by flow and hop
  const std::vector<Duration> latencies_;                 // by flow
  std::vector<GateList> lists_;                           // by port: what was written last
  Duration clock_;                                        // what happens next is not before
  std::vector<bool> runs_;                                // flows that have windows
  std::vector<bool> touched_;                             // ports that lose or get windows at some time
  std::string why_;
  Transition made_;
};

}  // namespace

Transition plan_transition(const TransitionProblem& problem) { return Planner(problem).plan(); }

std::vector<Duration> latencies_of_windows(const GateProblem& flows) {
  const auto windows = scenario::Crossings(flows, scenario::Waiting::at_gates).windows();
  std::vector<Duration> latencies(flows.streams.size());
  for (FlowIndex f = 0; f < flows.streams.size(); ++f) {
    const ScheduledStream& stream = flows.streams[f];
    for (std::size_t h = 0; h < stream.hops.size(); ++h)
      latencies[f] = std::max(
          latencies[f], windows[f][h].start + stream.hops[h].transmission + stream.hops[h].behind - stream.release);
  }
  return latencies;
}

}  // namespace takt::synthesis
