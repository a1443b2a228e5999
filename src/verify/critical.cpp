#include "verify/critical.hpp"

#include <algorithm>
#include <map>

#include "models/ethernet/sizes.hpp"
#include "scenario/figures/requirement.hpp"

namespace takt::verify {

using scenario::Resolved;
using sim::Duration;

namespace {

constexpr std::int64_t parts_of_range = 8;
constexpr std::size_t most_values = 48;
constexpr Duration just = Duration::from_ps(1000);   // more than a rounding, less than an octet

scenario::Reaction reaction_to(scenario::Method method) {
  using scenario::Method;
  using scenario::Reaction;
  constexpr std::pair<Method, Reaction> reactions[] = {
      {Method::Start, Reaction::start}, {Method::Suspend, Reaction::suspend}, {Method::Resume, Reaction::resume}, {Method::Halt, Reaction::halt}};
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
    : resolved_(&resolved), variables_(variables.begin(), variables.end()), timings_(resolved.plan.streams.size()) {
  std::map<std::string_view, std::size_t> by_name;
  for (std::size_t s = 0; s < resolved.plan.streams.size(); ++s) by_name.emplace(resolved.plan.streams[s].name, s);
  for (const scenario::Stream& stream : resolved.scenario.streams) {
    Timing& timing = timings_[by_name.at(stream.name)];
    timing.phase = stream.offset.value_or(Duration());
    timing.period = stream.every ? *stream.every : stream.burst ? stream.burst->every : Duration();
  }
  for (const scenario::ResolvedProgram& program : resolved.programs) {
    if (program.has_roles()) continue;   // its members have no phases of their own
    for (std::size_t p = 0; p < program.members.size(); ++p)
      timings_[program.members[p].state.value] = {program.phases[p], program.description->cycle, {}};
    for (std::size_t d = 0; d < program.process_data.size(); ++d)
      timings_[program.stream_of(d).value] = {program.phases[program.process_data[d].from], program.description->cycle, {}};
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

std::vector<CriticalInstants::Visit> CriticalInstants::visits_of(std::size_t stream) const {
  std::vector<Visit> visits;
  const auto found = std::find_if(resolved_->streams.begin(), resolved_->streams.end(), [&](const scenario::ResolvedStream& s) { return s.index.value == stream; });
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
        after += link.rate.octet_time() * (models::preamble_and_sfd + frame).count + link.delay + resolved_->plan.nodes[path[hop + 1]].forwarding_delay;
      }
    }
  }
  return visits;
}

Duration CriticalInstants::phase_of(std::size_t stream, const Choice& choice) const {
  const Timing& timing = timings_[stream];
  Duration phase = timing.phase;
  for (const std::size_t f : timing.variables)
    if (choice.values[f] != Duration()) phase = variables_[f].kind == FreeVariable::Kind::jitter ? phase + choice.values[f] : choice.values[f];
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

std::vector<Duration> CriticalInstants::of(std::size_t f, const results::RequirementResult& requirement, const Choice& choice) const {
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
    // A reaction to one method does not depend on when another one was called.
    if (requirement.kind == results::RequirementKind::reaction && scenario::reaction_of(resolved_->requirements[*requirement.requirement].figure)->kind != reaction_to(*entry.call)) return values;
    for (const scenario::ResolvedProgram& program : resolved_->programs) {
      if (entry.program && program.name != *entry.program) continue;
      for (const scenario::ResolvedMember& each : program.participants()) {
        const Duration to_publishing = modulo(phase_of(each.state.value, choice) - entry.at, program.description->cycle);
        // Just behind a publication whose timer was quick, or slow.
        const sim::Distribution& wake_up = resolved_->plan.os_latencies[resolved_->plan.nodes[each.node.value].os_latency].wake_up;
        for (const Duration moved : {to_publishing, to_publishing + just, to_publishing + wake_up.least() + just, to_publishing + wake_up.greatest() + just})
          if (moved < variable.range) add(moved);
      }
    }
  }
  const std::vector<std::size_t> targets = streams_of(requirement);
  // A disturbing frame comes just before that of the requirement, or that of the requirement just behind a disturbing one.
  const auto meet = [&](std::size_t moved, std::size_t other, Duration shift) {
    if (moved == other || timings_[other].period == Duration()) return;
    for (const Visit& visit : visits_[moved])
      for (const Visit& theirs : visits_[other])
        if (theirs.port == visit.port && values.size() < most_values)
          for (const Duration apart : {Duration(), shift}) {
            const Duration instant = phase_of(other, choice) + theirs.after - visit.after + apart;
            if (variable.kind != FreeVariable::Kind::jitter)
              add(instant);
            else if (const Duration late = modulo(instant - (phase_of(moved, choice) - choice.values[f]), timings_[moved].period); late < variable.range)
              add(late);
          }
  };
  for (const std::size_t moved : streams_moved_by(f)) {
    if (std::find(targets.begin(), targets.end(), moved) == targets.end())
      for (const std::size_t target : targets) meet(moved, target, -just);
    else
      for (std::size_t other = 0; other < timings_.size(); ++other) meet(moved, other, just);
  }
  for (std::int64_t part = 0; part < parts_of_range; ++part) add(variable.range * part / parts_of_range);
  if (variable.kind == FreeVariable::Kind::jitter) add(variable.range - Duration::from_ps(1));
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

}  // namespace takt::verify
