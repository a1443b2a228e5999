// SPDX-License-Identifier: Apache-2.0
// The node files of the coexistence measurement: what runs where, made without touching the machine.
#pragma once

#include <string>
#include <vector>

namespace takt::emulate {

enum class CaseStudy { mirror, gateway };

/// How the nodes of a measurement reach each other.
struct CoexistenceNetwork {
  std::string interface;
  int port = 4840;
  int domain = 0;
};

/// The nodes of a case study, each a process.
const std::vector<std::string>& nodes_of(CaseStudy study);

/// The file of a node: all of the case study, of which it runs what is on it. As in the scenarios, who listens is half
/// an interval behind who speaks.
std::string node_file(CaseStudy study, const std::string& node, int interval_ms, int windows,
                      const CoexistenceNetwork& network, const std::string& statistics);

}  // namespace takt::emulate
