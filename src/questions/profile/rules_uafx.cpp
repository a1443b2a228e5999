// SPDX-License-Identifier: Apache-2.0
// OPC 10000-82, the network of OPC UA FX: PCP 4 and DSCP 46 for PubSub, 5 for gPTP and LLDP, 2 for management; 3, 6 and
// 7 are reserved.
#include <map>
#include <set>

#include "profile/common.hpp"
#include "profile/rules.hpp"
#include "scenario/resolve/stream_at_port.hpp"

namespace takt::profile {
namespace {

using scenario::Resolved;

constexpr models::Priority pubsub_priority = 4;
constexpr unsigned pubsub_dscp = 46;

bool is_reserved(models::Priority priority) { return priority == 3 || priority == 6 || priority == 7; }

/// What Programs send, and topics of OPC UA.
std::set<std::uint32_t> pubsub_streams(const Resolved& r) {
  std::set<std::uint32_t> streams;
  for (const scenario::ResolvedStream& stream : r.streams)
    if (stream.of_program) streams.insert(stream.index.value);
  for (const scenario::ResolvedApplication& application : r.applications)
    for (const scenario::ResolvedThread& thread : application.threads)
      if (r.topics[thread.topic].description->protocol == plant::Protocol::opc_ua)
        for (const scenario::ResolvedInput& input : thread.inputs) streams.insert(input.stream.value);
  return streams;
}

/// Streams that are told apart by nothing else stand together.
using Groups = std::map<std::pair<std::optional<models::Priority>, bool>, std::vector<std::string>>;

Groups streams_by_priority(const Resolved& r, bool of_pubsub) {
  Groups groups;
  const std::set<std::uint32_t> pubsub = pubsub_streams(r);
  for (const scenario::ResolvedStream& stream : r.streams) {
    const models::StreamPlan& plan = r.plan.streams[stream.index.value];
    if (pubsub.contains(stream.index.value) != of_pubsub) continue;
    groups[{plan.priority, plan.headers.count > 0}].push_back(plan.name);
  }
  return groups;
}

std::string tag_text(std::optional<models::Priority> priority) {
  return priority ? "PCP " + std::to_string(*priority) : "no tag";
}

void look_at_pubsub(const Resolved& r, Found& found) {
  for (const auto& [key, names] : streams_by_priority(r, true))
    found.judge(key.first == pubsub_priority,
                tag_text(key.first) + " of " + some_of(names) +
                    (key.first == models::Priority{6} ? " (the default of a Program: the class below gPTP's)" : ""));
  if (found.entries.empty()) found.met("no messages of Programs or topics");
}

void look_at_dscp(const Resolved& r, Found& found) {
  for (const auto& [key, names] : streams_by_priority(r, true)) {
    if (!key.second) continue;
    const unsigned dscp = key.first.value_or(0) * 8U;  // as frames have it
    found.judge(dscp == pubsub_dscp,
                "DSCP " + std::to_string(dscp) + " (the class selector of the priority) of " + some_of(names));
  }
  if (found.entries.empty()) found.met("no PubSub over UDP");
}

void look_at_reserved(const Resolved& r, Found& found) {
  for (const auto& [key, names] : streams_by_priority(r, false))
    if (key.first && is_reserved(*key.first)) found.missed(tag_text(key.first) + " of " + some_of(names));
  if (found.entries.empty()) found.met("none");
}

void look_at_priority_of_gptp(const Resolved& r, Found& found) {
  if (!r.scenario.clocks.gptp) return found.unknown("no gPTP");
  found.judge(
      scenario::priority_of_gptp == 5,
      "priority " + std::to_string(scenario::priority_of_gptp) + ", which takt gives to untagged messages of gPTP",
      r.scenario.clocks.gptp->where.place());
}

void look_at_synchronisation(const Resolved& r, Found& found) {
  if (r.scenario.clocks.gptp) return found.met("gPTP", r.scenario.clocks.gptp->where.place());
  if (clocks_of(r).empty()) return found.unknown("ideal clocks");
  found.missed("clocks that nothing keeps together", r.scenario.clocks.where.place());
}

constexpr Rule table_of_uafx[] = {
    {"OPC 10000-82, priorities", "Messages of Programs and topics", "PCP 4", look_at_pubsub},
    {"OPC 10000-82, priorities", "PubSub over UDP", "DSCP 46", look_at_dscp},
    {"OPC 10000-82, priorities", "Other streams in reserved priorities", "none in 3, 6 and 7", look_at_reserved},
    {"OPC 10000-82, priorities", "gPTP", "priority 5", look_at_priority_of_gptp},
    {"OPC 10000-82, synchronisation", "Clocks", "IEEE 802.1AS", look_at_synchronisation},
};

}  // namespace

std::span<const Rule> rules_of_uafx() { return table_of_uafx; }

}  // namespace takt::profile
