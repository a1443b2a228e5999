// What a node says about itself: state, peers, statistics; as JSON for machines and as text for people.
#pragma once

#include <string>
#include <vector>

#include "node/config.hpp"
#include "node/statistics.hpp"
#include "wire/program_node.hpp"

namespace takt::node {

/// All parts are the node's own.
struct ProgramStatus {
  const Program& program;
  const wire::ProgramNode& node;
  const CycleStatistics& cycles;
  const PeerWatch& peers;
};
struct NodeStatus {
  const std::string& node;
  std::vector<ProgramStatus> programs;  ///< at least one
  std::uint64_t send_failures = 0;      ///< of the node's socket
  sim::LocalTime now;
  std::int64_t time_ns = 0;             ///< now, on the node's clock
};

/// {"node": ..., "program": ..., "state": ..., "peers": [...], "statistics": {...}}, on one line without a newline. Of several Programs
/// {"node": ..., "programs": [...]}, each as above. A master of roles has "roles" and "candidates", a candidate "bound_to".
std::string to_json(const NodeStatus& status);
/// Some lines of text from what to_json made; the text itself if it is something else.
std::string status_text(const std::string& json);

}  // namespace takt::node
