// SPDX-License-Identifier: Apache-2.0
#include "scenario/resolve/redundancy.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <string>
#include <utility>

#include "models/ethernet/sizes.hpp"
#include "scenario/topology/disjoint_paths.hpp"
#include "scenario/topology/named_path.hpp"
#include "scenario/topology/redundant_trees.hpp"

namespace takt::scenario {
namespace {

class MemberLayer {
 public:
  MemberLayer(const Resolved& resolved, const Redundancy& redundancy, std::uint32_t from, std::uint32_t to,
              json::Diagnostics& diagnostics)
      : r_(resolved), redundancy_(redundancy), from_(from), to_(to), diagnostics_(diagnostics) {}

  std::optional<MemberPaths> lay() {
    MemberPaths members;
    if (!check_ladder()) return std::nullopt;
    members.paths = redundancy_.paths ? given() : found();
    if (members.paths.size() < 2) return std::nullopt;  // reported, or refused by the table
    if (redundancy_.ladder && !add_ways(members.paths)) return std::nullopt;
    // Together with the link by which a path comes to it from the split, or from the merge.
    const auto from_front = [&](const Path& path, std::size_t i) {
      return std::pair(path[i], i > 0 ? port_out(r_.topology, path, i - 1) : std::uint16_t{0});
    };
    const auto from_back = [&](const Path& path, std::size_t i) {
      const std::size_t at = path.size() - 1 - i;
      return std::pair(path[at], i > 0 ? port_in(r_.topology, path, at + 1) : std::uint16_t{0});
    };
    members.split = common(members.paths, from_front) - 1;
    members.after_merge = common(members.paths, from_back) - 1;
    if (!redundancy_.ladder) warn_of_shared_links(members);
    const bool split_is_fine = move_split(members);
    const bool merge_is_fine = move_merge(members);
    if (!split_is_fine || !merge_is_fine || !set_number(members)) return std::nullopt;
    return members;
  }

 private:
  static constexpr std::size_t most_ways = 64;

  bool check_ladder() {
    if (!redundancy_.ladder) return true;
    const std::size_t errors_before = diagnostics_.errors();
    const auto refuse = [&](std::string_view key, const std::string& expected) {
      diagnostics_.error(redundancy_.where.at(key), "a ladder otherwise than by its paths",
                         {"\"" + std::string(key) + "\" beside \"ladder\"", expected});
    };
    if (!redundancy_.paths && !diagnostics_.is_refused(redundancy_.where.at("paths")))
      diagnostics_.error(redundancy_.where.at("ladder"), "a ladder without paths",
                         {"no \"paths\"", "\"paths\" that meet and part again"});
    if (!redundancy_.vlans.empty()) refuse("vlans", "the VLAN of the stream");
    if (redundancy_.split) refuse("split", "the node where the paths part, which copies");
    if (redundancy_.merge) refuse("merge", "the node where the last of them meet");
    return diagnostics_.errors() == errors_before;
  }

  /// All ways through the links of the given paths that come to no node twice; the given ones first.
  bool add_ways(std::vector<Path>& paths) {
    if (std::ranges::any_of(paths, [](const Path& path) { return !path.ports.empty(); })) {
      diagnostics_.error(place("paths"), "a ladder over links that join the same nodes",
                         {"a port besides the first one between two nodes", "one link between each two of its nodes"});
      return false;
    }
    std::map<std::uint32_t, std::vector<std::uint32_t>> next;
    for (const Path& path : paths)
      for (std::size_t i = 0; i + 1 < path.size(); ++i)
        if (auto& nodes = next[path[i]]; std::ranges::find(nodes, path[i + 1]) == nodes.end())
          nodes.push_back(path[i + 1]);
    std::vector<Path> open{{from_}};
    while (!open.empty()) {
      const Path way = std::move(open.back());
      open.pop_back();
      if (way.back() == to_) {
        if (std::ranges::find(paths, way) == paths.end()) paths.push_back(way);
        if (paths.size() <= most_ways) continue;
        diagnostics_.error(place("paths"), "too many ways through a ladder",
                           {"more than " + std::to_string(most_ways), "at most " + std::to_string(most_ways)});
        return false;
      }
      for (const std::uint32_t node : next[way.back()]) {
        if (std::ranges::find(way, node) != way.end()) continue;
        open.push_back(way);
        open.back().push_back(node);
      }
    }
    return true;
  }

  bool set_number(MemberPaths& members) {
    members.number = members.split;
    if (!redundancy_.number) return true;
    const auto at = position(*redundancy_.number, "number", members.split, "before they are copied",
                             [&](std::size_t i) { return members.paths.front()[i]; });
    members.number = at.value_or(members.split);
    return at.has_value();
  }

  std::string name(std::uint32_t node) const { return json::quote(r_.topology.nodes[node].name); }
  json::Place place(std::string_view key) const { return redundancy_.where.at(key); }

  /// How many nodes all paths have in common, counted as `node_at` does.
  template <class NodeAt>
  static std::size_t common(const std::vector<Path>& paths, NodeAt&& node_at) {
    for (std::size_t i = 0;; ++i)
      for (const Path& path : paths)
        if (i == path.size() || node_at(path, i) != node_at(paths.front(), i)) return i;
  }

  std::vector<Path> found() {
    const std::size_t count = redundancy_.count.value_or(2);
    if (count < 2) return {};  // refused by the table
    DisjointPaths disjoint = disjoint_paths(r_.topology, from_, to_, count);
    if (disjoint.paths.empty()) {
      diagnostics_.error_unless(
          !r_.topology.has_all_links, redundancy_.where.place(), "not enough disjoint paths",
          {reason(disjoint), std::to_string(count) + " paths that share no link between switches"});
      return {};
    }
    if (!disjoint.shared_switches.empty()) {
      std::string names;
      for (std::size_t i = 0; i < std::min<std::size_t>(4, disjoint.shared_switches.size()); ++i)
        names += (i == 0 ? "" : ", ") + name(disjoint.shared_switches[i]);
      diagnostics_.warning(redundancy_.where.place(), "redundant paths that meet in a switch",
                           {names, "links around it"});
    }
    return std::move(disjoint.paths);
  }

  std::string reason(const DisjointPaths& disjoint) const {
    const std::string between = name(from_) + " and " + name(to_);
    if (disjoint.found == 0) return "none between " + between;
    const std::uint32_t first = r_.topology.neighbours[from_].front().node;
    const std::uint32_t last = r_.topology.neighbours[to_].front().node;
    if (first == last) return "both hosts at " + name(first);
    std::string text = std::to_string(disjoint.found) + " between " + between;
    for (std::size_t i = 0; i < std::min<std::size_t>(3, disjoint.bottleneck.size()); ++i)
      text += (i > 0                             ? ", "
               : disjoint.bottleneck.size() == 1 ? ", over the link "
                                                 : ", over the links ") +
              name(disjoint.bottleneck[i].first) + " - " + name(disjoint.bottleneck[i].second);
    return text;
  }

  std::vector<Path> given() {
    std::vector<Path> paths;
    const std::size_t errors_before = diagnostics_.errors();
    for (std::size_t i = 0; i < redundancy_.paths->size(); ++i) {
      const json::Place here = redundancy_.where.at("paths", i);
      if (diagnostics_.is_refused(here)) {  // a name in it is none
        diagnostics_.consequence();
        continue;
      }
      const auto place_of_node = [&](std::size_t node) {
        json::Place place = here;
        place.pointer += json::pointer_step(node);
        return place;
      };
      auto path = named_path(r_.topology, (*redundancy_.paths)[i], from_, to_, here, place_of_node, diagnostics_);
      if (!path) continue;
      if (std::find(paths.begin(), paths.end(), *path) != paths.end())
        diagnostics_.error(here, "a path twice", {"the path of another member", "paths that differ"});
      paths.push_back(std::move(*path));
    }
    if (diagnostics_.errors() != errors_before) paths.clear();
    return paths;
  }

  void warn_of_shared_links(const MemberPaths& members) {
    using End = std::pair<std::uint32_t, std::uint16_t>;  // node and port
    std::set<std::pair<End, End>> used;
    for (const Path& path : members.paths) {
      for (std::size_t i = members.split; i < members.merge(path); ++i) {
        const End out(path[i], port_out(r_.topology, path, i)), in(path[i + 1], port_in(r_.topology, path, i + 1));
        if (used.insert(std::minmax(out, in)).second) continue;
        diagnostics_.warning(redundancy_.where.place(), "redundant paths over one link",
                             {name(path[i]) + " - " + name(path[i + 1]), "paths that share no link"});
      }
    }
  }

  /// The position, counted from the outer end, of the named node among the `common` nodes there; nothing if it is not
  /// one of them.
  template <class NodeAt>
  std::optional<std::size_t> position(const std::string& wanted, std::string_view key, std::size_t last,
                                      std::string_view outer, NodeAt&& node_at) {
    const auto node = r_.topology.find(wanted);
    if (!node) {
      report_unknown_node(r_.topology, wanted, place(key), "the name of a node", diagnostics_);
      return std::nullopt;
    }
    for (std::size_t i = 0; i <= last; ++i)
      if (node_at(i) == *node) return i;
    std::string names;
    for (std::size_t i = 0; i <= last; ++i) names += (i == 0 ? "" : i == last ? " or " : ", ") + name(node_at(i));
    diagnostics_.error(place(key), "a node that not all paths cross " + std::string(outer),
                       {json::quote(wanted), names});
    return std::nullopt;
  }

  bool move_split(MemberPaths& members) {
    if (!redundancy_.split) return true;
    const auto at = position(*redundancy_.split, "split", members.split, "before they part",
                             [&](std::size_t i) { return members.paths.front()[i]; });
    members.split = at.value_or(members.split);
    return at.has_value();
  }
  bool move_merge(MemberPaths& members) {
    if (!redundancy_.merge) return true;
    const Path& path = members.paths.front();
    const auto at = position(*redundancy_.merge, "merge", members.after_merge, "after they have met",
                             [&](std::size_t i) { return path[path.size() - 1 - i]; });
    members.after_merge = at.value_or(members.after_merge);
    return at.has_value();
  }

  const Resolved& r_;
  const Redundancy& redundancy_;
  std::uint32_t from_;
  std::uint32_t to_;
  json::Diagnostics& diagnostics_;
};

/// Two trees to several receivers, or why not.
class TreeLayer {
 public:
  TreeLayer(const Resolved& resolved, const Redundancy& redundancy, std::uint32_t from, json::Diagnostics& diagnostics)
      : r_(resolved),
        redundancy_(redundancy),
        from_(from),
        trees_(resolved.topology, from),
        diagnostics_(diagnostics) {}

  std::optional<MemberPaths> lay(const std::vector<std::pair<std::uint32_t, json::Place>>& to) {
    const std::size_t errors_before = diagnostics_.errors();
    const auto refuse = [&](std::string_view key, const std::string& expected) {
      if (diagnostics_.is_refused(redundancy_.where.at("redundancy"))) return diagnostics_.consequence();  // short form
      diagnostics_.error(redundancy_.where.at(key), "redundancy for several receivers",
                         {"\"" + std::string(key) + "\" of a stream to " + std::to_string(to.size()), expected});
    };
    if (redundancy_.paths) refuse("paths", "\"count\", for which two trees are laid");
    if (redundancy_.count.value_or(2) != 2) refuse("count", "2");
    if (redundancy_.ladder) refuse("ladder", "two trees");
    if (redundancy_.number) refuse("number", "the sender, which numbers");
    if (redundancy_.split) refuse("split", "the sender, which splits");
    if (redundancy_.merge) refuse("merge", "the receivers, each of which merges");
    if (diagnostics_.errors() != errors_before) return std::nullopt;
    MemberPaths members;
    for (const auto& [node, place] : to) add(node, place, members);
    if (diagnostics_.errors() != errors_before) return std::nullopt;
    return members;
  }

 private:
  std::string name(std::uint32_t node) const { return json::quote(r_.topology.nodes[node].name); }
  bool has_one_link(std::uint32_t node) const { return r_.topology.neighbours[node].size() == 1; }

  void add(std::uint32_t node, const json::Place& place, MemberPaths& members) {
    const auto paths = trees_.to(node);
    if (!paths) {
      diagnostics_.error_unless(
          !r_.topology.has_all_links, place, "no path",
          {name(node) + " cannot be reached from " + name(from_), "links that join them over switches"});
      return;
    }
    // What has one link has no choice.
    const std::size_t needed = (has_one_link(from_) ? 1u : 0u) + (has_one_link(node) ? 1u : 0u);
    if ((*paths)[0] == (*paths)[1] || shared_links((*paths)[0], (*paths)[1]) > needed)
      diagnostics_.error_unless(
          !r_.topology.has_all_links, place, "not enough disjoint paths",
          {"1 between " + name(from_) + " and " + name(node), "2 paths that share no link between switches"});
    warn_of_shared_nodes(*paths);
    members.paths.insert(members.paths.end(), paths->begin(), paths->end());
  }

  void warn_of_shared_nodes(const std::array<Path, 2>& paths) {
    for (std::size_t i = 1; i + 1 < paths[0].size(); ++i) {
      const std::uint32_t node = paths[0][i];
      const bool is_attachment =
          (i == 1 && has_one_link(from_)) || (i + 2 == paths[0].size() && has_one_link(paths[0].back()));
      if (is_attachment || std::ranges::find(paths[1], node) == paths[1].end() || !warned_.insert(node).second)
        continue;
      diagnostics_.warning(redundancy_.where.place(), "redundant paths that meet in a switch",
                           {name(node), "links around it"});
    }
  }

  const Resolved& r_;
  const Redundancy& redundancy_;
  std::uint32_t from_;
  RedundantTrees trees_;
  json::Diagnostics& diagnostics_;
  std::set<std::uint32_t> warned_;
};

/// From the first bit leaving the split to the last bit at the merge, if nothing is in the way.
Duration undisturbed_delay(const Resolved& r, const Path& path, std::uint32_t split, std::uint32_t merge,
                           Octets frame) {
  Duration delay;
  auto at = std::find(path.begin(), path.end(), split);
  for (; *at != merge; ++at) {
    const std::uint16_t port = port_out(r.topology, path, static_cast<std::size_t>(at - path.begin()));
    for (const models::LinkPlan& link : r.plan.links) {
      const bool forth = link.a.node.value == *at && link.a.port == port;
      const bool back = link.b.node.value == *at && link.b.port == port;
      if (!forth && !back) continue;
      delay += link.delay + link.rate.octet_time() * (models::preamble_and_sfd + frame).count;
      break;
    }
    if (*(at + 1) != merge) delay += r.plan.nodes[*(at + 1)].forwarding_delay;
  }
  return delay;
}

}  // namespace

std::optional<MemberPaths> lay_members(const Resolved& resolved, const Redundancy& redundancy, std::uint32_t from,
                                       std::uint32_t to, json::Diagnostics& diagnostics) {
  return MemberLayer(resolved, redundancy, from, to, diagnostics).lay();
}

std::optional<MemberPaths> lay_member_trees(const Resolved& resolved, const Redundancy& redundancy, std::uint32_t from,
                                            const std::vector<std::pair<std::uint32_t, json::Place>>& to,
                                            json::Diagnostics& diagnostics) {
  return TreeLayer(resolved, redundancy, from, diagnostics).lay(to);
}

std::vector<OnHop> on_hops(const Resolved& r, const ResolvedRedundancy& redundancy, std::size_t number_of_path) {
  const Path& path = r.streams[redundancy.stream.value].paths[number_of_path];
  std::vector<OnHop> hops;
  bool is_member = false;
  bool r_tagged = false;
  for (std::size_t at = 0; at + 1 < path.size(); ++at) {
    if (is_member && path[at] == redundancy.merge) {
      is_member = false;
      r_tagged = redundancy.description->keep_tag;
    }
    if (path[at] == redundancy.number) r_tagged = true;
    if (path[at] == redundancy.split) is_member = r_tagged = true;
    OnHop hop{{}, r_tagged};
    if (is_member)
      hop.member = redundancy.is_ladder() ? redundancy.member_of_link.at({path[at], path[at + 1]})
                                          : number_of_path % redundancy.members.size();
    hops.push_back(hop);
  }
  return hops;
}

void lay_ladder(const MemberPaths& ways, ResolvedRedundancy& redundancy,
                const std::function<models::StreamMember(std::uint32_t, std::uint32_t)>& member) {
  std::map<std::uint32_t, std::set<std::uint32_t>> before, behind;
  for (const Path& path : ways.paths)
    for (std::size_t i = ways.split; i < ways.merge(path); ++i) {
      behind[path[i]].insert(path[i + 1]);
      before[path[i + 1]].insert(path[i]);
    }
  const auto is_relay = [&](std::uint32_t node) { return before[node].size() != 1 || behind[node].size() != 1; };
  for (const Path& path : ways.paths)
    for (std::size_t i = ways.split; i < ways.merge(path); ++i) {
      const auto [at, is_new] = redundancy.member_of_link.try_emplace(
          {path[i], path[i + 1]}, static_cast<std::uint32_t>(redundancy.members.size()));
      if (!is_new) continue;
      if (is_relay(path[i]))
        redundancy.members.push_back(member(path[i], path[i + 1]));
      else
        at->second = redundancy.member_of_link.at({path[i - 1], path[i]});
    }
  std::map<std::uint32_t, ResolvedRedundancy::Relay> relays;
  const auto note = [](std::vector<std::uint32_t>& members, std::uint32_t one) {
    if (std::ranges::find(members, one) == members.end()) members.push_back(one);
  };
  for (const auto& [link, number] : redundancy.member_of_link) {
    if (is_relay(link.first)) note(relays[link.first].out, number);
    if (is_relay(link.second)) note(relays[link.second].in, number);
  }
  for (auto& [node, relay] : relays) {
    relay.node = node;
    std::ranges::sort(relay.in);
    std::ranges::sort(relay.out);
    redundancy.relays.push_back(std::move(relay));
  }
}

models::StreamRecoveryConfig ladder_recovery(const Resolved& r, const ResolvedRedundancy& redundancy,
                                             const ResolvedRedundancy::Relay& relay, json::Diagnostics& diagnostics) {
  models::StreamRecoveryConfig config = recovery_config(r, redundancy, diagnostics);
  config.members.clear();
  for (const std::uint32_t member : relay.in) config.members.push_back(redundancy.members[member]);
  if (config.latent_error_detection) config.latent_error_detection->paths = static_cast<std::uint32_t>(relay.in.size());
  if (!relay.out.empty()) config.keep_r_tag = true;
  if (relay.out.size() != 1) return config;
  config.destination = redundancy.members[relay.out.front()].destination;
  config.vlan = redundancy.members[relay.out.front()].vlan;
  return config;
}

models::StreamSplitConfig numbering_config(const Resolved& r, const ResolvedRedundancy& redundancy) {
  const models::StreamPlan& stream = r.plan.streams[redundancy.stream.value];
  return {{models::StreamMember{stream.destination, stream.vlan, redundancy.numbering_port}}};
}

models::StreamRecoveryConfig recovery_config(const Resolved& r, const ResolvedRedundancy& redundancy,
                                             json::Diagnostics& diagnostics) {
  const Redundancy& description = *redundancy.description;
  const models::StreamPlan& stream = r.plan.streams[redundancy.stream.value];
  models::StreamRecoveryConfig config;
  config.members = redundancy.members;
  config.recovery.algorithm =
      description.algorithm == Recovery::vector ? models::RecoveryAlgorithm::vector : models::RecoveryAlgorithm::match;
  config.recovery.history_length = description.history;
  config.recovery.take_no_sequence = description.take_untagged;
  config.individual_recovery = description.individual;
  config.reset_timeout = description.reset_timeout;
  if (description.latent_errors) {
    const LatentErrors& latent = *description.latent_errors;
    config.latent_error_detection = models::LatentErrorDetectionConfig{
        static_cast<std::uint32_t>(redundancy.members.size()), latent.difference, latent.period, latent.reset_period};
  }
  config.keep_r_tag = description.keep_tag;
  config.destination = stream.destination;
  config.vlan = stream.vlan;

  const ResolvedStream& resolved = r.streams[redundancy.stream.value];
  const Octets frame =
      models::frame_length(stream.headers + resolved.largest_payload, stream.priority.has_value(), true);
  Duration least = Duration::max();
  Duration greatest;
  for (const Path& path : resolved.paths) {
    const Duration delay =
        undisturbed_delay(r, path, redundancy.split, redundancy.merges_in_host ? path.back() : redundancy.merge, frame);
    least = std::min(least, delay);
    greatest = std::max(greatest, delay);
  }
  const double lead = static_cast<double>((greatest - least).ps()) * 1e-12 * resolved.demand.frames_per_second;
  const bool match = description.algorithm == Recovery::match;
  if (match ? lead >= 1 : lead + 1 > description.history)
    diagnostics.warning(description.where.at(match ? "algorithm" : "history"),
                        match ? "several frames in flight" : "a short history",
                        {"paths whose delays differ by " + json::to_text(greatest - least) + ", about " +
                             std::to_string(static_cast<std::uint64_t>(lead)) + " frames",
                         match ? "the vector algorithm" : "a history of more frames than one path is ahead"});
  return config;
}

}  // namespace takt::scenario
