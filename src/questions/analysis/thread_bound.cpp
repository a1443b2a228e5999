// SPDX-License-Identifier: Apache-2.0
#include "analysis/thread_bound.hpp"

#include <algorithm>

#include "analysis/flow_graph.hpp"
#include "analysis/thread_arrivals.hpp"
#include "json/quantity.hpp"

namespace takt::analysis {
namespace {

using json::to_text;
using sim::Duration;

constexpr std::int64_t inbox_messages = 256;  // of a subscription over OPC UA (scenario/applications/opc_ua_port.cpp)

/// A length of true time as a clock shows it, at most.
Ps on_clock(Ps length, const ClockQuality& clock) {
  return clock.rate_ppt == 0 && clock.error == 0
             ? length
             : sum(scaled_up(length, one_ppt + clock.rate_ppt, one_ppt), 2 * clock.error, 1);
}

/// Why nothing is certain of when the calls of a host take place; empty: all is.
std::string doubt_of_host(const scenario::Resolved& r, models::NodeIndex node) {
  if (!r.scenario.faults.empty()) return "faults may stop the thread or move its clock";
  if (node.value < r.plan.gptp.size() && r.plan.gptp[node.value])
    return "a clock that is set may skip calls of the thread, and synchronisation is simulated";
  return {};
}

/// No window is longer than the run leaves room for two of, from the last instant on at which the first may begin.
bool has_whole_window(const scenario::Resolved& r, const scenario::ResolvedApplication& application,
                      const scenario::ResolvedThread& thread, const ClockQuality& clock, Duration from) {
  // A clock that is behind at the start shows them later.
  const std::optional<models::NodeClockPlan>& own = r.plan.nodes[application.node.value].clock;
  const Ps begins = std::max<Ps>(0, std::max({application.scheduler->after.ps(), from.ps(), thread.offset.ps()}) -
                                        (own ? own->initial_offset.ps() : 0));
  return scaled_down(r.scenario.duration.ps(), one_ppt - clock.rate_ppt, one_ppt) >
         sum(begins, thread.window.ps(), thread.window.ps());
}

/// What publishes, and what is known of its way.
struct Input {
  const scenario::ResolvedThread* thread = nullptr;
  const StreamBound* stream = nullptr;
  ClockQuality clock;
  Ps threads = 0;  ///< how differently long processors take to publish it and to take it in
};

/// Messages of a publication that come in an interval: one in a period of its clock, late by its response and its way.
std::int64_t most_arrivals(const Input& input, Ps interval) {
  const Ps period = std::max<Ps>(1, scaled_down(input.thread->every.ps(), one_ppt, one_ppt + input.clock.fastest_ppt));
  const Ps latest = input.thread->every.ps() - 1;
  const Ps late = longest(
      std::min(latest, input.thread->response.greatest().ps()) - std::min(latest, input.thread->response.least().ps()),
      input.clock);
  return ArrivalPattern{
      period, 1, 0,
      sum(late, 2 * input.clock.error, input.threads, input.stream->latency->ps() - input.stream->least.ps()) + 1}
      .count(interval);
}

void bound_values(const scenario::Resolved& r, const Bounds& bounds, const scenario::ResolvedApplication& application,
                  const scenario::ResolvedThread& thread, const ClockQuality& clock, ThreadBound& made) {
  const auto doubt = [&](std::string why) {
    if (made.values_reason.empty()) made.values_reason = std::move(why);
  };
  if (r.topics[thread.topic].shape.is_dds)
    return doubt("takt has no bound for what participants of DDS send, and when");
  if (!made.is_always_done) return doubt(made.reason);
  if (!r.plan.impairments.empty()) return doubt("chance takes or doubles frames");
  // From one call to the next, or from the beginning to the first.
  const Ps interval = longest(thread.every.ps() + made.greatest_response.ps(), clock);
  std::int64_t found = 0;
  made.loses_nothing = true;
  for (const scenario::ResolvedInput& each : thread.inputs) {
    const scenario::ResolvedApplication& publisher = r.applications[each.application];
    const ThreadTime& taken_in = bounds.hosts->of(application.node, application.cpu_thread);
    const Input input{
        &publisher.threads[each.thread], &bounds.streams[each.stream.value], clock_quality(r, publisher.node, {}),
        sum(bounds.hosts->of(publisher.node, publisher.threads[each.thread].cpu_thread).spread(), taken_in.spread())};
    if (!is_bounded(taken_in.worst)) {
      made.loses_nothing = false;
      return doubt("the thread that takes in what comes: " + taken_in.reason);
    }
    made.assumptions.add(input.stream->assumptions);
    if (!input.stream->latency || !input.stream->reaches_all) {
      made.loses_nothing = false;
      doubt(input.stream->name + ": " + (input.stream->latency ? input.stream->loss_reason : input.stream->reason));
    }
    if (!input.stream->latency) return;
    found += most_arrivals(input, interval);
  }
  if (found > inbox_messages) {
    made.loses_nothing = false;
    return doubt("up to " + std::to_string(found) + " messages may come between two calls, and " +
                 std::to_string(inbox_messages) + " wait");
  }
  made.most_found = static_cast<std::uint64_t>(found);
}

}  // namespace

ThreadBound thread_bound(const scenario::Resolved& r, const Bounds& bounds, std::size_t a, std::size_t t,
                         Duration from) {
  const scenario::ResolvedApplication& application = r.applications[a];
  const scenario::ResolvedThread& thread = application.threads[t];
  const ClockQuality clock = clock_quality(r, application.node, {});
  ThreadBound made;
  made.assumptions.add(Assumption::nothing_else);
  made.assumptions.add(Assumption::os_latency);
  if (clock.rate_ppt != 0) made.assumptions.add(Assumption::clock_rate);
  const Duration latest = thread.every - Duration::from_ps(1);
  const ThreadTime& cpu = bounds.hosts->of(application.node, thread.cpu_thread);
  if (thread.cpu_thread) made.assumptions.add(Assumption::execution_times);
  const Ps response = sum(thread.response.greatest().ps(), on_clock(cpu.worst, clock));
  made.least_response = std::min(
      latest, thread.response.least() + Duration::from_ps(scaled_down(cpu.least, one_ppt - clock.rate_ppt, one_ppt)));
  made.greatest_response = Duration::from_ps(std::min(latest.ps(), response));
  made.reason = doubt_of_host(r, application.node);
  if (made.reason.empty() && !is_bounded(cpu.worst)) made.reason = "its thread of the processor: " + cpu.reason;
  if (made.reason.empty() && response >= thread.every.ps())
    made.reason = "a response may last longer than the " + to_text(thread.every) +
                  " of a period, and then a call does not take place";
  made.is_always_done = made.reason.empty();
  if (made.is_always_done && !has_whole_window(r, application, thread, clock, from)) {
    made.is_always_done = false;
    made.reason = "the run may end before a window of " + to_text(thread.window) + " is over";
  }
  made.is_tested = made.is_always_done;
  if (made.is_tested &&
      (application.scheduler_response.greatest().ps() > application.scheduler->tolerance.ps() || thread.tests == 0)) {
    made.is_tested = false;
    made.reason = "the scheduler may look so late that no window is a test";
  }
  if (!thread.publishes) bound_values(r, bounds, application, thread, clock, made);
  return made;
}

}  // namespace takt::analysis
