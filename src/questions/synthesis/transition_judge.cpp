// SPDX-License-Identifier: Apache-2.0
#include "synthesis/transition_judge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "evaluation/evaluate.hpp"
#include "json/node.hpp"
#include "json/quantity.hpp"
#include "models/egress/port_shaping.hpp"
#include "models/ethernet/traffic.hpp"
#include "scenario/resolve.hpp"
#include "scenario/run/run.hpp"

namespace takt::synthesis {
namespace {

/// When frames came to applications, by stream.
class Arrivals final : public sim::TraceSink {
 public:
  void record(const sim::TraceRecord& record) override {
    if (record.kind == static_cast<std::uint32_t>(models::Occurrence::received))
      of_stream[static_cast<std::uint32_t>(record.detail >> 32)].push_back(record.time);
  }
  std::map<std::uint32_t, std::vector<sim::TrueTime>> of_stream;
};

class Judge {
 public:
  explicit Judge(const TransitionScenario& transition) : t_(transition) {}

  TransitionVerdict run() {
    json::Diagnostics diagnostics;
    const auto resolved = scenario::resolve(t_.scenario, diagnostics);
    if (!resolved || diagnostics.has_errors()) {
      for (const json::Diagnostic& each : diagnostics.kept())
        if (each.severity == json::Severity::error) wrong("the transition is no scenario: " + json::to_text(each));
      return std::move(verdict_);
    }
    scenario::Run run(*resolved);
    Arrivals arrivals;
    run.simulation().set_trace(&arrivals);
    run.advance();
    const results::RunResult result = evaluation::evaluate(run, false);
    has_clocks_ = std::any_of(resolved->plan.nodes.begin(), resolved->plan.nodes.end(),
                              [](const models::NodePlan& node) { return node.clock.has_value(); });
    for (const ExpectedStream& each : t_.streams) {
      const auto found = std::ranges::find(result.streams, each.name, &results::StreamResult::name);
      if (found == result.streams.end())
        wrong(each.name + " is not there");
      else
        judge(each, *found);
    }
    if (!has_clocks_)
      for (const ExpectedStream& each : t_.streams) {
        const auto stream = std::ranges::find(resolved->plan.streams, each.name, &models::StreamPlan::name);
        if (each.has_one_listener && !each.of_program && !each.waits_at_listener &&
            stream != resolved->plan.streams.end())
          compare(each, arrivals.of_stream[static_cast<std::uint32_t>(stream - resolved->plan.streams.begin())]);
      }
    for (const ExpectedPort& each : t_.ports) judge(each, run);
    return std::move(verdict_);
  }

 private:
  void wrong(std::string what) { verdict_.wrong.push_back(std::move(what)); }

  /// Frames that are due until the end of the run.
  std::uint64_t due(const ExpectedStream& stream) const {
    const Duration last = stream.until && *stream.until <= t_.scenario.duration ? *stream.until - Duration::from_ps(1)
                                                                                : t_.scenario.duration;
    return last < stream.offset ? 0 : static_cast<std::uint64_t>((last - stream.offset) / stream.period) + 1;
  }

  void judge(const ExpectedStream& expected, const results::StreamResult& stream) {
    CarriedStream carried{
        expected.name, stream.sent, stream.delivered, stream.lost, expected.lag + expected.latency, {}, {}};
    if (stream.latency) {
      carried.least = stream.latency->min;
      carried.greatest = stream.latency->max;
    }
    verdict_.frames += stream.sent;
    // With clocks and jitter the last frame of a run is due a little sooner or later.
    const std::uint64_t least = due(expected),
                        tolerance = (has_clocks_ || expected.early > Duration()) && !expected.until ? 1 : 0;
    if (!expected.of_program && !expected.ends_with_its_host &&
        (stream.sent + tolerance < least || stream.sent > least + tolerance))
      wrong(fmt::format("{} sends {} frames, and {} are due", expected.name, stream.sent, least));
    if (stream.lost > expected.may_lose)
      wrong(fmt::format("{} loses {} frames, and what failed takes {}", expected.name, stream.lost, expected.may_lose));
    // Of a program it is not known from when its latency counts: one that misses its window waits for the next one.
    // What the host of a listener takes is added.
    const Duration greatest =
        carried.planned + expected.greatest_receive +
        (expected.of_program || expected.waits_at_listener ? expected.period - Duration::from_ps(1) : t_.margin);
    if (carried.greatest && *carried.greatest > greatest)
      wrong(fmt::format("{} takes {}, and {} are planned", expected.name, json::to_text(*carried.greatest),
                        json::to_text(carried.planned)));
    if (carried.least && expected.has_one_listener && !expected.of_program &&
        *carried.least < carried.planned + expected.least_receive - expected.early - t_.margin)
      wrong(fmt::format("{} takes only {}, and {} are planned", expected.name, json::to_text(*carried.least),
                        json::to_text(carried.planned)));
    if (stream.oldest_in_flight && *stream.oldest_in_flight > greatest)
      wrong(fmt::format("a frame of {} stands still", expected.name));
    verdict_.streams.push_back(std::move(carried));
  }

  /// With ideal clocks it is known at which instants of its period a frame comes.
  void compare(const ExpectedStream& expected, const std::vector<sim::TrueTime>& came) {
    std::size_t others = 0;
    Duration worst;
    for (const sim::TrueTime at : came) {
      Duration off = (at.since_start() - expected.offset - expected.lag - expected.latency) % expected.period;
      if (off > expected.period / 2 + expected.greatest_receive) off -= expected.period;
      if (off < -(expected.period / 2)) off += expected.period;
      if (off <= t_.margin + expected.greatest_receive && off >= expected.least_receive - t_.margin) continue;
      if (others++ == 0) worst = off;
    }
    if (others > 0)
      wrong(fmt::format("{} frames of {} do not come when they should, the first {} {}", others, expected.name,
                        json::to_text(worst < Duration() ? -worst : worst), worst < Duration() ? "before" : "behind"));
  }

  void judge(const ExpectedPort& expected, scenario::Run& run) {
    models::PortShaping* const shaping = run.network().ports(expected.node)[expected.port].shaping();
    if (shaping == nullptr || !shaping->has_gates())
      return wrong(json::quote(expected.name) + " has no gates at the end");
    models::GateSchedule& gates = shaping->gates();
    const sim::LocalTime now = run.network().clock(expected.node).local_at(run.end());
    if (gates.config_change_error() != 0)
      wrong(fmt::format("{} is given a list too late: {} errors of ConfigChange", json::quote(expected.name),
                        gates.config_change_error()));
    if (gates.config_pending(now)) return wrong(json::quote(expected.name) + " still has a list pending at the end");
    const models::GateControlList* const list = gates.oper_control_list(now);
    if (list == nullptr || gates.oper_base_time(now) != sim::LocalTime() + expected.base_time)
      return wrong(json::quote(expected.name) + " ends with a list of another base time");
    const auto same = [](const models::GateControlEntry& is, const scenario::GateList::Entry& shall) {
      return is.gate_states == shall.open && is.interval == shall.interval;
    };
    if (list->cycle_time() != expected.list.cycle || !std::ranges::equal(list->entries(), expected.list.entries, same))
      wrong(json::quote(expected.name) + " ends with another list");
  }

  const TransitionScenario& t_;
  bool has_clocks_ = false;
  TransitionVerdict verdict_;
};

}  // namespace

TransitionVerdict judge_transition(const TransitionScenario& transition) { return Judge(transition).run(); }

}  // namespace takt::synthesis
