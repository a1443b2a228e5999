// SPDX-License-Identifier: Apache-2.0
// A run of a resolved scenario under the eyes of a wire checker.
#pragma once

#include <algorithm>

#include "scenario/run/run.hpp"
#include "tests/wire_checker/wire_checker.hpp"

namespace takt::wire_checker {

/// The script of the scenario, faults included, in the checker's words.
inline std::vector<Change> changes_of(const scenario::Resolved& resolved) {
  std::vector<Change> changes;
  for (const scenario::ResolvedAction& action : resolved.script) {
    const Ps at = action.at.ps();
    if (const auto* const gates = std::get_if<scenario::ResolvedGates>(&action.what))
      changes.push_back({at, Change::Gates{gates->node, gates->port, gates->gates}});
    if (const auto* const stuck = std::get_if<scenario::ResolvedStuckGate>(&action.what))
      changes.push_back({at, Change::StuckGate{stuck->node, stuck->port, stuck->traffic_class, stuck->open}});
    if (const auto* const link = std::get_if<scenario::ResolvedLink>(&action.what))
      changes.push_back({at, Change::LinkState{link->link, link->up}});
    if (const auto* const node = std::get_if<scenario::ResolvedNode>(&action.what))
      for (std::uint32_t l = 0; l < resolved.plan.links.size(); ++l)
        if (resolved.plan.links[l].a.node == node->node || resolved.plan.links[l].b.node == node->node)
          changes.push_back({at, Change::LinkState{l, node->up}});
    if (std::holds_alternative<scenario::ResolvedRoutes>(action.what)) changes.push_back({at, Change::Routes{}});
  }
  return changes;
}

inline Directory directory_of(const models::Network& network) {
  Directory directory;
  const models::NetworkPlan& plan = network.plan();
  for (std::uint32_t n = 0; n < plan.nodes.size(); ++n) {
    directory.nodes.emplace_back();
    if (plan.nodes[n].forwards()) directory.nodes.back().push_back(network.bridge({n}).id());
    if (plan.nodes[n].is_end_station()) directory.nodes.back().push_back(network.host({n})->id());
    directory.ports.emplace_back();
    for (const models::EgressPort& port : network.ports({n})) directory.ports.back().push_back(port.id());
  }
  return directory;
}

/// Frames may be in a host beside its latencies: they are sealed there. The checker sees them when they leave.
inline bool hosts_hold(const scenario::Resolved& resolved) {
  return std::ranges::any_of(resolved.programs, [](const scenario::ResolvedProgram& program) {
    return std::ranges::any_of(program.members, [](const auto& member) { return member.seal > sim::Duration(); });
  });
}

class CheckedRun {
 public:
  explicit CheckedRun(const scenario::Resolved& resolved, std::uint64_t tie_shuffle = 0)
      : run(resolved, tie_shuffle),
        checker(resolved.plan, changes_of(resolved), directory_of(run.network()),
                [this](models::FrameIndex handle) -> const models::Frame& {
                  return run.network().traffic().frame(handle);
                }) {
    run.simulation().set_trace(&checker);
  }
  CheckedRun(const CheckedRun&) = delete;
  CheckedRun& operator=(const CheckedRun&) = delete;

  /// To the end of the scenario; all that is wrong is in the checker's violations then.
  const Violations& to_the_end() {
    run.advance();
    checker.finish(run.end().ps());
    checker.compare(run.network().traffic().streams(), hosts_hold(run.resolved()));
    look_at_pool();
    return checker.violations();
  }

  scenario::Run run;
  WireChecker checker;

 private:
  /// Every frame that lives is under way, and every one under way lives.
  void look_at_pool() {
    const models::Traffic& traffic = run.network().traffic();
    std::uint64_t references = 0, alive = 0, in_flight = 0;
#ifdef TAKT_LONE_SLOTS
    // Of a frame that has ended nothing is left to look at.
    traffic.for_each_live([&](const models::Frame& frame) {
      references += frame.references;
      ++alive;
    });
#else
    for (const std::uint32_t handle : checker.handles()) {
      references += traffic.frame({handle}).references;
      alive += traffic.frame({handle}).references > 0 ? 1 : 0;
    }
#endif
    for (const models::Stream& stream : traffic.streams()) in_flight += stream.in_flight();
    // A frame of which only the header has come may wait as a record that no trace has named.
    bool cuts_through = false;
    for (const models::PortConfig& config : run.resolved().plan.port_configs) cuts_through |= config.cut_through != 0;
    const auto compare = [&](const char* what, std::uint64_t a, std::uint64_t b) {
      if (cuts_through ? a > b : a != b)
        checker.violations().add(run.end().ps(), "frame pool",
                                 std::string(what) + ": " + std::to_string(a) + " and " + std::to_string(b));
    };
    compare("references of live frames, frames in flight", references, in_flight);
    compare("live frames among those seen, all live frames", alive, traffic.live_frames());
  }
};

}  // namespace takt::wire_checker
