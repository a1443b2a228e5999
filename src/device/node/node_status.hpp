// SPDX-License-Identifier: Apache-2.0
// What a node says about itself: state, peers, statistics; as JSON for machines and as text for people. `takt schema
// status --reference` describes it.
#pragma once

#include <string>
#include <vector>

#include "node/config.hpp"
#include "node/node_security.hpp"
#include "node/server_state.hpp"
#include "node/sources.hpp"
#include "node/statistics.hpp"
#include "wire/program_node.hpp"

namespace takt::node {

/// All parts are the node's own.
struct ProgramStatus {
  const Program* program = nullptr;
  const wire::ProgramNode* node = nullptr;
  const CycleStatistics* cycles = nullptr;
  const PeerWatch* peers = nullptr;
  sim::LocalTime now;
  std::uint64_t send_failures = 0;  ///< of the node's socket
};
/// The interface that the transport names.
struct InterfaceStatus {
  std::string name;
  bool is_there = true;
  std::uint64_t bound_again = 0;
};
const json::Record& describe(json::Type<InterfaceStatus>);

struct NodeStatus {
  std::string node;
  std::vector<ProgramStatus> programs;  ///< at least one
  std::int64_t time_ns = 0;             ///< now, on the node's clock
  std::vector<HeardSource> sources = {};
  std::uint64_t log_lines_left_out = 0;
  std::optional<SecurityStatus> security = {};
  std::optional<ServerState> server = {};
  std::vector<SourceTable::Twins> twins = {};
  std::optional<InterfaceStatus> interface = {};
};
const json::Record& describe(json::Type<ProgramStatus>);
const json::Record& describe(json::Type<NodeStatus>);

/// On one line without a newline. What it says of a Program stands among the rest if the node has one only.
std::string to_json(const NodeStatus& status);
/// Some lines of text from what to_json made; the text itself if it is something else.
std::string status_text(const std::string& json);
/// Of them those that tell of `sources` and `security`, also of the statistics of applications.
std::string sources_text(const std::string& json);

}  // namespace takt::node
