// SPDX-License-Identifier: Apache-2.0
// What a Program's host tells the server of it.
#pragma once

#include <string>
#include <vector>

#include "opcua/encoding/node_id.hpp"
#include "wire/program_news.hpp"

namespace takt::opcua {

/// What does not change while the node runs.
struct ProgramDescription {
  std::string name;
  std::string handshake;  ///< "robust" or "paper"
  std::string own;        ///< this node
  std::string role;       ///< "master", "slave" or "candidate"
  std::string master;
  std::vector<std::string> participants;  ///< the master first
  std::vector<std::string> peers;         ///< that are heard here, in the order of their numbers; of roles their names
  double cycle_ms = 0;
};

using wire::ProgramNews;

/// "left is silent", for people; empty if nothing but a call was the cause.
std::string cause_text(handshake::Alarm alarm);

}  // namespace takt::opcua
