// SPDX-License-Identifier: Apache-2.0
// What comes when the run is over, what is said twice, and what belongs to something that is not there: streams,
// script, clocks, requirements.
#include <algorithm>
#include <set>
#include <tuple>
#include <utility>

#include "scenario/idle/usage.hpp"

namespace takt::scenario {
namespace {

/// Entries of a list that say what an earlier one says.
template <class Entry, class WhereOf>
void report_duplicates(const std::vector<Entry>& entries, WhereOf&& where_of, const char* message,
                       json::Diagnostics& diagnostics) {
  constexpr std::size_t most = 2'000;  // of longer lists the beginning is compared
  for (std::size_t i = 1; i < std::min(most, entries.size()); ++i)
    for (std::size_t other = 0; other < i; ++other)
      if (entries[other] == entries[i]) {
        warn_once(diagnostics, where_of(entries[i]).place(), message,
                  {"the same as the entry with number " + std::to_string(other), "it once"});
        break;
      }
}

/// Whether the talker queues the stream otherwise than by priority 0.
bool tells_apart(const Usage& usage, const Stream& stream) {
  return std::any_of(usage.streams().begin(), usage.streams().end(), [&](const StreamAtPort& at) {
    const models::StreamPlan& plan = usage.plan(at);
    if (plan.name != stream.name || plan.talker.value != at.node) return false;
    const auto& class_of = usage.port(at.node, at.port).config->traffic_class_of_priority;
    return class_of[*stream.host_priority] != class_of[0];
  });
}

bool is_of_run(const Scenario& scenario) { return scenario.duration > Duration(); }

}  // namespace

void report_ineffective_streams(const Usage& usage, json::Diagnostics& diagnostics) {
  const Resolved& r = usage.resolved();
  for (const Stream& stream : r.scenario.streams) {
    if (stream.offset && usage.is_after_the_end(*stream.offset))
      warn_once(diagnostics, stream.where.at("offset"), "a stream that begins after the end of the simulation",
                {json::to_text(*stream.offset), "less than " + json::to_text(r.scenario.duration)});
    if (stream.until && usage.is_after_the_end(*stream.until))
      warn_once(diagnostics, stream.where.at("until"), "a stream that ends after the end of the simulation",
                {json::to_text(*stream.until), "less than " + json::to_text(r.scenario.duration)});
    if (stream.route)
      warn_once(diagnostics, stream.where.at("route"), "a route that nobody has searched for",
                {"\"auto\", until then the shortest path",
                 "takt schedule SCENARIO --out FILE, which writes a \"path\", and then FILE"});
    if (stream.host_priority && !tells_apart(usage, stream))
      warn_once(diagnostics, stream.where.at("host_priority"), "a priority that makes no difference",
                {std::to_string(*stream.host_priority) + ", whose class at " + json::quote(stream.from) +
                     " is that of priority 0",
                 "a priority of another class"});
    if (stream.burst && stream.burst->frames == 1 && stream.burst->spacing > Duration())
      warn_once(diagnostics, stream.where.at("burst"), "a spacing in bursts of one frame",
                {json::to_text(stream.burst->spacing), "several \"frames\""});
    if (!stream.redundancy) continue;
    const Redundancy& redundancy = *stream.redundancy;
    if (redundancy.algorithm == Recovery::match && redundancy.where.has("history"))
      warn_once(diagnostics, redundancy.where.at("history"), "a history that nothing looks at",
                {"\"algorithm\": \"match\", which knows the last number only", "\"vector\""});
    if (redundancy.latent_errors && usage.is_after_the_end(redundancy.latent_errors->period))
      warn_once(diagnostics, redundancy.latent_errors->where.at("period"),
                "a test for latent errors after the end of the simulation",
                {json::to_text(redundancy.latent_errors->period), "less than " + json::to_text(r.scenario.duration)});
  }
  for (const models::TalkerPlan& talker : r.plan.talkers) {
    const auto* const trace = std::get_if<models::TraceSchedule>(&talker.schedule);
    if (trace == nullptr || trace->entries.empty() ||
        !usage.is_after_the_end(trace->entries.front().time.since_start()))
      continue;
    warn_once(
        diagnostics, r.streams[talker.stream.value].where.at("trace"),
        "a trace that begins after the end of the simulation",
        {json::to_text(trace->entries.front().time.since_start()), "less than " + json::to_text(r.scenario.duration)});
  }
}

void report_ineffective_script(const Usage& usage, json::Diagnostics& diagnostics) {
  const Resolved& r = usage.resolved();
  if (!is_of_run(r.scenario)) return;
  report_duplicates(
      r.scenario.script, [](const ScriptEntry& entry) { return entry.where; }, "an action twice", diagnostics);
  for (const ScriptEntry& entry : r.scenario.script)
    if (usage.is_after_the_end(entry.at))
      warn_once(diagnostics, entry.where.at("at"), "after the end of the simulation",
                {json::to_text(entry.at), "less than " + json::to_text(r.scenario.duration)});
  std::set<std::string_view> needed;
  for (const Program& program : r.scenario.programs) {
    for (const Role& role : program.roles) needed.insert(role.skill);
    const bool is_started =
        program.within ||
        std::any_of(r.scenario.script.begin(), r.scenario.script.end(), [&](const ScriptEntry& entry) {
          return entry.call == Method::Start && entry.program == program.name;
        });
    if (!is_started)
      warn_once(diagnostics, program.where.at("name"), "a program that nobody starts",
                {json::quote(program.name), "\"call\": \"Start\" in \"script\""});
  }
  for (const TopologyNode& node : r.topology.nodes) {
    const EndStation* const host = end_station_of(node.description);
    if (host == nullptr) continue;
    for (std::size_t i = 0; i < host->offers.size(); ++i)
      if (!needed.contains(host->offers[i]))
        warn_once(diagnostics, node.where.at("offers", i), "a skill that no role needs",
                  {json::quote(host->offers[i]), "the \"skill\" of a role of a program"});
    const auto replies = [&](const ResolvedProgram& program) {
      return !program.replies.empty() && std::ranges::any_of(program.members, [&](const ResolvedMember& each) {
        return r.topology.nodes[each.node.value].name == node.name;
      });
    };
    const auto secures = [&](const ResolvedProgram& program) {
      return program.description->security && std::ranges::any_of(program.members, [&](const ResolvedMember& each) {
               return r.topology.nodes[each.node.value].name == node.name;
             });
    };
    if (host->cryptography && std::ranges::none_of(r.programs, secures))
      warn_once(diagnostics, node.where.at("cryptography"), "times of cryptography without secured messages",
                {json::quote(node.name) + " is in no program with \"security\"", "\"security\" of a program"});
    if (host->processing && std::none_of(r.programs.begin(), r.programs.end(), replies))
      warn_once(diagnostics, node.where.at("processing"), "a time of processing without replies",
                {json::quote(node.name) + " is in no program with \"replies\"", "\"replies\""});
  }
}

void report_ineffective_clocks(const Usage& usage, json::Diagnostics& diagnostics) {
  const Resolved& r = usage.resolved();
  const Clocks& clocks = r.scenario.clocks;
  const auto tell = [&](const Clock& clock) {
    const Clock none;
    const std::pair<const char*, bool> said[] = {{"offset", clock.offset != none.offset},
                                                 {"drift", clock.drift != none.drift},
                                                 {"temperature", clock.temperature.has_value()},
                                                 {"walk", clock.walk.has_value()},
                                                 {"table", !clock.table.empty()},
                                                 {"update", clock.update != none.update}};
    for (const auto& [key, is_said] : said)
      if (clock.ideal && is_said)
        warn_once(diagnostics, clock.where.at(key), "an oscillator of an ideal clock",
                  {"\"ideal\": true beside it", "one of them"});
    for (std::size_t i = 0; i < clock.table.size(); ++i)
      if (usage.is_after_the_end(clock.table[i].at))
        warn_once(diagnostics, clock.where.at("table", i), "after the end of the simulation",
                  {json::to_text(clock.table[i].at), "less than " + json::to_text(r.scenario.duration)});
  };
  if (clocks.all) tell(*clocks.all);
  for (const auto& [name, clock] : clocks.nodes) tell(clock);
  if (clocks.all && clocks.nodes.size() == r.topology.nodes.size())
    warn_once(diagnostics, clocks.where.at("all"), "a clock for no node",
              {"all nodes have one of their own in \"nodes\"", "a node without"});
  if (!clocks.gptp) return;
  const std::set<std::string_view> without(clocks.gptp->without.begin(), clocks.gptp->without.end());
  const auto report_nodes = [&](const json::NameMap<GptpNode>& nodes) {
    for (const auto& [name, node] : nodes) {
      if (without.contains(name))
        warn_once(diagnostics, node.where.place(), "gPTP of a node without it",
                  {json::quote(name) + ", which is in \"without\"", "one of them"});
    }
  };
  report_nodes(clocks.gptp->nodes);
  for (const GptpDomain& domain : clocks.gptp->domains) report_nodes(domain.nodes);
}

void report_ineffective_requirements(const Usage& usage, json::Diagnostics& diagnostics) {
  const Scenario& scenario = usage.resolved().scenario;
  if (!is_of_run(scenario)) return;
  report_duplicates(
      scenario.require, [](const Requirement& requirement) { return requirement.where; }, "a requirement twice",
      diagnostics);
  for (const Requirement& requirement : scenario.require)
    if (requirement.after && *requirement.after > Duration() && usage.is_after_the_end(*requirement.after))
      warn_once(diagnostics, requirement.where.at("after"), "a requirement that begins after the end of the simulation",
                {json::to_text(*requirement.after), "less than " + json::to_text(scenario.duration)});
  if (scenario.warm_up > Duration() && usage.is_after_the_end(scenario.warm_up))
    warn_once(diagnostics, scenario.where.at("warm_up"), "a warm-up that lasts beyond the end of the simulation",
              {json::to_text(scenario.warm_up), "less than " + json::to_text(scenario.duration)});
}

}  // namespace takt::scenario
