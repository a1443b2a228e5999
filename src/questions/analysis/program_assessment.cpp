// SPDX-License-Identifier: Apache-2.0
#include "analysis/program_assessment.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "wire/program_node.hpp"

namespace takt::analysis {
namespace {

using sim::Duration;

/// What a participant that publishes on change may publish in a cycle besides the cyclic word: its intent and three
/// states of a start. One call or fault in a row brings no more.
constexpr std::size_t most_events_in_a_cycle = 1;

struct Event {
  sim::TrueTime at;
  bool is_call = false;
};

bool participates(const scenario::ResolvedProgram& program, models::NodeIndex node) {
  return std::ranges::any_of(program.members, [&](const scenario::ResolvedMember& each) { return each.node == node; });
}

/// A call or fault of one group of a tree moves the others.
std::size_t root_of(const scenario::Resolved& r, std::size_t program) {
  while (r.programs[program].outer) program = r.programs[program].outer->program;
  return program;
}

std::vector<Event> events_of(const scenario::Resolved& r, std::size_t program) {
  std::vector<Event> events;
  const auto is_near = [&](std::size_t other) { return root_of(r, other) == root_of(r, program); };
  for (const scenario::ResolvedAction& action : r.script) {
    if (action.at.since_start() >= r.scenario.duration) continue;
    if (const auto* const call = std::get_if<scenario::ResolvedCall>(&action.what);
        call != nullptr && is_near(call->program))
      events.push_back({action.at, true});
    if (const auto* const change = std::get_if<scenario::ResolvedMembership>(&action.what);
        change != nullptr && is_near(change->program))
      events.push_back({action.at, false});
    if (const auto* const node = std::get_if<scenario::ResolvedNode>(&action.what)) {
      bool is_here = false;
      for (std::size_t p = 0; p < r.programs.size(); ++p)
        is_here = is_here || (is_near(p) && participates(r.programs[p], node->node));
      if (is_here) events.push_back({action.at, false});
    }
  }
  std::stable_sort(events.begin(), events.end(), [](const Event& a, const Event& b) { return a.at < b.at; });
  return events;
}

/// From any call or fault to the last transition that it brings about.
std::optional<Duration> time_to_rest(const scenario::Resolved& r, const Bounds& bounds, std::size_t program) {
  Duration longest;
  const std::size_t root = root_of(r, program);
  for (const ReactionBound& reaction : bounds.reactions) {
    if (root_of(r, reaction.program) != root) continue;
    const bool is_unnoticed = reaction.cause != handshake::Cause::command &&
                              r.programs[reaction.program].description->variant == scenario::Variant::paper;
    if (is_unnoticed) continue;  // a fault brings nothing about
    if (!reaction.bound || !bounds.ledger.refutation(reaction.assumptions).empty()) return std::nullopt;
    longest = std::max(longest, *reaction.bound);
  }
  return longest;
}

EventsInARow most_in_a_row(const std::vector<Event>& events, std::optional<Duration> rest) {
  EventsInARow most;
  EventsInARow now;
  for (std::size_t i = 0; i < events.size(); ++i) {
    if (i > 0 && rest && events[i].at - events[i - 1].at > *rest) now = {};
    ++(events[i].is_call ? now.calls : now.faults);
    most.calls = std::max(most.calls, now.calls);
    most.faults = std::max(most.faults, now.faults);
  }
  return most;
}

}  // namespace

EventsInARow events_in_a_row(const scenario::Resolved& resolved, const Bounds& bounds, std::size_t program) {
  return most_in_a_row(events_of(resolved, program), time_to_rest(resolved, bounds, program));
}

bool is_lost_with_its_ends(const scenario::Resolved& resolved, std::size_t program, const StreamBound& stream) {
  const auto is_in_tree = [&](models::NodeIndex node) {
    for (std::size_t p = 0; p < resolved.programs.size(); ++p)
      if (root_of(resolved, p) == root_of(resolved, program) && participates(resolved.programs[p], node)) return true;
    return false;
  };
  return stream.loses_by_faults_only && resolved.plan.impairments.empty() &&
         std::ranges::all_of(resolved.script, [&](const scenario::ResolvedAction& action) {
           const auto* const node = std::get_if<scenario::ResolvedNode>(&action.what);
           const bool is_participant = node != nullptr && is_in_tree(node->node);
           const bool forwards =
               is_participant &&
               std::ranges::any_of(resolved.streams[stream.index.value].paths, [&](const scenario::Path& path) {
                 return path.front() != node->node.value && path.back() != node->node.value &&
                        std::ranges::find(path, node->node.value) != path.end();
               });
           return (is_participant && !forwards) ||
                  (node == nullptr && !std::holds_alternative<scenario::ResolvedLink>(action.what));
         });
}

std::optional<std::int64_t> most_changes_of_roles(const scenario::Resolved& resolved, std::size_t program) {
  // Adopting a halt; three states of a start, and its run; a life that ends and one that begins, their announcement.
  constexpr std::size_t of_one_event = 8;
  constexpr std::size_t useful = 200;
  const scenario::ResolvedProgram& group = resolved.programs[program];
  const std::size_t events = events_of(resolved, program).size() + group.candidates().size();
  const std::size_t most = events * (of_one_event + group.description->roles.size());
  return most <= useful ? std::optional(static_cast<std::int64_t>(most)) : std::nullopt;
}

namespace {

/// Why a member may be taken for silent though it lives, or for gone; empty if none may.
std::string silence_of(const scenario::Resolved& resolved, const Bounds& bounds,
                       const scenario::ResolvedProgram& program) {
  for (const scenario::ResolvedMember& each : program.members) {
    const auto says = [&](models::StreamIndex stream, Duration cycle, Duration timeout) {
      const StreamBound& bound = bounds.streams[stream.value];
      if (!bound.reaches_all &&
          !is_lost_with_its_ends(resolved, static_cast<std::size_t>(&program - resolved.programs.data()), bound))
        return bound.name + " may be lost: " + bound.loss_reason;
      const models::OsLatency& os = resolved.plan.os_latencies[resolved.plan.nodes[each.node.value].os_latency];
      // Clocks are never so bad that a time-out is a tenth shorter, or a cycle a tenth longer.
      const bool is_in_time = bound.latency && cycle.ps() + cycle.ps() / 10 + (*bound.latency - bound.least).ps() +
                                                       os.wake_up.greatest().ps() <
                                                   timeout.ps() - timeout.ps() / 10;
      return is_in_time ? std::string() : bound.name + " may come later than its time-out";
    };
    std::string why = says(each.state, program.description->cycle, program.receive_timeout);
    if (why.empty() && each.roles)
      why = says(*each.roles, program.announce_every, wire::announce_timeout(program.announce_every));
    if (!why.empty()) return why;
  }
  return {};
}

}  // namespace

void assess_programs(const scenario::Resolved& resolved, Bounds& bounds) {
  bounds.ledger.leave_open(Assumption::sampled_states, "it depends on how calls meet");
  bounds.ledger.discharge(Assumption::program_publishes,
                          "calls and faults are further apart than the group takes to come to rest; with roles all "
                          "that can change in the run is in the bounds");
  for (std::size_t p = 0; p < resolved.programs.size(); ++p) {
    const scenario::ResolvedProgram& program = resolved.programs[p];
    for (const scenario::ResolvedMember& each : program.participants())
      if (const StreamBound& state = bounds.streams[each.state.value]; !state.reaches_all)
        bounds.ledger.leave_open(Assumption::no_loss, state.name + ": " + state.loss_reason);
    if (program.has_roles()) {
      const std::string silence = silence_of(resolved, bounds, program);
      if (!most_changes_of_roles(resolved, p))
        bounds.ledger.leave_open(Assumption::program_publishes,
                                 "who has a role in " + program.name + " changes too often to be counted");
      else if (!silence.empty())
        bounds.ledger.leave_open(Assumption::program_publishes,
                                 "who has a role in " + program.name + " may change at any time: " + silence);
      continue;
    }
    if (program.description->publish != scenario::Publish::on_change) continue;
    const bool may_lose = std::ranges::any_of(program.participants(), [&](const scenario::ResolvedMember& each) {
      return !bounds.streams[each.state.value].reaches_all;
    });
    if (may_lose)
      bounds.ledger.leave_open(Assumption::program_publishes,
                               "lost messages may halt " + program.name + " at any time");
    std::optional<Duration> rest = time_to_rest(resolved, bounds, p);
    if (rest) *rest += program.description->cycle;
    const EventsInARow row = most_in_a_row(events_of(resolved, p), rest);
    if (!rest)
      bounds.ledger.leave_open(Assumption::program_publishes, "reactions of " + program.name + " have no bound");
    else if (row.calls + row.faults > most_events_in_a_cycle)
      bounds.ledger.leave_open(Assumption::program_publishes, std::to_string(row.calls + row.faults) +
                                                                  " calls and faults of " + program.name +
                                                                  " come before it is at rest");
  }
}

}  // namespace takt::analysis
