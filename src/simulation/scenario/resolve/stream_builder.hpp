// SPDX-License-Identifier: Apache-2.0
// Lays one stream: its address, its paths, the filtering entries along them.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "scenario/resolve/redundancy.hpp"
#include "scenario/resolved/resolved.hpp"

namespace takt::scenario {

/// A stream that is wanted.
struct NewStream {
  std::string name;
  json::Source where;
  std::optional<std::uint32_t> from;  ///< empty: unknown, already reported
  std::vector<std::pair<std::uint32_t, json::Place>> to;
  std::optional<models::Priority> priority;
  models::VlanId vlan = 0;
  Octets headers{0};
  Octets payload{0};                               ///< the greatest
  const std::vector<std::string>* path = nullptr;  ///< names of all nodes, for one receiver
  const std::vector<std::vector<std::string>>* ways =
      nullptr;  ///< sound paths, of which those are taken that join the sender and a receiver, in either direction
  const Redundancy* redundancy = nullptr;  ///< or null
  bool of_program = false;
  std::uint16_t ether_type = 0;  ///< see models::StreamPlan
  bool is_group = false;         ///< sent to a group even if one host receives it
  std::uint16_t udp_port = 0;    ///< see models::StreamPlan, as the next two
  std::uint16_t udp_source_port = 0;
  std::uint32_t ip_group = 0;
};

class StreamBuilder {
 public:
  StreamBuilder(Resolved& resolved, json::Diagnostics& diagnostics)
      : r_(resolved), diagnostics_(diagnostics), router_(resolved.topology) {
    note_identified_streams();
    lay_unicast_paths();
  }

  /// The host of that name; a mistake is reported at `place`.
  std::optional<std::uint32_t> host(const std::string& name, const json::Place& place);
  /// Adds the stream to the plan. Nothing if it cannot be (reported).
  std::optional<models::StreamIndex> add(const NewStream& wanted);

 private:
  bool check_size(const NewStream& wanted);
  void check_size(const NewStream& wanted, const std::vector<Path>& paths);
  json::Place place_of_size(const NewStream& wanted) const;
  void check_names_of_paths(const NewStream& wanted);
  std::vector<Path> paths_of(const NewStream& wanted);
  std::optional<Path> way_between(const NewStream& wanted, std::uint32_t to) const;
  void check_tree(const NewStream& wanted, const std::vector<Path>& paths);
  std::optional<Path> explicit_path(const NewStream& wanted);
  std::optional<MemberPaths> member_paths(const NewStream& wanted);
  models::AddressIndex new_group();
  void add_ladder(const NewStream& wanted, const MemberPaths& ways, ResolvedRedundancy made);
  void add_members(const NewStream& wanted, const MemberPaths& members, models::StreamIndex index);
  void add_entry(std::uint32_t node, std::uint16_t port, models::VlanId vlan, models::AddressIndex address);
  void note_identified_streams();
  /// Of the streams whose ends are known: all at once is quicker than one after the other.
  void lay_unicast_paths();
  void add_filtering(const Path& path, models::VlanId vlan, models::AddressIndex address);

  Resolved& r_;
  json::Diagnostics& diagnostics_;
  Router router_;
  std::set<std::string, std::less<>> identified_;  // streams that some ingress names
  std::uint32_t groups_ = 0;
  std::uint64_t path_nodes_ = 0;
};

}  // namespace takt::scenario
