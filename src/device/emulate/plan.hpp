// SPDX-License-Identifier: Apache-2.0
// What has to be laid and started for a scenario: names, cables, node files, actions. Made without touching the
// machine.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "emulate/application_files.hpp"
#include "program/method.hpp"
#include "scenario/resolved/resolved.hpp"

namespace takt::emulate {

/// A veth pair between the namespaces of two nodes of the topology.
struct Cable {
  struct End {
    std::uint32_t node = 0;
    std::string interface;
  };
  End a;
  End b;
  std::uint32_t link = 0;  ///< in the topology
};

/// A process on a host: a participant of a Program or, where nested Programs are joined, of an outer and an inner one;
/// or a candidate for roles.
struct PlannedNode {
  struct Part {
    std::uint32_t program = 0;
    std::uint8_t participant = 0;             ///< of a candidate: none
    std::optional<std::uint8_t> candidate{};  ///< in ResolvedProgram::candidates
  };
  std::vector<Part> parts;  ///< the outer one first
  std::uint32_t host = 0;   ///< in the topology
  std::string name;         ///< unique: what its file and its socket are called
  std::string config;       ///< its file; the path of the control socket is still to be put for `control_mark`
  bool is_absent = false;   ///< a candidate that does not announce itself at the beginning; its file has true or false
                            ///< for `absent_mark`
};
inline constexpr const char* control_mark = "@CONTROL@";
inline constexpr const char* absent_mark = "\"@ABSENT@\"";

struct CallAction {
  std::uint32_t node = 0;  ///< in Plan::nodes
  std::uint32_t part = 0;  ///< which of its participants
  program::Method method = program::Method::Start;
  std::optional<std::uint8_t> role{};  ///< not on the node, which is the master, but on whoever has this role then
};
/// A candidate joins or leaves.
struct MembershipAction {
  std::uint32_t node = 0;
  bool joins = false;
};
struct LinkAction {
  std::uint32_t cable = 0;
  bool up = false;
};
/// A host is killed, or starts again.
struct HostAction {
  std::uint32_t host = 0;
  bool up = false;
};
struct Action {
  sim::Duration at;  ///< after all nodes have started
  std::variant<CallAction, LinkAction, HostAction, MembershipAction> what;
};

struct Plan {
  std::vector<bool> is_bridge;  ///< by node of the topology: a switch or a station
  std::vector<Cable> cables;
  std::vector<PlannedNode> nodes;
  std::vector<PlannedApplications> applications;
  std::vector<Action> actions;        ///< by time
  std::vector<std::string> notes;     ///< what is left out, and why that may matter
  std::vector<std::string> refusals;  ///< not empty: it cannot be emulated
};

Plan plan_of(const scenario::Resolved& resolved);

}  // namespace takt::emulate
