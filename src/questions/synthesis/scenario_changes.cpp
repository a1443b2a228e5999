// SPDX-License-Identifier: Apache-2.0
#include "synthesis/scenario_changes.hpp"

#include <algorithm>
#include <map>
#include <memory>
#include <set>
#include <utility>

#include "json/node.hpp"
#include "json/quantity.hpp"
#include "json/suggest.hpp"
#include "scenario/gates/crossings.hpp"
#include "scenario/gates/timing.hpp"
#include "scenario/resolve.hpp"
#include "schedule/change.hpp"
#include "schedule_check/instance_check.hpp"
#include "synthesis/instance_of_scenario.hpp"

namespace takt::synthesis {
namespace {

using scenario::Resolved;
using scenario::Scenario;
using scenario::Stream;
using schedule::LinkIndex;
using schedule::StreamIndex;
using sim::Duration;

json::Place option(const char* name) { return {name, 0, 0, ""}; }

std::string suggestion(const std::string& name, const std::vector<std::string>& known) {
  const std::vector<std::string_view> views(known.begin(), known.end());
  return json::suggest(name, views);
}

/// What of the network has failed.
struct Failed {
  std::set<std::uint32_t> links;  // of plan.links
  std::set<std::uint32_t> nodes;
};

class Placing {
 public:
  Placing(const Scenario& running, const RunningGates& gates, const Scenario* plant, const AskedChanges& asked,
          json::Diagnostics& diagnostics)
      : running_(running), gates_(gates), plant_(plant), asked_(asked), diagnostics_(diagnostics) {}

  std::optional<PlacedChanges> run() {
    find_failed();
    check_names();
    if (diagnostics_.has_errors() || !make_instance()) return std::nullopt;
    if (!made_.why_not.empty()) return std::move(made_);
    reject_fixed_streams();
    if (diagnostics_.has_errors()) return std::nullopt;
    change();
    write_down();
    return std::move(made_);
  }

 private:
  const Resolved& resolved() const { return *gates_.resolved; }

  // What has failed already, and what fails now.
  void find_failed() {
    for (const scenario::Fault& fault : running_.faults) {
      if (const auto* const link = std::get_if<scenario::LinkDown>(&fault)) {
        if (const auto found = cable(link->link.front() + ">" + link->link.back())) before_.links.insert(*found);
      } else if (const auto* const crash = std::get_if<scenario::Crash>(&fault)) {
        if (const auto node = resolved().topology.find(crash->node)) fail_node(*node, before_);
      }
    }
    for (const std::string& name : asked_.fail) {
      if (const auto node = resolved().topology.find(name)) {
        fail_node(*node, now_);
        scenario::Crash crash;
        crash.node = name;
        made_.faults.emplace_back(std::move(crash));
      } else if (const auto link = cable(name)) {
        now_.links.insert(*link);
        scenario::LinkDown down;
        down.link = {name.substr(0, name.find('>')), name.substr(name.find('>') + 1)};
        made_.faults.emplace_back(std::move(down));
      } else {
        diagnostics_.error(option("--fail"), "nothing that can fail",
                           {json::quote(name), "a node, or the two ends of a link such as \"sw1>sw2\"",
                            suggestion(name, names_of_links_and_nodes())});
      }
    }
    made_.failed_links.assign(now_.links.begin(), now_.links.end());
  }

  std::vector<std::string> names_of_links_and_nodes() const {
    std::vector<std::string> names;
    for (const scenario::TopologyNode& node : resolved().topology.nodes) names.push_back(node.name);
    for (const models::LinkPlan& link : resolved().plan.links)
      for (const auto& [from, to] : {std::pair(link.a, link.b), std::pair(link.b, link.a)})
        names.push_back(resolved().topology.nodes[from.node.value].name + ">" +
                        resolved().topology.nodes[to.node.value].name);
    return names;
  }

  /// Of "sw1>sw2" the only cable between the two.
  std::optional<std::uint32_t> cable(const std::string& name) {
    const std::size_t middle = name.find('>');
    if (middle == std::string::npos) return std::nullopt;
    const auto a = resolved().topology.find(name.substr(0, middle)),
               b = resolved().topology.find(name.substr(middle + 1));
    if (!a || !b) return std::nullopt;
    std::optional<std::uint32_t> found;
    for (std::uint32_t l = 0; l < resolved().plan.links.size(); ++l) {
      const models::LinkPlan& link = resolved().plan.links[l];
      if (std::minmax(link.a.node.value, link.b.node.value) != std::minmax(*a, *b)) continue;
      if (found) {
        diagnostics_.error(option("--fail"), "one of several cables",
                           {json::quote(name), "nodes with one cable between them: paths of streams name nodes"});
        return std::nullopt;
      }
      found = l;
    }
    return found;
  }

  void fail_node(std::uint32_t node, Failed& failed) const {
    failed.nodes.insert(node);
    for (std::uint32_t l = 0; l < resolved().plan.links.size(); ++l)
      if (resolved().plan.links[l].a.node.value == node || resolved().plan.links[l].b.node.value == node)
        failed.links.insert(l);
  }

  void check_names() {
    std::vector<std::string> scheduled;
    for (const scenario::ScheduledStream& stream : resolved().gates->problem.streams) scheduled.push_back(stream.name);
    std::set<std::string> gone;
    for (const std::string& name : asked_.remove) {
      if (!gone.insert(name).second)
        diagnostics_.error(option("--remove"), "a stream that goes twice",
                           {json::quote(name) + " a second time", "it once"});
      else if (std::find(scheduled.begin(), scheduled.end(), name) == scheduled.end())
        diagnostics_.error(option("--remove"), "no stream with windows",
                           {json::quote(name), "a stream of a scheduled class", suggestion(name, scheduled)});
      else if (std::ranges::find(running_.streams, name, &Stream::name) == running_.streams.end())
        diagnostics_.error(option("--remove"), "a stream of a program",
                           {json::quote(name), "one of \"streams\"; what Programs publish stays"});
    }
  }

  bool make_instance() {
    both_ = running_;
    for (const Stream& each : asked_.add) both_.streams.push_back(each);
    for (const scenario::Requirement& each : asked_.require) both_.require.push_back(each);
    Scenario bare = both_;
    bare.gates.reset();
    bare.allow_overload = true;  // what goes is still there
    // One that goes and comes anew has two entries for now.
    for (std::size_t i = running_.streams.size(); i < bare.streams.size(); ++i)
      if (std::ranges::find(asked_.remove, bare.streams[i].name) != asked_.remove.end()) {
        diagnostics_.error(bare.streams[i].where.at("name"), "a stream that goes and comes",
                           {json::quote(bare.streams[i].name) + " in --remove and in --add", "another name"});
        return false;
      }
    for (scenario::ScriptEntry& entry : bare.script) entry.set_gates.reset();
    auto resolved_bare = scenario::resolve(bare, diagnostics_);
    if (!resolved_bare || diagnostics_.has_errors()) return false;
    find_lags(*resolved_bare);
    find_cut(*resolved_bare);
    // What Programs publish is no stream of the instance: their windows stand in it as they are.
    std::unique_ptr<Resolved> streams_alone;
    if (!bare.programs.empty()) {
      json::Diagnostics unheard;
      streams_alone = scenario::resolve(without_programs(bare), unheard);
      if (!streams_alone || unheard.has_errors()) {
        made_.why_not = "its streams cannot be taken apart from its programs: " +
                        (unheard.kept().empty() ? std::string() : json::to_text(unheard.kept().front()));
        return true;
      }
    }
    Scenario wanted = bare.programs.empty() ? both_ : without_programs(both_);
    wanted.gates = gates_.gates;
    wanted.gates->classes = scheduled_classes();
    for (std::size_t i = 0; i < running_.streams.size(); ++i) {
      Stream& stream = wanted.streams[i];
      if (!may_move(stream)) continue;
      stream.offset = json::OrAuto<Duration>();
      stream.offset->is_auto = true;
      stream.path.reset();
    }
    instance_ = instance_of(streams_alone ? *streams_alone : *resolved_bare, wanted, {}, diagnostics_, made_.why_not,
                            InstanceFor::change);
    if (diagnostics_.has_errors()) return false;
    if (!instance_) return true;
    for (std::size_t i = running_.streams.size(); i < both_.streams.size(); ++i)
      if (std::none_of(instance_->streams.begin(), instance_->streams.end(),
                       [&](const auto& entry) { return entry == i; }))
        diagnostics_.error(both_.streams[i].where.place(), "a stream without windows",
                           {json::quote(both_.streams[i].name) + " in no scheduled class",
                            "a \"pcp\" of a scheduled class; others may come without a change of gates"});
    return !diagnostics_.has_errors();
  }

  static Scenario without_programs(Scenario scenario) {
    scenario.programs.clear();
    std::erase_if(scenario.script, [](const scenario::ScriptEntry& entry) { return !entry.set_gates; });
    std::erase_if(scenario.require, [&](const scenario::Requirement& each) {
      return !each.stream || std::ranges::find(scenario.streams, *each.stream, &Stream::name) == scenario.streams.end();
    });
    return scenario;
  }

  /// As the gates say, or as Programs have it.
  std::vector<std::uint8_t> scheduled_classes() const {
    std::set<std::uint8_t> classes(gates_.gates.classes.begin(), gates_.gates.classes.end());
    if (classes.empty())
      for (const scenario::ScheduledStream& stream : resolved().gates->problem.streams)
        if (is_of_program(stream)) classes.insert(stream.hops.front().traffic_class);
    return {classes.begin(), classes.end()};
  }

  bool is_of_program(const scenario::ScheduledStream& stream) const {
    return std::ranges::find(running_.streams, stream.name, &Stream::name) == running_.streams.end();
  }

  bool may_move(const Stream& stream) const {
    if (stream.to.names.size() != 1) return false;
    if (plant_ == nullptr) return stream.every && stream.offset;
    const auto wish = std::ranges::find(plant_->streams, stream.name, &Stream::name);
    return wish != plant_->streams.end() && wish->offset && wish->offset->is_auto && !wish->path;
  }

  /// From the offset of a stream until its frame is at its talker's port.
  void find_lags(const Resolved& bare) {
    const scenario::Timings timings = scenario::timings_of(bare);
    for (const scenario::ResolvedStream& stream : bare.streams) {
      const auto found =
          std::ranges::find(bare.scenario.streams, bare.plan.streams[stream.index.value].name, &Stream::name);
      if (found != bare.scenario.streams.end())
        lag_of_[found->name] = timings.of_streams[stream.index.value].release - found->offset.value_or(Duration());
    }
  }

  bool crosses(const scenario::Path& path, const std::set<std::uint32_t>& links) const {
    for (std::size_t i = 0; i + 1 < path.size(); ++i)
      for (const std::uint32_t l : links) {
        const models::LinkPlan& link = resolved().plan.links[l];
        if (std::minmax(link.a.node.value, link.b.node.value) == std::minmax(path[i], path[i + 1])) return true;
      }
    return false;
  }

  void find_cut(const Resolved& bare) {
    for (const scenario::ResolvedStream& stream : bare.streams) {
      const std::string& name = bare.plan.streams[stream.index.value].name;
      if (std::none_of(stream.paths.begin(), stream.paths.end(),
                       [&](const scenario::Path& path) { return crosses(path, now_.links); }))
        continue;
      if (std::any_of(stream.paths.begin(), stream.paths.end(), [&](const scenario::Path& path) {
            return now_.nodes.contains(path.front()) || now_.nodes.contains(path.back());
          }))
        ended_.insert(name);
      const bool has_windows =
          std::ranges::find(resolved().gates->problem.streams, name, &scenario::ScheduledStream::name) !=
          resolved().gates->problem.streams.end();
      if (has_windows)
        cut_.insert(name);
      else if (std::ranges::find(running_.streams, name, &Stream::name) != running_.streams.end() || stream.of_program)
        made_.without_way.push_back(name);
    }
  }

  void reject_fixed_streams() {
    for (const scenario::ScheduledStream& stream : resolved().gates->problem.streams)
      if (cut_.contains(stream.name) && is_of_program(stream))
        diagnostics_.error(
            option("--fail"), "a stream of a program over what fails",
            {json::quote(stream.name), "something that no Program needs: what they publish takes no other way"});
  }

  /// What Programs publish at one instant keeps each link on its way from the first to the last bit of it.
  void add_programs(schedule::Problem& problem, schedule::Solution& solution) {
    struct Block {
      std::string name;
      std::uint32_t port = 0;
      Duration period, from, until, behind;
      std::uint8_t traffic_class = 0;
    };
    std::map<std::pair<std::uint32_t, std::uint32_t>, Block> blocks;  // by train and port
    const scenario::GatePlan& plan = *resolved().gates;
    for (std::size_t s = 0; s < plan.problem.streams.size(); ++s) {
      const scenario::ScheduledStream& stream = plan.problem.streams[s];
      if (!is_of_program(stream)) continue;
      for (std::size_t h = 0; h < stream.hops.size(); ++h) {
        const scenario::ScheduledHop& hop = stream.hops[h];
        const Duration from = plan.schedule.windows[s][h].start, until = from + hop.transmission;
        const auto [found, is_new] = blocks.try_emplace(
            {stream.train, hop.port}, Block{stream.name + " at " + plan.problem.ports[hop.port].name, hop.port,
                                            stream.period, from, until, hop.behind, hop.traffic_class});
        found->second.from = std::min(found->second.from, from);
        found->second.until = std::max(found->second.until, until);
      }
    }
    for (const auto& [key, block] : blocks) {
      const scenario::GatedPort& port = plan.problem.ports[block.port];
      const LinkIndex link = link_at_.at({port.node.value, port.port});
      const schedule::Link& cable = problem.links[link];
      schedule::Stream stream;
      stream.name = block.name;
      stream.talker = cable.from;
      stream.listeners = {cable.to};
      stream.octets = static_cast<std::uint32_t>(((block.until - block.from).ps() + cable.octet - 1) / cable.octet) -
                      problem.model.preamble;
      stream.period = block.period.ps();
      stream.release = block.from.ps();
      stream.deadline = stream.release + (stream.octets + problem.model.preamble) * cable.octet + cable.propagation +
                        cable.forwarding;
      stream.route = {{link}};
      stream.traffic_class = block.traffic_class;
      solution.streams.push_back(schedule::Placement{{link}, {{stream.release}}, {block.traffic_class}});
      problem.streams.push_back(std::move(stream));
      entry_.push_back(std::nullopt);
    }
  }

  void find_ports() {
    for (std::uint32_t l = 0; l < resolved().plan.links.size(); ++l) {
      const models::LinkPlan& link = resolved().plan.links[l];
      link_at_[{link.a.node.value, link.a.port}] = 2 * l;
      link_at_[{link.b.node.value, link.b.port}] = 2 * l + 1;
    }
  }

  void change() {
    // Who runs now, in the order of the instance; who comes is placed one by one.
    find_ports();
    schedule::Problem problem = instance_->problem;
    problem.streams.clear();
    schedule::Solution solution;
    solution.timing = schedule::GateTiming::flowing;
    std::vector<StreamIndex> coming;
    for (StreamIndex s = 0; s < instance_->problem.streams.size(); ++s) {
      if (instance_->streams[s] && *instance_->streams[s] >= running_.streams.size()) {
        coming.push_back(s);
        continue;
      }
      problem.streams.push_back(instance_->problem.streams[s]);
      entry_.push_back(instance_->streams[s]);
      solution.streams.push_back(placement_of(problem.streams.back().name));
    }
    add_programs(problem, solution);
    const std::size_t present = problem.streams.size();
    const auto wrong = schedule_check::check(problem, solution, 1);
    const std::string why = wrong.empty() ? schedule::why_not_changeable(problem, solution) : wrong.front();
    if (!why.empty()) {
      made_.why_not = why;
      return;
    }
    before_solution_ = solution;
    schedule::Plant plant(problem, solution);
    const auto index_of = [&](const std::string& name) {
      return static_cast<StreamIndex>(std::ranges::find(problem.streams, name, &schedule::Stream::name) -
                                      problem.streams.begin());
    };
    for (const std::string& name : asked_.remove) {
      fates_[index_of(name)] = StreamFate::goes;
      plant.remove(index_of(name));
    }
    for (StreamIndex s = 0; s < present; ++s) {
      const std::string& name = problem.streams[s].name;
      if (!cut_.contains(name) || fates_.contains(s)) continue;
      // Ways of several listeners are trees that a scenario does not name; what the plant fixes stays fixed.
      if (!ended_.contains(name) && may_move(running_.streams[*entry_[s]])) continue;
      fates_[s] = StreamFate::lost;
      plant.remove(s);
    }
    for (const Failed* failed : {&before_, &now_})
      for (const std::uint32_t link : failed->links)
        for (const LinkIndex l : {2 * link, 2 * link + 1})
          for (const StreamIndex lost : plant.fail(l).lost) fates_[lost] = StreamFate::lost;
    for (const StreamIndex s : coming) {
      const auto added = plant.add(instance_->problem.streams[s]);
      if (!added) {
        made_.without_place.push_back(instance_->problem.streams[s].name);
        continue;
      }
      entry_.push_back(instance_->streams[s]);
      fates_[added->stream] = StreamFate::comes;
    }
    problem_ = plant.problem();
    after_solution_ = plant.solution();
    for (StreamIndex s = 0; s < present; ++s)
      if (after_solution_.streams[s] &&
          (after_solution_.streams[s]->route != before_solution_.streams[s]->route ||
           after_solution_.streams[s]->starts.front() != before_solution_.streams[s]->starts.front()))
        fates_[s] = StreamFate::moves;
  }

  /// As the windows have it.
  schedule::Placement placement_of(const std::string& name) const {
    const scenario::GatePlan& plan = *resolved().gates;
    const auto found = std::ranges::find(plan.problem.streams, name, &scenario::ScheduledStream::name);
    const auto s = static_cast<std::size_t>(found - plan.problem.streams.begin());
    schedule::Placement placement;
    for (std::size_t h = 0; h < found->hops.size(); ++h) {
      const scenario::GatedPort& port = plan.problem.ports[found->hops[h].port];
      placement.route.push_back(link_at_.at({port.node.value, port.port}));
      placement.starts.push_back({plan.schedule.windows[s][h].start.ps()});
      placement.classes.push_back(found->hops.front().traffic_class);
    }
    return placement;
  }

  /// From when on clocks are said to be synchronised: nobody begins before.
  Duration synchronised_from() const {
    if (!running_.clocks.gptp) return {};
    for (const scenario::Requirement& required : running_.require)
      if (required.sync || required.clocks) return required.after.value_or(running_.warm_up);
    return running_.warm_up;
  }

  Stream placed(StreamIndex s) const {
    Stream stream = both_.streams[*entry_[s]];
    const schedule::Placement& placement = *after_solution_.streams[s];
    const bool is_written = stream.to.names.size() == 1;
    if (is_written) {
      std::vector<std::string> path{problem_.nodes[problem_.links[placement.route.front()].from].name};
      for (const LinkIndex l : placement.route) path.push_back(problem_.nodes[problem_.links[l].to].name);
      stream.path = std::move(path);
    }
    if (!problem_.streams[s].deadline) {  // else its offset is a number of its own
      // Whole ns; where delays are none the windows have the last word.
      const std::int64_t period = problem_.streams[s].period;
      std::int64_t offset =
          scenario::floor_ns(Duration::from_ps(placement.starts.front().front()) - lag_of_.at(stream.name)).ps();
      const std::int64_t least = synchronised_from().ps();
      offset = ((offset - least) % period + period) % period + least;
      stream.offset = json::OrAuto<Duration>(Duration::from_ps(offset));
    }
    return stream;
  }

  void write_down() {
    if (!made_.why_not.empty()) return;
    Scenario& after = made_.after;
    after = running_;
    after.gates = gates_.gates;
    std::set<std::string> gone;
    for (const auto& [s, fate] : fates_) {
      StreamChange change;
      change.name = problem_.streams[s].name;
      change.fate = fate;
      change.was_cut = cut_.contains(change.name);
      if (fate != StreamFate::comes) change.before = running_.streams[*entry_[s]];
      if (fate == StreamFate::comes || fate == StreamFate::moves) change.after = placed(s);
      if (fate == StreamFate::comes) after.streams.push_back(*change.after);
      if (fate == StreamFate::moves) *std::ranges::find(after.streams, change.name, &Stream::name) = *change.after;
      if (fate == StreamFate::goes || fate == StreamFate::lost) gone.insert(change.name);
      made_.changes.push_back(std::move(change));
    }
    for (const scenario::Requirement& each : asked_.require)
      if (!each.stream || std::ranges::find(made_.without_place, *each.stream) == made_.without_place.end())
        after.require.push_back(each);
    std::erase_if(after.streams, [&](const Stream& stream) { return gone.contains(stream.name); });
    std::erase_if(after.require,
                  [&](const scenario::Requirement& each) { return each.stream && gone.contains(*each.stream); });
    for (const scenario::Fault& fault : made_.faults) after.faults.push_back(fault);
  }

  const Scenario& running_;
  const RunningGates& gates_;
  const Scenario* plant_;
  const AskedChanges& asked_;
  json::Diagnostics& diagnostics_;
  Failed before_, now_;
  Scenario both_;                             // what runs and what comes
  std::optional<ScenarioInstance> instance_;  // of both
  std::map<std::pair<std::uint32_t, std::uint16_t>, LinkIndex>
      link_at_;  // by node and port: two directions of each cable
  std::map<std::string, Duration> lag_of_;
  std::set<std::string> cut_, ended_;              // streams: over what fails; from or to it
  std::vector<std::optional<std::size_t>> entry_;  // by stream of problem_: in both_.streams
  schedule::Problem problem_;
  schedule::Solution before_solution_, after_solution_;
  std::map<StreamIndex, StreamFate> fates_;
  PlacedChanges made_;
};

}  // namespace

std::optional<PlacedChanges> place_changes(const Scenario& running, const RunningGates& gates, const Scenario* plant,
                                           const AskedChanges& asked, json::Diagnostics& diagnostics) {
  return Placing(running, gates, plant, asked, diagnostics).run();
}

void check_changeable(const Scenario& running, json::Diagnostics& diagnostics) {
  for (std::size_t i = 0; i < running.script.size(); ++i)
    if (running.script[i].set_gates)
      diagnostics.error(running.script[i].where.at("set_gates"), "gates that change already",
                        {"\"set_gates\" in the script", "lists that stay until the change that is asked for"});
  for (const scenario::Fault& fault : running.faults) {
    const auto* const link = std::get_if<scenario::LinkDown>(&fault);
    const auto* const crash = std::get_if<scenario::Crash>(&fault);
    const bool lasts = (link != nullptr && link->at == Duration() && !link->lasts) ||
                       (crash != nullptr && crash->at == Duration() && !crash->lasts);
    if (!lasts)
      diagnostics.error(std::visit([](const auto& each) { return each.where.place(); }, fault), "a fault of its own",
                        {"a fault that begins or ends while the plant runs",
                         "links that are down and nodes that have crashed from 0s on, and --fail for what fails now"});
  }
}

}  // namespace takt::synthesis
