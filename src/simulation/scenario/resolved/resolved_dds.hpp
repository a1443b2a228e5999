// SPDX-License-Identifier: Apache-2.0
// Participants of DDS: their settings, and which streams carry what they send to whom.
#pragma once

#include <vector>

#include "dds/participant/participant_config.hpp"
#include "models/ethernet/frame.hpp"

namespace takt::scenario {

struct ResolvedParticipant {
  struct Route {
    dds::Locator to;
    std::int32_t transport_priority = 0;
    models::StreamIndex stream;
  };
  struct Heard {
    models::StreamIndex stream;
    dds::Locator source;  ///< where its messages come from
  };
  std::uint32_t application = 0;
  dds::ParticipantConfig config;  ///< but the prefix
  std::vector<Route> routes;
  std::vector<Heard> hears;  ///< ascending streams
};

struct ResolvedDds {
  std::vector<ResolvedParticipant> participants;
};

}  // namespace takt::scenario
