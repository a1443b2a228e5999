// SPDX-License-Identifier: Apache-2.0
#include "verify/critical.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "models/ethernet/sizes.hpp"
#include "scenario/figures/requirement.hpp"

namespace takt::verify {

using scenario::Resolved;
using sim::Duration;

namespace {

constexpr std::int64_t parts_of_range = 8;
constexpr std::size_t most_values = 48;
/// More than a rounding of clocks that are not ideal, less than an octet.
constexpr Duration just_by_clocks = Duration::from_ps(1000);
constexpr Duration just_by_true_time = Duration::from_ps(1);

scenario::Reaction reaction_to(scenario::Method method) {
  using scenario::Method;
  using scenario::Reaction;
  constexpr std::pair<Method, Reaction> reactions[] = {{Method::Start, Reaction::start},
                                                       {Method::Suspend, Reaction::suspend},
                                                       {Method::Resume, Reaction::resume},
                                                       {Method::Halt, Reaction::halt}};
  for (const auto& [each, reaction] : reactions)
    if (each == method) return reaction;
  return Reaction::reset;
}

Duration modulo(Duration value, Duration range) {
  const std::int64_t rest = value.ps() % range.ps();
  return Duration::from_ps(rest < 0 ? rest + range.ps() : rest);
}

}  // namespace

CriticalInstants::CriticalInstants(const Resolved& resolved, std::span<const FreeVariable> variables)
    : resolved_(&resolved),
      variables_(variables.begin(), variables.end()),
      just_(
          std::ranges::any_of(resolved.plan.nodes, [](const models::NodePlan& node) { return node.clock.has_value(); })
              ? just_by_clocks
              : just_by_true_time),
      timings_(resolved.plan.streams.size()),
      arrivals_(resolved.plan.streams.size()) {
  std::map<std::string_view, std::size_t> by_name;
  for (std::size_t s = 0; s < resolved.plan.streams.size(); ++s) by_name.emplace(resolved.plan.streams[s].name, s);
  for (const scenario::Stream& stream : resolved.scenario.streams) {
    Timing& timing = timings_[by_name.at(stream.name)];
    timing.phase = stream.offset.value_or(Duration());
    timing.period = stream.every ? *stream.every : stream.burst ? stream.burst->every : Duration();
  }
  for (const scenario::ResolvedProgram& program : resolved.programs) {
    if (program.has_roles()) continue;  // its members have no phases of their own
    for (std::size_t p = 0; p < program.members.size(); ++p)
      timings_[program.members[p].state.value] = {program.phases[p], program.description->cycle, {}};
    for (std::size_t d = 0; d < program.process_data.size(); ++d)
      timings_[program.stream_of(d).value] = {
          program.phases[program.process_data[d].from], program.description->cycle, {}};
  }
  for (std::size_t f = 0; f < variables_.size(); ++f)
    for (const std::size_t stream : streams_moved_by(f)) timings_[stream].variables.push_back(f);
  for (std::size_t s = 0; s < timings_.size(); ++s) visits_.push_back(visits_of(s));
}

std::vector<std::size_t> CriticalInstants::streams_moved_by(std::size_t f) const {
  const FreeVariable& variable = variables_[f];
  std::vector<std::size_t> found;
  if (variable.kind == FreeVariable::Kind::talker || variable.kind == FreeVariable::Kind::jitter) {
    for (std::size_t s = 0; s < resolved_->plan.streams.size(); ++s)
      if (resolved_->plan.streams[s].name == resolved_->scenario.streams[variable.item].name) found.push_back(s);
  } else if (variable.kind == FreeVariable::Kind::publisher) {
    const scenario::ResolvedProgram& program = resolved_->programs[variable.item];
    const scenario::ResolvedMember& member = program.members[variable.participant];
    found.push_back(member.state.value);
    for (const auto& data : member.data)
      if (data) found.push_back(data->value);
  }
  return found;
}

std::vector<CriticalInstants::Visit> CriticalInstants::visits_of(std::size_t stream) {
  std::vector<Visit> visits;
  const auto found = std::find_if(resolved_->streams.begin(), resolved_->streams.end(),
                                  [&](const scenario::ResolvedStream& s) { return s.index.value == stream; });
  if (found == resolved_->streams.end()) return visits;
  const models::StreamPlan& plan = resolved_->plan.streams[stream];
  const sim::Octets frame = models::frame_length(found->largest_payload + plan.headers, plan.priority.has_value());
  for (const scenario::Path& path : found->paths) {
    Duration after;
    for (std::size_t hop = 0; hop + 1 < path.size(); ++hop) {
      const std::uint16_t port = port_out(resolved_->topology, path, hop);
      visits.push_back({static_cast<std::uint64_t>(path[hop]) << 16 | port, after});
      for (const models::LinkPlan& link : resolved_->plan.links) {
        const bool forth = link.a.node.value == path[hop] && link.a.port == port;
        if (!forth && !(link.b.node.value == path[hop] && link.b.port == port)) continue;
        after += link.rate.octet_time() * (models::preamble_and_sfd + frame).count + link.delay +
                 resolved_->plan.nodes[path[hop + 1]].forwarding_delay;
      }
    }
    if (path.size() > 1) arrivals_[stream].emplace(static_cast<std::uint32_t>(path.back()), after);
  }
  return visits;
}

Duration CriticalInstants::phase_of(std::size_t stream, const Choice& choice) const {
  const Timing& timing = timings_[stream];
  Duration phase = timing.phase;
  for (const std::size_t f : timing.variables)
    if (choice.values[f] != Duration())
      phase = variables_[f].kind == FreeVariable::Kind::jitter ? phase + choice.values[f] : choice.values[f];
  return phase;
}

std::vector<std::size_t> CriticalInstants::streams_of(const results::RequirementResult& requirement) const {
  using Kind = results::RequirementKind;
  std::vector<std::size_t> found;
  if (requirement.taken_as == Kind::reaction || requirement.taken_as == Kind::invariants) {
    for (const scenario::ResolvedProgram& program : resolved_->programs)
      if (requirement.subject.empty() || program.name == requirement.subject)
        for (const scenario::ResolvedMember& each : program.participants()) found.push_back(each.state.value);
  } else if (requirement.taken_as != Kind::sync && requirement.taken_as != Kind::clocks) {
    for (std::size_t s = 0; s < resolved_->plan.streams.size(); ++s)
      if (requirement.subject == "*" || resolved_->plan.streams[s].name == requirement.subject) found.push_back(s);
  }
  return found;
}

/// Who sends or hears the streams of the requirement. Others disturb them by when they send, which is free already.
bool CriticalInstants::matters(const FreeVariable& latency, const results::RequirementResult& requirement) const {
  const std::vector<std::size_t> streams = streams_of(requirement);
  if (latency.kind == FreeVariable::Kind::generator_latency || streams.empty()) return true;
  const auto node = resolved_->topology.find(resolved_->scenario.network.nodes[latency.item].first);
  return std::any_of(streams.begin(), streams.end(), [&](std::size_t stream) {
    const models::StreamPlan& plan = resolved_->plan.streams[stream];
    if (latency.latency != FreeVariable::Latency::receive) return plan.talker.value == *node;
    return std::find(plan.listeners.begin(), plan.listeners.end(), models::NodeIndex{*node}) != plan.listeners.end();
  });
}

bool CriticalInstants::is_called(const scenario::ScriptEntry& entry,
                                 const results::RequirementResult& requirement) const {
  if (requirement.taken_as != results::RequirementKind::reaction || !requirement.requirement) return true;
  // A reaction to one method does not depend on when another one was called.
  const auto asked = scenario::reaction_of(resolved_->requirements[*requirement.requirement].figure);
  return !asked || asked->kind == reaction_to(*entry.call);
}

Duration CriticalInstants::time_to(std::size_t stream, models::NodeIndex listener) const {
  const models::StreamPlan& plan = resolved_->plan.streams[stream];
  const auto latencies = [&](models::NodeIndex node) -> const models::OsLatency& {
    return resolved_->plan.os_latencies[resolved_->plan.nodes[node.value].os_latency];
  };
  const auto way = arrivals_[stream].find(listener.value);
  const Duration network = way == arrivals_[stream].end() ? Duration() : way->second;
  return latencies(plan.talker).wake_up.greatest() + latencies(plan.talker).transmit.greatest() + network +
         latencies(listener).receive.greatest();
}

std::optional<std::size_t> CriticalInstants::phase_variable(std::size_t program, std::size_t participant) const {
  for (std::size_t f = 0; f < variables_.size(); ++f)
    if (variables_[f].kind == FreeVariable::Kind::publisher && variables_[f].item == program &&
        variables_[f].participant == participant)
      return f;
  return std::nullopt;
}

void CriticalInstants::put_calls_behind_publications(const results::RequirementResult& requirement, Choice& choice,
                                                     bool slowly) const {
  for (std::size_t f = 0; f < variables_.size(); ++f) {
    if (variables_[f].kind != FreeVariable::Kind::call) continue;
    const scenario::ScriptEntry& entry = resolved_->scenario.script[variables_[f].item];
    if (!is_called(entry, requirement)) continue;
    for (const scenario::ResolvedProgram& program : resolved_->programs) {
      if (program.has_roles() || (entry.program && program.name != *entry.program)) continue;
      const auto on =
          entry.on ? std::ranges::find(program.participant_names, *entry.on) : program.participant_names.begin();
      if (on == program.participant_names.end()) continue;
      const scenario::ResolvedMember& member =
          program.members[static_cast<std::size_t>(on - program.participant_names.begin())];
      const sim::Distribution& wake_up =
          resolved_->plan.os_latencies[resolved_->plan.nodes[member.node.value].os_latency].wake_up;
      const Duration value = modulo(
          phase_of(member.state.value, choice) + (slowly ? wake_up.greatest() : wake_up.least()) + just_ - entry.at,
          program.description->cycle);
      if (value < variables_[f].range) choice.values[f] = value;
      break;
    }
  }
}

void CriticalInstants::put_publications_before_words(std::size_t number, std::size_t first, Choice& choice) const {
  const scenario::ResolvedProgram& program = resolved_->programs[number];
  const auto put = [&](std::size_t participant, std::size_t speaker) {
    const std::optional<std::size_t> f = phase_variable(number, participant);
    if (!f) return;
    const models::NodeIndex node = program.members[participant].node;
    const std::size_t word = program.members[speaker].state.value;
    const Duration own = resolved_->plan.os_latencies[resolved_->plan.nodes[node.value].os_latency].wake_up.greatest();
    choice.values[*f] = modulo(phase_of(word, choice) + time_to(word, node) - own - just_, variables_[*f].range);
  };
  if (first != 0) put(0, first);
  for (std::size_t p = 1; p < program.participants().size(); ++p)
    if (p != first) put(p, 0);
}

std::vector<std::size_t> CriticalInstants::variables_for(const results::RequirementResult& requirement) const {
  std::vector<std::size_t> near = streams_of(requirement);
  std::vector<bool> is_near(timings_.size(), near.empty());
  std::set<std::uint64_t> ports;
  for (int distance = 0; distance < 3; ++distance) {
    for (std::size_t s = 0; s < timings_.size(); ++s)
      if (distance == 0 ? std::ranges::find(near, s) != near.end()
                        : !is_near[s] && std::ranges::any_of(visits_[s], [&](const Visit& visit) {
                            return ports.contains(visit.port);
                          }))
        is_near[s] = true;
    for (std::size_t s = 0; s < timings_.size(); ++s)
      if (is_near[s])
        for (const Visit& visit : visits_[s]) ports.insert(visit.port);
  }
  std::vector<std::size_t> found;
  for (std::size_t f = 0; f < variables_.size(); ++f) {
    const FreeVariable& variable = variables_[f];
    if (variable.is_latency() && !matters(variable, requirement)) continue;
    if (variable.kind == FreeVariable::Kind::call && !is_called(resolved_->scenario.script[variable.item], requirement))
      continue;
    const std::vector<std::size_t> moved = streams_moved_by(f);
    if (!moved.empty() && std::ranges::none_of(moved, [&](std::size_t s) { return is_near[s]; })) continue;
    found.push_back(f);
  }
  return found;
}

std::vector<Duration> CriticalInstants::of_meetings(std::size_t f, const Choice& choice,
                                                    std::span<const MeetingLog::Visit> met) const {
  return meetings_in({}, f, choice, met);
}

CriticalInstants::Window CriticalInstants::around_slowest(std::uint32_t stream,
                                                          std::span<const MeetingLog::Visit> met) {
  Window window;
  Duration longest = Duration::from_ps(-1);
  for (const MeetingLog::Visit& visit : met)
    if (visit.stream == stream && visit.started != sim::TrueTime::never() && visit.started - visit.produced > longest) {
      longest = visit.started - visit.produced;
      window = {stream, visit.produced, visit.produced - longest, visit.started};
    }
  return window;
}

std::vector<Duration> CriticalInstants::meetings_in(const Window& window, std::size_t f, const Choice& choice,
                                                    std::span<const MeetingLog::Visit> met) const {
  const FreeVariable& variable = variables_[f];
  std::vector<Duration> values;
  if (variable.kind != FreeVariable::Kind::talker && variable.kind != FreeVariable::Kind::publisher) return values;
  for (const std::size_t moved : streams_moved_by(f)) {
    std::map<std::uint32_t, std::set<Duration>> delays;  // by port, of its own frames
    for (const MeetingLog::Visit& visit : met)
      if (visit.stream == moved) delays[visit.port].insert(visit.came - visit.produced);
    for (const MeetingLog::Visit& visit : met) {
      if (visit.stream == moved || (window.stream && visit.stream != *window.stream) ||
          (window.produced && visit.produced != *window.produced))
        continue;
      const auto here = delays.find(visit.port);
      if (here == delays.end()) continue;
      for (const sim::TrueTime instant : {visit.came, visit.started}) {
        if (instant == sim::TrueTime::never() || instant < window.begin || instant > window.end) continue;
        for (const Duration delay : here->second)
          for (const Duration apart : {-just_, just_})
            values.push_back(modulo(instant.since_start() - delay + apart, variable.range));
      }
    }
  }
  std::ranges::sort(values);
  values.erase(std::unique(values.begin(), values.end()), values.end());
  std::erase(values, choice.values[f]);
  return values;
}

std::vector<Duration> CriticalInstants::of(std::size_t f, const results::RequirementResult& requirement,
                                           const Choice& choice, std::span<const MeetingLog::Visit> met,
                                           std::size_t most) const {
  const FreeVariable& variable = variables_[f];
  std::vector<Duration> values{choice.values[f]};
  const auto add = [&](Duration value) { values.push_back(modulo(value, variable.range)); };
  if (variable.is_latency()) {
    if (matters(variable, requirement)) values = {by_chance, always_least, always_greatest, either_end};
    return values;
  }
  if (variable.kind == FreeVariable::Kind::frequency) return {by_chance, always_least, always_greatest};
  if (variable.kind == FreeVariable::Kind::call) {
    const scenario::ScriptEntry& entry = resolved_->scenario.script[variable.item];
    if (!is_called(entry, requirement)) return values;
    for (const scenario::ResolvedProgram& program : resolved_->programs) {
      if (entry.program && program.name != *entry.program) continue;
      for (const scenario::ResolvedMember& each : program.participants()) {
        const Duration to_publishing =
            modulo(phase_of(each.state.value, choice) - entry.at, program.description->cycle);
        // Just behind a publication whose timer was quick, or slow.
        const sim::Distribution& wake_up =
            resolved_->plan.os_latencies[resolved_->plan.nodes[each.node.value].os_latency].wake_up;
        for (const Duration moved : {to_publishing, to_publishing + just_, to_publishing + wake_up.least() + just_,
                                     to_publishing + wake_up.greatest() + just_})
          if (moved < variable.range) add(moved);
      }
    }
  }
  const std::vector<std::size_t> targets = streams_of(requirement);
  Window slowest;
  const auto add_meetings = [&] {
    const std::vector<Duration> meetings = meetings_in(slowest, f, choice, met);
    values.insert(values.end(), meetings.begin(),
                  meetings.begin() + static_cast<std::ptrdiff_t>(std::min(meetings.size(), most_values)));
  };
  const auto add_meetings_of_others = [&] {
    slowest.stream.reset();
    slowest.produced.reset();
    add_meetings();
  };
  const std::vector<std::size_t> all_moved = streams_moved_by(f);
  // The likeliest first: a frame meets the slowest one itself, or that one others.
  if (!met.empty() && !targets.empty()) {
    slowest = around_slowest(static_cast<std::uint32_t>(targets.front()), met);
    const bool is_own = std::ranges::find(all_moved, targets.front()) != all_moved.end();
    if (is_own)
      add_meetings_of_others();
    else
      add_meetings();
  }
  const std::size_t with_slowest = values.size();
  // A disturbing frame comes just before that of the requirement, or that of the requirement just behind a disturbing
  // one.
  const auto meet = [&](std::size_t moved, std::size_t other, Duration shift) {
    if (moved == other || timings_[other].period == Duration()) return;
    for (const Visit& visit : visits_[moved])
      for (const Visit& theirs : visits_[other])
        if (theirs.port == visit.port && values.size() - with_slowest < most_values)
          for (const Duration apart : {Duration(), shift}) {
            const Duration instant = phase_of(other, choice) + theirs.after - visit.after + apart;
            if (variable.kind != FreeVariable::Kind::jitter)
              add(instant);
            else if (const Duration late =
                         modulo(instant - (phase_of(moved, choice) - choice.values[f]), timings_[moved].period);
                     late < variable.range)
              add(late);
          }
  };
  for (const std::size_t moved : all_moved) {
    if (std::find(targets.begin(), targets.end(), moved) == targets.end())
      for (const std::size_t target : targets) meet(moved, target, -just_);
    else
      for (std::size_t other = 0; other < timings_.size(); ++other) meet(moved, other, just_);
  }
  if (variable.kind == FreeVariable::Kind::publisher) {
    const scenario::ResolvedMember& mine = resolved_->programs[variable.item].members[variable.participant];
    const sim::Distribution& wake_up =
        resolved_->plan.os_latencies[resolved_->plan.nodes[mine.node.value].os_latency].wake_up;
    for (const scenario::ResolvedMember& other : resolved_->programs[variable.item].participants())
      if (arrivals_[other.state.value].contains(mine.node.value))
        add(phase_of(other.state.value, choice) + time_to(other.state.value, mine.node) - wake_up.greatest() - just_);
  }
  for (std::int64_t part = 0; part < parts_of_range; ++part) add(variable.range * part / parts_of_range);
  if (variable.kind == FreeVariable::Kind::jitter) add(variable.range - Duration::from_ps(1));
  if (slowest.stream) add_meetings_of_others();  // meanwhile, which the slowest one may have waited for
  std::set<Duration> seen;
  std::erase_if(values, [&](Duration value) { return !seen.insert(value).second; });
  if (values.size() > most) values.resize(most);
  std::sort(values.begin(), values.end());
  return values;
}

}  // namespace takt::verify
