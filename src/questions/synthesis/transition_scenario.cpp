// SPDX-License-Identifier: Apache-2.0
#include "synthesis/transition_scenario.hpp"

#include <algorithm>
#include <set>

#include "scenario/gates/crossings.hpp"

namespace takt::synthesis {
namespace {

using scenario::GateList;
using scenario::Scenario;
using scenario::Stream;

class Maker {
 public:
  Maker(const Scenario& running, const scenario::Resolved& resolved, const PlacedChanges& placed,
        const ChangedFlows& changed, const Transition& transition, Duration at)
      : running_(running),
        resolved_(resolved),
        placed_(placed),
        changed_(changed),
        transition_(transition),
        at_(at),
        windows_(scenario::Crossings(changed.problem.flows, scenario::Waiting::at_gates).windows()),
        latencies_(latencies_of_windows(changed.problem.flows)) {}

  TransitionScenario run() {
    Scenario& made = made_.scenario;
    made = running_;
    made.name += "-transition";
    made.warm_up = {};
    made.allow_overload = true;  // of what goes and what comes, which do not send at a time
    made_.margin = changed_.problem.flows.margin;
    for (scenario::Fault fault : placed_.faults) {
      std::visit([&](auto& each) { each.at = at_; }, fault);
      made.faults.push_back(std::move(fault));
    }
    for (const TransitionStep& step : transition_.steps) {
      for (const WrittenList& list : step.lists) write(list);
      for (const TalkerSwitch& talker : step.talkers) change_over(talker);
    }
    made.duration = end();
    for (FlowIndex f = 0; f < changed_.names.size(); ++f) expect(f);
    require();
    return std::move(made_);
  }

 private:
  const scenario::GateProblem& flows() const { return changed_.problem.flows; }

  void write(const WrittenList& list) {
    const scenario::GatedPort& port = flows().ports[list.port];
    scenario::ScriptEntry entry;
    entry.at = list.written;
    scenario::SetGates& set = entry.set_gates.emplace();
    const std::size_t middle = port.name.find(" to ");
    set.node = port.name.substr(0, middle);
    set.to = port.name.substr(middle + 4);
    set.gates.base_time = list.holds_from;
    set.gates.cycle = list.list.cycle;
    for (const GateList::Entry& each : list.list.entries) {
      scenario::GateEntry gates;
      for (models::TrafficClass q = 0; q < models::traffic_class_count; ++q)
        if (models::contains(each.open, q)) gates.open.push_back(q);
      gates.interval = each.interval;
      set.gates.entries.push_back(std::move(gates));
    }
    made_.scenario.script.push_back(std::move(entry));
    const auto known = std::ranges::find(made_.ports, port.name, &ExpectedPort::name);
    ExpectedPort& expected = known == made_.ports.end() ? made_.ports.emplace_back() : *known;
    expected = {port.node, port.port, port.name, list.holds_from, list.list};
  }

  void change_over(const TalkerSwitch& talker) {
    const StreamChange& change = placed_.changes[talker.change];
    const FlowChange& flow = changed_.problem.changes[talker.change];
    if (talker.last) {
      const Duration until = *talker.last + flows().streams[*flow.leaves].period - changed_.lags[*flow.leaves];
      Stream& old = *std::ranges::find(made_.scenario.streams, change.name, &Stream::name);
      old.until = old.until ? std::min(*old.until, until) : until;
    }
    if (talker.first) {
      Stream fresh = *change.after;
      fresh.name = name_for(change.name);
      fresh.offset = json::OrAuto<Duration>(*talker.first - changed_.lags[*flow.comes]);
      name_of_[*flow.comes] = fresh.name;
      made_.scenario.streams.push_back(std::move(fresh));
    }
  }

  /// A stream that moves is two: one that ends, and one that begins.
  std::string name_for(const std::string& name) const {
    std::string made = name;
    for (int i = 0; std::ranges::find(made_.scenario.streams, made, &Stream::name) != made_.scenario.streams.end(); ++i)
      made = name + " moved" + (i == 0 ? "" : " " + std::to_string(i));
    return made;
  }

  /// So that all that is new sends for some periods.
  Duration end() const {
    Duration longest = changed_.problem.lead;
    for (FlowIndex f = 0; f < changed_.names.size(); ++f)
      longest = std::max(longest, flows().streams[f].period * 3 + latencies_[f]);
    constexpr std::int64_t ms = 1'000'000'000;
    return Duration::from_ps(((transition_.end + longest).ps() + ms - 1) / ms * ms);
  }

  const StreamChange* change_of(FlowIndex f) const {
    for (std::size_t c = 0; c < changed_.problem.changes.size(); ++c)
      if (changed_.problem.changes[c].leaves == f || changed_.problem.changes[c].comes == f) return &placed_.changes[c];
    return nullptr;
  }

  void expect(FlowIndex f) {
    const StreamChange* const change = change_of(f);
    const auto named = name_of_.find(f);
    const auto written = std::ranges::find(made_.scenario.streams,
                                           named == name_of_.end() ? changed_.names[f] : named->second, &Stream::name);
    ExpectedStream expected;
    expected.flow = f;
    expected.of_program = changed_.of_program[f];
    expected.lag = changed_.lags[f];
    expected.period = flows().streams[f].period;
    expected.latency = latencies_[f];
    expected.early = flows().streams[f].early;
    expected.name = changed_.names[f];
    if (!expected.of_program) {
      expected.name = written->name;
      expected.offset = written->offset.value_or(Duration());
      expected.until = written->until;
      expected.has_one_listener = written->to.names.size() == 1;
      expected.least_receive = Duration::max();
      for (const std::string& listener : written->to.names) {
        const models::NodePlan& node = resolved_.plan.nodes[*resolved_.topology.find(listener)];
        const models::OsLatency& os = resolved_.plan.os_latencies[node.os_latency];
        expected.least_receive = std::min(expected.least_receive, os.receive.least());
        expected.greatest_receive = std::max(expected.greatest_receive, os.receive.greatest());
        expected.waits_at_listener = expected.waits_at_listener || (node.cpu != nullptr && node.cpu->receive);
      }
    }
    if (change != nullptr && change->was_cut && named == name_of_.end()) {
      for (const scenario::Fault& fault : placed_.faults)
        if (const auto* const crash = std::get_if<scenario::Crash>(&fault))
          expected.ends_with_its_host = expected.ends_with_its_host || crash->node == written->from;
      expected.may_lose = taken(expected);
    }
    made_.streams.push_back(std::move(expected));
  }

  /// Frames that have not yet come over the last failed link when it fails, or are sent later.
  std::uint64_t taken(const ExpectedStream& expected) const {
    const scenario::ScheduledStream& flow = flows().streams[expected.flow];
    const auto& windows = windows_[expected.flow];
    Duration over;
    for (std::size_t h = 0; h < flow.hops.size(); ++h) {
      const scenario::GatedPort& port = flows().ports[flow.hops[h].port];
      for (const std::uint32_t l : placed_.failed_links) {
        const models::LinkPlan& link = resolved_.plan.links[l];
        for (const models::LinkPlan::End* end : {&link.a, &link.b})
          if (end->node == port.node && end->port == port.port)
            over = std::max(over, windows[h].close + link.delay + flows().margin - flow.release);
      }
    }
    std::uint64_t count = 0;
    for (Duration due = expected.offset; due < expected.until.value_or(made_.scenario.duration); due += expected.period)
      if (due + expected.lag + over >= at_) ++count;
    return count;
  }

  /// What the run itself shall judge: each frame has the latency that its windows give it, and all of them come. What
  /// the scenario requires stays, but for streams that lose frames in any case.
  void require() {
    std::set<std::string> losing;
    for (const ExpectedStream& each : made_.streams)
      if (each.may_lose > 0 || each.ends_with_its_host) losing.insert(each.name);
    std::set<std::string> leaving(losing);
    for (const std::string& each : placed_.without_way) leaving.insert(each);
    std::vector<scenario::Requirement>& require = made_.scenario.require;
    std::erase_if(require,
                  [&](const scenario::Requirement& each) { return each.stream && leaving.contains(*each.stream); });
    for (scenario::Requirement& each : require)
      if (!each.after && running_.warm_up > Duration()) each.after = running_.warm_up;
    for (const ExpectedStream& each : made_.streams) {
      if (losing.contains(each.name) || each.of_program || each.waits_at_listener) continue;
      scenario::Requirement latency;
      latency.stream = each.name;
      scenario::DurationLimit& limit = latency.latency.emplace();
      if (each.has_one_listener && each.early == Duration() && each.greatest_receive == Duration()) {
        limit.equal = each.lag + each.latency;
        limit.within = made_.margin;
      } else {
        limit.at_most = each.lag + each.latency + each.greatest_receive + made_.margin;
      }
      require.push_back(std::move(latency));
    }
  }

  const Scenario& running_;
  const scenario::Resolved& resolved_;
  const PlacedChanges& placed_;
  const ChangedFlows& changed_;
  const Transition& transition_;
  Duration at_;
  const std::vector<std::vector<scenario::StreamWindow>> windows_;  // by flow and hop
  const std::vector<Duration> latencies_;                           // by flow
  std::map<FlowIndex, std::string> name_of_;                        // of what comes
  TransitionScenario made_;
};

}  // namespace

TransitionScenario make_transition_scenario(const Scenario& running, const scenario::Resolved& resolved,
                                            const PlacedChanges& placed, const ChangedFlows& changed,
                                            const Transition& transition, Duration at) {
  return Maker(running, resolved, placed, changed, transition, at).run();
}

}  // namespace takt::synthesis
