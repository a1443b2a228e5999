// SPDX-License-Identifier: Apache-2.0
#include "scenario/resolve/stream_builder.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "models/ethernet/sizes.hpp"
#include "scenario/description/limits.hpp"
#include "scenario/topology/filtering.hpp"
#include "scenario/topology/named_path.hpp"

namespace takt::scenario {

std::optional<std::uint32_t> StreamBuilder::host(const std::string& name, const json::Place& place) {
  const auto node = r_.topology.find(name);
  if (!node) {
    report_unknown_node(r_.topology, name, place, "the name of a host or station", diagnostics_);
    return std::nullopt;
  }
  if (!r_.topology.nodes[*node].is_end_station()) {
    diagnostics_.error_unless(r_.topology.nodes[*node].is_of_unknown_kind, place, "not a host",
                              {"the switch " + json::quote(name), "the name of a host or station"});
    return std::nullopt;
  }
  return node;
}

void StreamBuilder::lay_unicast_paths() {
  std::vector<Router::Ends> wanted;
  for (const Stream& stream : r_.scenario.streams) {
    if (stream.path || stream.redundancy || stream.to.names.size() != 1) continue;
    const auto from = r_.topology.find(stream.from);
    const auto to = r_.topology.find(stream.to.names.front());
    if (from && to && *from != *to) wanted.push_back({*from, *to});
  }
  router_.lay_ahead(std::move(wanted));
}

std::optional<models::StreamIndex> StreamBuilder::add(const NewStream& wanted) {
  const std::size_t errors_before = diagnostics_.errors();
  check_size(wanted);
  if (!wanted.from || wanted.to.empty()) {
    check_names_of_paths(wanted);
    return std::nullopt;
  }
  std::set<std::uint32_t> receivers;
  for (const auto& [to, place] : wanted.to) {
    if (to == *wanted.from)
      diagnostics_.error(place, "a stream to its own sender",
                         {json::quote(r_.topology.nodes[to].name), "another host"});
    if (!receivers.insert(to).second)
      diagnostics_.error(place, "a receiver twice", {json::quote(r_.topology.nodes[to].name), "each receiver once"});
  }
  if (diagnostics_.errors() != errors_before) return std::nullopt;
  std::optional<MemberPaths> members;
  if (wanted.redundancy != nullptr) members = member_paths(wanted);
  std::vector<Path> paths = members                        ? members->paths
                            : wanted.redundancy != nullptr ? std::vector<Path>{}
                                                           : paths_of(wanted);
  if (diagnostics_.errors() == errors_before) check_size(wanted, paths);
  if (diagnostics_.errors() != errors_before) return std::nullopt;

  for (const Path& path : paths) path_nodes_ += path.size();
  if (path_nodes_ > most_path_nodes) {
    diagnostics_.error(wanted.where.place(), "too many nodes on all paths together",
                       {"more with this stream", "at most " + std::to_string(most_path_nodes)});
    return std::nullopt;
  }

  const bool is_on_a_way = std::ranges::any_of(
      wanted.to, [&](const auto& receiver) { return way_between(wanted, receiver.first).has_value(); });
  const bool is_group = wanted.to.size() > 1 || wanted.is_group || wanted.path != nullptr || is_on_a_way || members ||
                        identified_.contains(wanted.name);
  const models::AddressIndex address = is_group ? new_group() : models::AddressIndex{wanted.to.front().first};
  models::StreamPlan plan;
  plan.name = wanted.name;
  plan.talker = models::NodeIndex{*wanted.from};
  plan.destination = address;
  plan.vlan = wanted.vlan;
  plan.priority = wanted.priority;
  plan.headers = wanted.headers;
  plan.ether_type = wanted.ether_type;
  plan.udp_port = wanted.udp_port;
  plan.udp_source_port = wanted.udp_source_port;
  plan.ip_group = wanted.ip_group;
  for (const auto& [to, place] : wanted.to) plan.listeners.push_back(models::NodeIndex{to});
  if (!members)
    for (const Path& path : paths) add_filtering(path, wanted.vlan, address);

  const models::StreamIndex index{static_cast<std::uint32_t>(r_.plan.streams.size())};
  r_.plan.streams.push_back(std::move(plan));
  r_.streams.push_back({index,
                        std::move(paths),
                        {},
                        wanted.where,
                        wanted.of_program,
                        wanted.payload,
                        wanted.path == nullptr && !is_on_a_way && !members});
  if (members) add_members(wanted, *members, index);
  return index;
}

/// Where ends are missing, paths cannot be laid, but what they name is there or not.
void StreamBuilder::check_names_of_paths(const NewStream& wanted) {
  const auto check = [&](const std::vector<std::string>& names, const json::Place& place) {
    for (std::size_t i = 0; i < names.size(); ++i) {
      json::Place here = place;
      here.pointer += json::pointer_step(i);
      if (const std::string_view name = step_named(names[i]).node; !r_.topology.find(name))
        report_unknown_node(r_.topology, name, std::move(here), "the name of a node", diagnostics_);
    }
  };
  if (wanted.path != nullptr) check(*wanted.path, wanted.where.at("path"));
  if (wanted.redundancy == nullptr || !wanted.redundancy->paths) return;
  for (std::size_t i = 0; i < wanted.redundancy->paths->size(); ++i)
    check((*wanted.redundancy->paths)[i], wanted.redundancy->where.at("paths", i));
}

json::Place StreamBuilder::place_of_size(const NewStream& wanted) const {
  return wanted.where.at(wanted.of_program ? "fields" : "payload");
}

/// Whether some node lets frames of that length pass.
bool StreamBuilder::check_size(const NewStream& wanted) {
  const Octets msdu = wanted.headers + wanted.payload;
  Octets most = models::maximum_msdu;
  if (msdu > most && !wanted.of_program)
    for (const TopologyNode& node : r_.topology.nodes) most = std::max(most, node.mtu);
  if (msdu <= most) return true;
  std::string expected = "at most " + std::to_string(most.count) + " with all headers";
  if (most < models::largest_msdu && !wanted.of_program)
    expected += ", or jumbo frames, by \"mtu\" of \"network\" or of each node on the path";
  // Without IP and UDP it might fit.
  diagnostics_.error_unless(diagnostics_.is_refused(wanted.where.at("encapsulation")), place_of_size(wanted),
                            "more than one frame",
                            {std::to_string(msdu.count) + " octets after the EtherType", std::move(expected)});
  return false;
}

/// Whether each node on the paths does, and each to which rerouting may lead the frames.
void StreamBuilder::check_size(const NewStream& wanted, const std::vector<Path>& paths) {
  const Octets msdu = wanted.headers + wanted.payload;
  if (msdu <= models::maximum_msdu) return;
  const auto refuse = [&](const TopologyNode& node, const std::string& why) {
    diagnostics_.error(place_of_size(wanted), "longer than the MTU of a node " + why,
                       {std::to_string(msdu.count) + " octets after the EtherType; " + json::quote(node.name) +
                            " passes " + std::to_string(node.mtu.count),
                        "at most that with all headers, or \"mtu\": \"" + std::to_string(msdu.count) + "B\" of " +
                            json::quote(node.name)});
  };
  for (const Path& path : paths)
    for (const std::uint32_t node : path)
      if (r_.topology.nodes[node].mtu < msdu) return refuse(r_.topology.nodes[node], "on its path");
  if (!r_.scenario.rerouting) return;
  for (const TopologyNode& node : r_.topology.nodes)
    if (node.forwards() && node.mtu < msdu) return refuse(node, "that rerouting may lead it over");
}

std::vector<Path> StreamBuilder::paths_of(const NewStream& wanted) {
  std::vector<Path> paths;
  if (wanted.path != nullptr) {
    if (auto path = explicit_path(wanted)) paths.push_back(std::move(*path));
    return paths;
  }
  for (const auto& [to, place] : wanted.to) {
    auto path = way_between(wanted, to);
    if (!path) path = wanted.to.size() == 1 ? router_.to_host(*wanted.from, to) : router_.from_host(*wanted.from, to);
    if (path)
      paths.push_back(std::move(*path));
    else
      diagnostics_.error_unless(!r_.topology.has_all_links, place, "no path",
                                {json::quote(r_.topology.nodes[to].name) + " cannot be reached from " +
                                     json::quote(r_.topology.nodes[*wanted.from].name),
                                 "links that join them over switches"});
  }
  if (wanted.ways != nullptr) check_tree(wanted, paths);
  return paths;
}

std::optional<Path> StreamBuilder::way_between(const NewStream& wanted, std::uint32_t to) const {
  if (wanted.ways == nullptr) return std::nullopt;
  for (const std::vector<std::string>& names : *wanted.ways) {
    Path path = path_named(r_.topology, names);
    if (path.front() == to && path.back() == *wanted.from) path = reversed(r_.topology, path);
    if (path.front() == *wanted.from && path.back() == to) return path;
  }
  return std::nullopt;
}

/// Frames to several receivers are copied where their ways part; ways that meet again would bring copies.
void StreamBuilder::check_tree(const NewStream& wanted, const std::vector<Path>& paths) {
  std::map<std::uint32_t, std::uint32_t> before;
  for (const Path& path : paths)
    for (std::size_t i = 1; i < path.size(); ++i) {
      const auto [known, is_new] = before.try_emplace(path[i], path[i - 1]);
      if (is_new || known->second == path[i - 1]) continue;
      diagnostics_.error(
          wanted.where.at("paths"), "ways that meet again",
          {"those of " + json::quote(wanted.name) + " at " + json::quote(r_.topology.nodes[path[i]].name),
           "ways from " + json::quote(r_.topology.nodes[path[0]].name) + " that part and do not meet, as of a tree"});
      return;
    }
}

std::optional<Path> StreamBuilder::explicit_path(const NewStream& wanted) {
  if (wanted.to.size() != 1) {
    diagnostics_.error(wanted.where.at("path"), "a path for several receivers",
                       {std::to_string(wanted.to.size()) + " receivers", "one receiver"});
    return std::nullopt;
  }
  return named_path(
      r_.topology, *wanted.path, *wanted.from, wanted.to.front().first, wanted.where.at("path"),
      [&](std::size_t i) { return wanted.where.at("path", i); }, diagnostics_);
}

std::optional<MemberPaths> StreamBuilder::member_paths(const NewStream& wanted) {
  const Redundancy& redundancy = *wanted.redundancy;
  if (wanted.path != nullptr)
    diagnostics_.error(wanted.where.at("path"), "a path of a redundant stream",
                       {"\"path\" beside \"redundancy\"", "\"paths\" in \"redundancy\""});
  if (!redundancy.vlans.empty() && !wanted.priority)
    diagnostics_.error(redundancy.where.at("vlans"), "a VLAN without a priority",
                       {"\"vlans\" of an untagged stream", "\"pcp\" too, since the tag carries both"});
  if (wanted.path != nullptr) return std::nullopt;
  std::optional<MemberPaths> members =
      wanted.to.size() == 1 ? lay_members(r_, redundancy, *wanted.from, wanted.to.front().first, diagnostics_)
                            : lay_member_trees(r_, redundancy, *wanted.from, wanted.to, diagnostics_);
  if (const std::size_t count = members ? members->paths.size() / wanted.to.size() : 0;
      members && !redundancy.ladder && !redundancy.vlans.empty() && redundancy.vlans.size() != count)
    diagnostics_.error(redundancy.where.at("vlans"), "not a VLAN for each path",
                       {std::to_string(redundancy.vlans.size()), std::to_string(count)});
  return members;
}

models::AddressIndex StreamBuilder::new_group() {
  return {static_cast<std::uint32_t>(r_.plan.nodes.size()) + groups_++};
}

void StreamBuilder::add_members(const NewStream& wanted, const MemberPaths& members, models::StreamIndex index) {
  ResolvedRedundancy made;
  made.stream = index;
  made.description = wanted.redundancy;
  made.split = members.paths.front()[members.split];
  made.merge =
      wanted.to.size() == 1 ? members.paths.front()[members.merge(members.paths.front())] : ResolvedRedundancy::nobody;
  made.splits_in_host = members.split == 0;
  made.merges_in_host = members.after_merge == 0;
  made.number = members.paths.front()[members.number];
  made.numbers_in_host = members.number == 0 && !made.splits_in_host;
  made.numbering_port = port_out(r_.topology, members.paths.front(), 0);
  if (wanted.redundancy->ladder) return add_ladder(wanted, members, std::move(made));
  const models::AddressIndex compound = r_.plan.streams[index.value].destination;
  for (std::size_t i = 0; i < members.paths.size() / wanted.to.size(); ++i) {
    models::StreamMember member;
    member.destination = new_group();
    member.vlan = wanted.redundancy->vlans.empty() ? wanted.vlan : wanted.redundancy->vlans[i];
    member.port = port_out(r_.topology, members.paths[i], 0);
    made.members.push_back(member);
  }
  for (std::size_t i = 0; i < members.paths.size(); ++i) {
    const Path& path = members.paths[i];
    const models::StreamMember& member = made.members[i % made.members.size()];
    // Before the split and behind the merge there is one stream; the node that splits forwards members already, the one
    // that merges the stream: but a host at the end of the path gets members, and merges them itself.
    for_each_entry(r_.topology, path, [&](std::size_t at, std::uint16_t port) {
      const bool is_member = at >= members.split && (at < members.merge(path) || made.merges_in_host);
      add_entry(path[at], port, is_member ? member.vlan : wanted.vlan, is_member ? member.destination : compound);
    });
  }
  r_.redundancies.push_back(std::move(made));
}

void StreamBuilder::add_ladder(const NewStream& wanted, const MemberPaths& ways, ResolvedRedundancy made) {
  lay_ladder(ways, made, [&](std::uint32_t from, std::uint32_t to) {
    return models::StreamMember{new_group(), wanted.vlan, *r_.topology.port_towards(from, to)};
  });
  const models::AddressIndex compound = r_.plan.streams[made.stream.value].destination;
  for (const Path& path : ways.paths)
    for_each_entry(r_.topology, path, [&](std::size_t at, std::uint16_t port) {
      const bool is_member = at >= ways.split && (at < ways.merge(path) || made.merges_in_host);
      const std::size_t link = std::min(at, path.size() - 2);  // in a station the host gets what came last
      add_entry(path[at], port, wanted.vlan,
                is_member ? made.members[made.member_of_link.at({path[link], path[link + 1]})].destination : compound);
    });
  r_.redundancies.push_back(std::move(made));
}

void StreamBuilder::add_entry(std::uint32_t node, std::uint16_t port, models::VlanId vlan,
                              models::AddressIndex address) {
  r_.plan.filtering.push_back({models::NodeIndex{node}, vlan, address, port});
}

void StreamBuilder::add_filtering(const Path& path, models::VlanId vlan, models::AddressIndex address) {
  for_each_entry(r_.topology, path,
                 [&](std::size_t at, std::uint16_t port) { add_entry(path[at], port, vlan, address); });
}

/// Streams that an ingress names are told apart by their addresses, so each has one of its own.
void StreamBuilder::note_identified_streams() {
  for (const TopologyNode& node : r_.topology.nodes) {
    const Relay* const bridge = relay_of(node.description);
    if (bridge == nullptr || !bridge->ingress) continue;
    for (const StreamFilterEntry& filter : bridge->ingress->filters)
      if (filter.stream) identified_.insert(*filter.stream);
    for (const IdentifiedStream& stream : bridge->ingress->streams)
      if (stream.null && stream.null->stream) identified_.insert(*stream.null->stream);
  }
}

}  // namespace takt::scenario
