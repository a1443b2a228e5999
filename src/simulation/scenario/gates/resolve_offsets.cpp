// SPDX-License-Identifier: Apache-2.0
#include "scenario/gates/resolve_offsets.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "models/ethernet/sizes.hpp"
#include "scenario/gates/offsets.hpp"
#include "scenario/resolve/port_configs.hpp"
#include "scenario/resolve/stream_at_port.hpp"

namespace takt::scenario {
namespace {

constexpr std::uint32_t nowhere = 0xFFFF'FFFF;

Program& program_of(Resolved& r, const OffsetChoice& choice) {
  const auto number = r.programs[choice.item].description - r.scenario.programs.data();
  return r.scenario.programs[static_cast<std::size_t>(number)];
}

json::Place place_of(const Resolved& r, const OffsetChoice& choice) {
  return (choice.is_program ? r.programs[choice.item].description->where : r.scenario.streams[choice.item].where)
      .at("offset");
}

/// Writes what was chosen where a scenario that says a number has it.
void apply(Resolved& r, const OffsetChoice& choice, Duration offset) {
  if (!choice.is_program) {
    r.chosen_offsets.push_back({r.scenario.streams[choice.item].name, offset, *r.scenario.streams[choice.item].every});
    r.scenario.streams[choice.item].offset = offset;
    std::get<models::PeriodicSchedule>(r.plan.talkers[choice.item].schedule).offset = offset;
    return;
  }
  Program& description = program_of(r, choice);
  ResolvedProgram& program = r.programs[choice.item];
  r.chosen_offsets.push_back(
      {program.name + (choice.participant ? "/state/" + program.participant_names[*choice.participant] : ""), offset,
       description.cycle});
  if (!choice.participant) {
    description.offset = offset;
    program.phases.assign(program.phases.size(), offset);
    return;
  }
  program.phases[*choice.participant] = offset;
  description.phases.emplace_back(program.participant_names[*choice.participant], offset);
  // Who has no phase of its own: nobody. The offset is then the first of the phases, for those who read it.
  description.offset = description.offset->is_auto ? offset : std::min<Duration>(*description.offset, offset);
}

/// Moves everything that begins with the choice.
void settle(Resolved& r, Timings& timings, std::uint32_t choice, Duration offset) {
  apply(r, timings.choices[choice], offset);
  for (FrameTiming& timing : timings.of_streams) {
    if (timing.choice != choice) continue;
    timing.release += offset;
    timing.choice = std::nullopt;
  }
}

/// The movable streams of a problem, by choice.
std::vector<std::uint32_t> add_movable(OffsetProblem& problem, const Timings& timings,
                                       const std::vector<models::StreamIndex>& streams) {
  std::map<std::uint32_t, std::vector<std::uint32_t>> by_choice;
  for (std::uint32_t s = 0; s < streams.size(); ++s)
    if (const auto choice = timings.of_streams[streams[s].value].choice) by_choice[*choice].push_back(s);
  std::vector<std::uint32_t> choices;
  for (auto& [choice, members] : by_choice) {
    choices.push_back(choice);
    problem.movable.push_back(std::move(members));
  }
  return choices;
}

/// Who meets whom, for one entry of a file: each two streams once, the first three and how many more.
struct Meetings {
  json::Place place;
  std::string text;
  std::size_t told = 0;
  std::uint32_t last = 0;  // whose meeting was told last
  std::set<std::pair<std::uint32_t, std::uint32_t>> pairs;
};

/// One diagnostic for each entry whose offsets were to be chosen.
template <class Tell>
void report(const Resolved& r, const Timings& timings, const OffsetProblem& problem,
            const std::vector<std::uint32_t>& choices, const std::vector<ChosenOffset>& chosen, Tell&& tell) {
  std::map<std::string, Meetings> by_place;  // a program has several choices
  std::vector<std::string> order;
  for (std::size_t u = 0; u < choices.size(); ++u) {
    const json::Place place = place_of(r, timings.choices[choices[u]]);
    for (const Meeting& meeting : chosen[u].meetings) {
      const auto [at, is_new] = by_place.try_emplace(place.pointer);
      if (is_new) {
        at->second.place = place;
        order.push_back(place.pointer);
      }
      if (!at->second.pairs.insert(std::minmax(meeting.stream, meeting.other)).second || at->second.told == 3) continue;
      Meetings& here = at->second;
      const bool is_next = here.told > 0 && here.last == meeting.stream;
      if (!is_next)
        here.text += (here.told > 0 ? "; " : "") + json::quote(problem.gates.streams[meeting.stream].name) +
                     " even with " + json::to_text(chosen[u].offset) + " meets ";
      here.text += (is_next ? ", " : "") + json::quote(problem.gates.streams[meeting.other].name) + " at " +
                   json::quote(problem.gates.ports[meeting.port].name);
      here.last = meeting.stream;
      ++here.told;
    }
  }
  for (const std::string& pointer : order) {
    const Meetings& each = by_place.at(pointer);
    tell(each.place,
         each.text +
             (each.pairs.size() > each.told ? " and " + std::to_string(each.pairs.size() - each.told) + " more" : ""));
  }
}

/// All frames that come at known times, as they go if nothing holds them up.
class Ways {
 public:
  Ways(const Resolved& resolved, const Timings& timings) : r_(resolved), timings_(timings), at_(r_.streams.size()) {
    for (const StreamAtPort& at : streams_at_ports(r_)) at_[at.stream.value].push_back(at);
    for (const models::LinkPlan& link : r_.plan.links)
      for (const models::LinkPlan::End* end : {&link.a, &link.b}) ends_[{end->node.value, end->port}] = {&link, end};
    for (const ResolvedRedundancy& each : r_.redundancies)
      members_[each.stream.value] = each.is_ladder() ? r_.streams[each.stream.value].paths.size() : each.members.size();
  }

  void run() {
    problem.waiting = Waiting::nowhere;
    const bool has_clocks = std::any_of(r_.plan.nodes.begin(), r_.plan.nodes.end(),
                                        [](const models::NodePlan& node) { return node.clock.has_value(); });
    problem.gates.margin = r_.gates ? r_.gates->problem.margin : has_clocks ? 1_us : Duration();
    for (const ResolvedStream& stream : r_.streams)
      if (timings_.of_streams[stream.index.value].is_known && !stream.paths.empty()) add(stream);
  }

  OffsetProblem problem;
  std::vector<models::StreamIndex> streams;

 private:
  struct End {
    const models::LinkPlan* link = nullptr;
    const models::LinkPlan::End* end = nullptr;
  };
  /// A stream, or a member of it, at a port.
  struct Step {
    const StreamAtPort* at = nullptr;
    End end;
    Duration transmission;
    Duration behind;                   ///< to the next port
    Duration start = Duration::max();  ///< after the release
    std::size_t before = nowhere;      ///< the step from which it comes first
    Duration wait = {};                ///< behind other copies
  };

  void add(const ResolvedStream& stream) {
    const auto redundant = members_.find(stream.index.value);
    std::vector<Step> steps;
    for (const StreamAtPort& at : at_[stream.index.value]) {
      const End end = ends_.at({at.node, at.port});
      steps.push_back({&at, end, end.link->rate.octet_time() * (models::preamble_and_sfd + at.frame).count,
                       end.link->delay + r_.plan.nodes[at.peer].greatest_forwarding_delay()});
    }
    // Copies that are eliminated go no further: behind a merge counts the way on which they come first. Each round
    // takes that further.
    for (bool has_changed = true; has_changed;) {
      has_changed = false;
      for (std::size_t i = 0; i < stream.paths.size(); ++i) {
        const Path& path = stream.paths[i];
        std::size_t before = nowhere;
        for (std::size_t n = 0; n + 1 < path.size(); ++n) {
          const std::size_t step =
              find(steps, path[n], path[n + 1], redundant == members_.end() ? 0 : i % redundant->second);
          if (step == nowhere) break;
          if (n > 0) cut_through(steps[before], steps[step], stream);
          const Duration ready =
              n == 0 ? Duration() : steps[before].start + steps[before].transmission + steps[before].behind;
          const Duration start = behind_other_copies(steps, step, ready);
          if (start < steps[step].start) {
            steps[step].start = start;
            steps[step].before = before;
            steps[step].wait = start - ready;
            has_changed = true;
          }
          before = step;
        }
      }
    }
    put(stream, steps);
  }

  /// Copies of one frame that are ready at one port together, as at the only port of a host that splits, leave in the
  /// order of the members.
  static Duration behind_other_copies(const std::vector<Step>& steps, std::size_t own, Duration ready) {
    for (std::size_t s = 0; s < own; ++s) {
      if (steps[s].at->node != steps[own].at->node || steps[s].at->port != steps[own].at->port ||
          steps[s].start == Duration::max())
        continue;
      const Duration free = steps[s].start + steps[s].transmission +
                            steps[s].end.link->rate.octet_time() * models::inter_packet_gap.count;
      if (ready >= steps[s].start && ready < free) ready = free;
    }
    return ready;
  }

  static std::size_t find(const std::vector<Step>& steps, std::uint32_t from, std::uint32_t to, std::size_t member) {
    for (std::size_t s = 0; s < steps.size(); ++s)
      if (steps[s].at->node == from && steps[s].at->peer == to &&
          (!steps[s].at->member || *steps[s].at->member == member))
        return s;
    return nowhere;
  }

  /// A port that need not wait for the last bit sends once the header is in.
  void cut_through(Step& before, const Step& step, const ResolvedStream& stream) const {
    const models::PortConfig& config = port_config_of(r_.plan, *step.end.end);
    if ((config.cut_through & step.at->classes) == 0 || config.untagged || before.end.link->rate != step.end.link->rate)
      return;
    const models::NodePlan& node = r_.plan.nodes[step.at->node];
    const Octets header =
        node.cut_through_header + (r_.plan.streams[stream.index.value].priority ? models::vlan_tag : Octets{0});
    const Duration in = before.end.link->rate.octet_time() * header.count;
    if (in < before.transmission)
      before.behind =
          before.end.link->delay + node.forwarding_delay + in - before.transmission;  // such nodes have no jitter
  }

  void put(const ResolvedStream& stream, const std::vector<Step>& steps) {
    std::vector<std::size_t> order;
    for (std::size_t s = 0; s < steps.size(); ++s)
      if (steps[s].start != Duration::max()) order.push_back(s);
    std::ranges::stable_sort(order, {}, [&](std::size_t s) { return steps[s].start; });
    const FrameTiming& timing = timings_.of_streams[stream.index.value];
    ScheduledStream made;
    made.name = r_.plan.streams[stream.index.value].name;
    made.period = timing.period;
    made.release = timing.release;
    made.early = timing.early + jitter_of(stream);
    made.train = timing.train;
    std::vector<std::uint32_t> hop_of(steps.size(), nowhere);
    for (const std::size_t s : order) {
      const Step& step = steps[s];
      hop_of[s] = static_cast<std::uint32_t>(made.hops.size());
      ScheduledHop hop;
      hop.port = port_index(step);
      if (step.before != nowhere) hop.previous = hop_of[step.before];
      hop.transmission = step.transmission;
      hop.behind = step.behind;
      hop.wait = step.wait;
      made.hops.push_back(hop);
    }
    problem.gates.streams.push_back(std::move(made));
    streams.push_back(stream.index);
  }

  /// What the nodes on its longest way may forward sooner, all together.
  Duration jitter_of(const ResolvedStream& stream) const {
    Duration most;
    for (const Path& path : stream.paths) {
      Duration sum;
      for (const std::uint32_t node : path)
        sum += r_.plan.nodes[node].greatest_forwarding_delay() - r_.plan.nodes[node].least_forwarding_delay();
      most = std::max(most, sum);
    }
    return most;
  }

  std::uint32_t port_index(const Step& step) {
    const auto [found, is_new] =
        ports_.emplace(std::pair(step.at->node, step.at->port), static_cast<std::uint32_t>(problem.gates.ports.size()));
    if (is_new) {
      const Duration gap = step.end.link->rate.octet_time() * models::inter_packet_gap.count;
      problem.gates.ports.push_back(
          {models::NodeIndex{step.at->node}, step.at->port,
           r_.topology.nodes[step.at->node].name + " to " + r_.topology.nodes[step.at->peer].name, gap, gap});
    }
    return found->second;
  }

  const Resolved& r_;
  const Timings& timings_;
  std::vector<std::vector<StreamAtPort>> at_;  // by stream
  std::map<std::pair<std::uint32_t, std::uint16_t>, End> ends_;
  std::map<std::uint32_t, std::size_t> members_;  // of redundant streams
  std::map<std::pair<std::uint32_t, std::uint16_t>, std::uint32_t> ports_;
};

}  // namespace

bool choose_gated_offsets(Resolved& r, Timings& timings, StreamsToGate& gated, json::Diagnostics& diagnostics) {
  OffsetProblem problem;
  problem.gates = gated.problem;
  const std::vector<std::uint32_t> choices = add_movable(problem, timings, gated.streams);
  if (choices.empty()) return true;
  const std::vector<ChosenOffset> chosen = choose_offsets(problem);
  const std::size_t errors_before = diagnostics.errors();
  report(r, timings, problem, choices, chosen, [&](const json::Place& place, const std::string& found) {
    diagnostics.error(place, "no offset found that fits",
                      {found, "fewer, shorter or rarer scheduled frames at these ports, or other paths"});
  });
  for (std::size_t u = 0; u < choices.size(); ++u) {
    for (const std::uint32_t s : problem.movable[u]) gated.problem.streams[s].release += chosen[u].offset;
    settle(r, timings, choices[u], chosen[u].offset);
  }
  // Gates hold what is early.
  for (const models::StreamIndex stream : gated.streams) timings.of_streams[stream.value].early = Duration();
  return diagnostics.errors() == errors_before;
}

void choose_other_offsets(Resolved& r, Timings& timings, json::Diagnostics& diagnostics) {
  const bool is_open =
      std::ranges::any_of(timings.of_streams, [](const FrameTiming& timing) { return timing.choice.has_value(); });
  if (!is_open) return;
  Ways ways(r, timings);
  ways.run();
  const std::vector<std::uint32_t> choices = add_movable(ways.problem, timings, ways.streams);
  const std::vector<ChosenOffset> chosen = choose_offsets(ways.problem);
  report(r, timings, ways.problem, choices, chosen, [&](const json::Place& place, const std::string& found) {
    diagnostics.warning(place, "no offset found that keeps frames apart",
                        {found, "fewer, shorter or rarer frames at these ports, or other paths"});
  });
  for (std::size_t u = 0; u < choices.size(); ++u) settle(r, timings, choices[u], chosen[u].offset);
  // Hosts that may hold a frame for a period: no phase is better than another.
  for (std::uint32_t choice = 0; choice < timings.choices.size(); ++choice) {
    const bool is_left =
        std::ranges::any_of(timings.of_streams, [&](const FrameTiming& timing) { return timing.choice == choice; });
    if (!is_left) continue;
    diagnostics.warning(place_of(r, timings.choices[choice]), "an offset that keeps no frames apart",
                        {"hosts that may hold a frame for a whole period",
                         "a quieter operating system, less jitter, or a longer period"});
    settle(r, timings, choice, Duration());
  }
}

}  // namespace takt::scenario
