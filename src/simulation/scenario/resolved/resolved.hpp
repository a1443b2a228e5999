// SPDX-License-Identifier: Apache-2.0
// What a scenario comes down to once names are found, paths are laid and everything has been checked.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "models/plan.hpp"
#include "scenario/resolved/resolved_applications.hpp"
#include "scenario/description/description.hpp"
#include "scenario/resolved/gate_problem.hpp"
#include "scenario/topology/routing.hpp"
#include "scenario/topology/topology.hpp"

namespace takt::scenario {

struct ResolvedDds;     // resolved/resolved_dds.hpp
struct RequiredFigure;  // figures/requirement.hpp

/// What a stream asks of the links: long-term averages, for check and for refusing overload.
struct StreamDemand {
  double wire_bits_per_second = 0;  ///< preamble and inter-packet gap included
  double frames_per_second = 0;
};

struct ResolvedStream {
  models::StreamIndex index;  ///< in plan.streams
  std::vector<Path> paths;    ///< one for each listener; of a redundant stream for each listener one for each member
  StreamDemand demand;
  json::Source where;
  bool of_program = false;
  Octets largest_payload{0};
  bool finds_its_way = true;  ///< rerouting may lay other paths
};

struct ResolvedProcessData {
  std::string name;
  std::uint8_t from = 0;  ///< participant
  std::uint32_t field_octets = 0;
  std::uint32_t values = 0;  ///< single ones, in all fields
};

/// Data sets of one program: `with` is published when `to` has come and was worked at.
struct ResolvedReply {
  std::uint8_t to = 0;
  std::uint8_t with = 0;
};

struct ResolvedProcessing {
  sim::Distribution per_message = sim::Distribution::constant({});
  sim::Distribution per_field = sim::Distribution::constant({});
};

/// A node that is a participant of a program from the beginning, or may become one: a candidate for its roles.
struct ResolvedMember {
  models::NodeIndex node;
  std::vector<std::string> skills = {};  ///< that a candidate offers
  bool is_absent = false;                ///< a candidate, at the beginning
  models::StreamIndex state = {};
  std::optional<models::StreamIndex> roles =
      {};  ///< with roles: the bindings that the master tells, what a candidate announces
  std::vector<std::optional<models::StreamIndex>> data =
      {};                                        ///< by data set, of those that it sends, or a role that it may have
  std::optional<std::uint32_t> cpu_thread = {};  ///< of the node's processor, on which it runs
  Duration seal = {};  ///< what securing takes of each message that it sends; 0 in programs without security
  Duration open = {};  ///< of each that it hears
};

struct ResolvedProgram {
  std::string name;
  const Program* description = nullptr;
  std::vector<ResolvedMember> members;         ///< 0 the master, then the slaves, or with roles the candidates
  std::vector<std::string> participant_names;  ///< the master, then the slaves, or the roles
  std::vector<ResolvedProcessData> process_data;
  std::vector<ResolvedReply> replies;                 ///< as in the description
  std::vector<ResolvedProcessing> processing;         ///< by participant; empty without replies
  std::vector<Duration> phases;                       ///< of publishing, by participant
  std::shared_ptr<const Redundancy> redundancy = {};  ///< of its messages; null: none
  Duration receive_timeout;
  std::uint16_t first_publisher_id = 1;  ///< of the master
  Duration announce_every = {};          ///< with roles
  /// Roles are bound while it runs; without them each slave is a role that is bound from the beginning.
  bool has_roles() const { return !description->roles.empty(); }
  /// Of the members those that are so from the beginning; and the others.
  std::span<const ResolvedMember> participants() const {
    return std::span(members).first(has_roles() ? 1 : members.size());
  }
  std::span<const ResolvedMember> candidates() const { return std::span(members).subspan(participants().size()); }
  /// The only stream of a data set that one of participants() sends.
  models::StreamIndex stream_of(std::size_t data_set) const {
    return *members[process_data[data_set].from].data[data_set];
  }
  /// Nested: its master is a slave of this program.
  struct Outer {
    std::uint32_t program = 0;  ///< in Resolved::programs
    std::uint8_t participant = 0;
  };
  std::optional<Outer> outer = {};
  std::set<std::uint8_t> nested = {};  ///< participants whose nodes are in an outer or inner program, too
};

struct ResolvedCall {
  std::uint32_t program = 0;
  std::uint8_t participant = 0;
  Method method = Method::Start;
};

/// A candidate begins to announce itself, or leaves.
struct ResolvedMembership {
  std::uint32_t program = 0;
  std::uint8_t candidate = 0;
  bool joins = false;
};

/// Another gate list for a port.
struct ResolvedGates {
  models::NodeIndex node;
  std::uint16_t port = 0;
  models::GateConfig gates;
};

/// A link goes down or comes back.
struct ResolvedLink {
  std::uint32_t link = 0;  ///< in plan.links
  bool up = false;
};

/// A node crashes or starts again.
struct ResolvedNode {
  models::NodeIndex node;
  bool up = false;
};

/// A gate is stuck, or works again.
struct ResolvedStuckGate {
  models::NodeIndex node;
  std::uint16_t port = 0;
  models::TrafficClass traffic_class = 0;
  std::optional<bool> open;
};

/// Other entries of filtering databases.
struct ResolvedRoutes {
  struct Entry {
    models::NodeIndex node;
    models::VlanId vlan = 0;
    models::AddressIndex address;
    std::vector<std::uint16_t> ports;
  };
  std::vector<Entry> entries;
};

/// A clock jumps, or its oscillator gets another frequency.
struct ResolvedClockFault {
  models::NodeIndex node;
  std::optional<Duration> step;
  std::optional<sim::FrequencyOffset> offset;
};

/// The bypass relay of a station that is down joins its ports, or parts them.
struct ResolvedBypass {
  models::NodeIndex node;
  bool joins = false;
};

struct ResolvedAction {
  sim::TrueTime at;
  std::variant<ResolvedCall, ResolvedMembership, ResolvedGates, ResolvedLink, ResolvedNode, ResolvedStuckGate,
               ResolvedRoutes, ResolvedClockFault, ResolvedBypass>
      what;
};

/// The demand on one direction of a link.
struct PortDemand {
  models::NodeIndex node;  ///< the sending side
  std::uint16_t port = 0;
  models::NodeIndex peer;
  double link_bits_per_second = 0;
  std::array<double, models::traffic_class_count> class_bits_per_second{};
  double share() const {
    double sum = 0;
    for (const double bits : class_bits_per_second) sum += bits;
    return sum / link_bits_per_second;
  }
};

/// A stream that is split into members and made one again. Its ResolvedStream has a path for each member to each
/// listener.
struct ResolvedRedundancy {
  models::StreamIndex stream;
  const Redundancy* description = nullptr;
  std::uint32_t split = 0;  ///< node
  std::uint32_t merge = 0;  ///< node; of several listeners, each of which merges for itself, none
  static constexpr std::uint32_t nobody = 0xFFFF'FFFF;
  std::uint32_t number = 0;                   ///< node; the split, or one before it
  std::vector<models::StreamMember> members;  ///< by path; of a ladder by the stretch from one relay to the next
  bool splits_in_host = false;                ///< at the talker, not by what a bridge does to frames that come in
  bool merges_in_host = false;                ///< at the listener
  bool numbers_in_host = false;
  std::uint16_t numbering_port = 0;  ///< of a host that numbers: by which the stream leaves it

  /// Of a ladder: a node where ways meet or part, with the members that come and go. The split and the merge are two of
  /// them.
  struct Relay {
    std::uint32_t node = 0;
    std::vector<std::uint32_t> in;
    std::vector<std::uint32_t> out;  ///< none at the merge
  };
  std::vector<Relay> relays;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t>
      member_of_link;  ///< of a ladder: which goes from a node to the next
  bool is_ladder() const { return !relays.empty(); }
  const Relay* relay_at(std::uint32_t node) const {
    const auto at = std::ranges::find(relays, node, &Relay::node);
    return at == relays.end() ? nullptr : &*at;
  }
};

/// What takt chose where a file says "offset": "auto".
struct ResolvedOffset {
  std::string name;  ///< the stream, "PROGRAM/state/PARTICIPANT", or a program with roles
  Duration offset;
  Duration period;
};

/// A scenario as it runs. Its parts point into one another (programs and redundancies into the scenario, streams by
/// number into the plan), so it stays where it was made.
struct Resolved {
  Resolved();  // both where they are compiled once: what is below is large
  ~Resolved();
  Resolved(const Resolved&) = delete;
  Resolved& operator=(const Resolved&) = delete;
  /// What of a large plant is kept for long, and grew: up to half of it is room for more.
  void give_back_room();

  Scenario scenario;
  Topology topology;
  models::NetworkPlan plan;
  std::vector<ResolvedStream> streams;           ///< by stream index
  std::vector<ResolvedRedundancy> redundancies;  ///< ascending streams
  std::vector<ResolvedProgram> programs;
  std::vector<ResolvedTopic> topics;
  std::vector<ResolvedApplication> applications;  ///< and gateways, behind them
  std::vector<ResolvedSignal> signals;
  std::shared_ptr<ResolvedDds> dds;                 ///< never null
  std::vector<ResolvedAction> script;               ///< by time
  std::vector<PortDemand> ports;                    ///< those that carry something
  std::optional<GatePlan> gates = {};               ///< if they were laid out
  std::vector<ResolvedOffset> chosen_offsets = {};  ///< those with windows first
  std::vector<RequiredFigure>
      requirements;  ///< in the order of scenario.require, an entry of which may ask for several
};

}  // namespace takt::scenario
