// SPDX-License-Identifier: Apache-2.0
// A build without an implementation of DDS.
#include "node/dds/participant.hpp"

namespace takt::node {

bool has_dds() { return false; }

std::unique_ptr<DdsParticipant> open_dds(std::uint16_t, const std::string&, std::string& problem) {
  problem = std::string("DDS is not in this build; needed is ") + dds_needed;
  return nullptr;
}

}  // namespace takt::node
