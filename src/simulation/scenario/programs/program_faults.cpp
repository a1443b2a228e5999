// SPDX-License-Identifier: Apache-2.0
#include "scenario/programs/program_faults.hpp"

#include <algorithm>
#include <set>

namespace takt::scenario {
namespace {

class ProgramFaults {
 public:
  ProgramFaults(const Resolved& resolved, const ResolvedProgram& program) : r_(resolved), program_(program) {}

  std::vector<ProgramFault> make() {
    if (r_.scenario.faults.empty()) return {};
    find_streams();
    for (std::size_t i = 0; i < r_.script.size(); ++i)
      std::visit([&](const auto& action) { add(i, action); }, r_.script[i].what);
    for (const models::ImpairmentPlan& each : r_.plan.impairments) add(each);
    for (const models::TalkerPlan& each : r_.plan.talkers)
      if (each.babbles) add(each);
    std::stable_sort(made_.begin(), made_.end(),
                     [](const ProgramFault& a, const ProgramFault& b) { return a.at < b.at; });
    return std::move(made_);
  }

 private:
  void find_streams() {
    std::vector<models::StreamIndex> all;
    for (const ResolvedMember& each : program_.members) {
      states_.push_back(each.state);
      all.push_back(each.state);
      if (each.roles) all.push_back(*each.roles);
      for (const auto& data : each.data)
        if (data) all.push_back(*data);
    }
    for (const models::StreamIndex stream : all) {
      addresses_.insert(r_.plan.streams[stream.value].destination.value);
      for (const Path& path : r_.streams[stream.value].paths) {
        nodes_.insert(path.begin(), path.end());
        for (std::size_t i = 0; i + 1 < path.size(); ++i)
          links_.insert(link_at(path[i], port_out(r_.topology, path, i)));
      }
    }
  }

  std::uint32_t link_at(std::uint32_t node, std::uint16_t port) const {
    const auto is = [&](const models::LinkPlan::End& end) { return end.node.value == node && end.port == port; };
    const auto found = std::find_if(r_.plan.links.begin(), r_.plan.links.end(),
                                    [&](const models::LinkPlan& link) { return is(link.a) || is(link.b); });
    return static_cast<std::uint32_t>(found - r_.plan.links.begin());
  }
  const std::string& name(models::NodeIndex node) const { return r_.plan.nodes[node.value].name; }
  std::string link_name(std::uint32_t link) const {
    return name(r_.plan.links[link].a.node) + " - " + name(r_.plan.links[link].b.node);
  }

  /// When what `Action` takes down at entry `i` is up again: for the last time, if several faults overlap.
  template <class Action>
  sim::TrueTime until(std::size_t i, const auto& is_same) const {
    int down = 0;
    for (std::size_t j = 0; j < r_.script.size(); ++j) {
      const Action* const other = std::get_if<Action>(&r_.script[j].what);
      if (other == nullptr || !is_same(*other)) continue;
      down += other->up ? -1 : 1;
      if (j > i && down == 0) return r_.script[j].at;
    }
    return sim::TrueTime::never();
  }

  void add(std::size_t i, const ResolvedLink& action) {
    if (action.up || !links_.contains(action.link)) return;
    ProgramFault fault{r_.script[i].at,
                       until<ResolvedLink>(i, [&](const ResolvedLink& other) { return other.link == action.link; }),
                       "link " + link_name(action.link) + " goes down",
                       "link " + link_name(action.link) + " is up again", handshake::Cause::cut};
    silence(fault, [&](const Path& path) {
      for (std::size_t n = 0; n + 1 < path.size(); ++n)
        if (link_at(path[n], port_out(r_.topology, path, n)) == action.link) return true;
      return false;
    });
    made_.push_back(std::move(fault));
  }

  void add(std::size_t i, const ResolvedNode& action) {
    if (action.up || !nodes_.contains(action.node.value)) return;
    const bool is_member =
        std::ranges::any_of(program_.members, [&](const ResolvedMember& each) { return each.node == action.node; });
    ProgramFault fault{r_.script[i].at,
                       until<ResolvedNode>(i, [&](const ResolvedNode& other) { return other.node == action.node; }),
                       name(action.node) + " crashes", name(action.node) + " is back",
                       is_member ? handshake::Cause::crash : handshake::Cause::cut};
    silence(fault, [&](const Path& path) {
      return path.back() != action.node.value && std::find(path.begin(), path.end(), action.node.value) != path.end();
    });
    made_.push_back(std::move(fault));
  }

  void add(std::size_t i, const ResolvedStuckGate& action) {
    if (!links_.contains(link_at(action.node.value, action.port))) return;
    const std::string gate = "gate of class " + std::to_string(action.traffic_class) + " at " + name(action.node) +
                             ":" + std::to_string(action.port);
    made_.push_back({r_.script[i].at, sim::TrueTime::never(),
                     gate + (!action.open   ? " works again"
                             : *action.open ? " is stuck open"
                                            : " is stuck closed")});
  }

  void add(std::size_t i, const ResolvedClockFault& action) {
    if (nodes_.contains(action.node.value))
      made_.push_back({r_.script[i].at, sim::TrueTime::never(),
                       "clock of " + name(action.node) + (action.step ? " jumps" : " changes its frequency")});
  }

  void add(std::size_t i, const ResolvedRoutes& action) {
    const bool is_ours =
        std::any_of(action.entries.begin(), action.entries.end(),
                    [&](const ResolvedRoutes::Entry& entry) { return addresses_.contains(entry.address.value); });
    if (is_ours) made_.push_back({r_.script[i].at, sim::TrueTime::never(), "streams are rerouted"});
  }

  void add(std::size_t i, const ResolvedBypass& action) {
    if (!nodes_.contains(action.node.value)) return;
    made_.push_back({r_.script[i].at, sim::TrueTime::never(),
                     name(action.node) + (action.joins ? " is bypassed" : " is bypassed no more")});
  }

  void add(std::size_t, const ResolvedCall&) {}
  void add(std::size_t, const ResolvedMembership&) {}
  void add(std::size_t, const ResolvedGates&) {}

  /// Once for both directions.
  void add(const models::ImpairmentPlan& plan) {
    if (!links_.contains(plan.link)) return;
    const std::string text = "frame errors on link " + link_name(plan.link);
    const auto is_known = [&](const ProgramFault& other) {
      return other.text == text + " begin" && other.at == plan.impairment.from && other.until == plan.impairment.until;
    };
    if (std::any_of(made_.begin(), made_.end(), is_known)) return;
    made_.push_back({plan.impairment.from, plan.impairment.until, text + " begin", text + " end"});
  }

  void add(const models::TalkerPlan& talker) {
    for (const Path& path : r_.streams[talker.stream.value].paths)
      for (std::size_t n = 0; n + 1 < path.size(); ++n) {
        if (!links_.contains(link_at(path[n], port_out(r_.topology, path, n)))) continue;
        const auto* const schedule = std::get_if<models::PeriodicSchedule>(&talker.schedule);
        const std::string& stream = r_.plan.streams[talker.stream.value].name;
        const bool has_end = talker.until != sim::LocalTime::never();
        made_.push_back({sim::TrueTime() + (schedule != nullptr ? schedule->offset : Duration()),
                         has_end ? sim::TrueTime::from_ps(talker.until.ps()) : sim::TrueTime::never(),
                         "stream " + stream + " babbles", has_end ? "stream " + stream + " babbles no more" : ""});
        return;
      }
  }

  void silence(ProgramFault& fault, const auto& is_hit) const {
    for (const models::StreamIndex stream : states_)
      for (const Path& path : r_.streams[stream.value].paths)
        if (is_hit(path)) fault.silenced.emplace_back(path.front(), path.back());
    std::sort(fault.silenced.begin(), fault.silenced.end());
  }

  const Resolved& r_;
  const ResolvedProgram& program_;
  std::vector<models::StreamIndex> states_;
  std::set<std::uint32_t> nodes_;
  std::set<std::uint32_t> links_;
  std::set<std::uint32_t> addresses_;
  std::vector<ProgramFault> made_;
};

}  // namespace

std::vector<ProgramFault> faults_of(const Resolved& resolved, const ResolvedProgram& program) {
  return ProgramFaults(resolved, program).make();
}

handshake::Origin explain_silence(const std::vector<ProgramFault>& faults, std::uint32_t from, std::uint32_t to,
                                  sim::TrueTime since, sim::TrueTime now) {
  for (auto fault = faults.rbegin(); fault != faults.rend(); ++fault)
    if (fault->cause && fault->at <= now && fault->until >= since &&
        std::binary_search(fault->silenced.begin(), fault->silenced.end(), std::pair(from, to)))
      return {*fault->cause, fault->at};
  return {handshake::Cause::silence, since};
}

}  // namespace takt::scenario
