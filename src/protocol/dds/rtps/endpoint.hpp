// SPDX-License-Identifier: Apache-2.0
// What a writer knows of a reader, and a reader of a writer, when they are matched (DDSI-RTPS 2.5, 8.4.7.5, 8.4.10.4).
#pragma once

#include <vector>

#include "dds/message/guid.hpp"
#include "dds/message/locator.hpp"
#include "dds/qos/policies.hpp"

namespace takt::dds {

struct MatchedReader {
  Guid guid;
  std::vector<Locator> unicast;    ///< the first one is used
  std::vector<Locator> multicast;  ///< used where all readers of a message listen there
  bool reliable = false;
  bool wants_history = false;  ///< durability is TRANSIENT_LOCAL or above: what was written before the match, too
};

struct MatchedWriter {
  Guid guid;
  std::vector<Locator> unicast;
  bool reliable = false;
  bool has_history = false;  ///< offers what was written before the match
  Guid persistence_guid;     ///< the name that survives the writer's restarts; unknown: it has none
  std::int32_t ownership_strength = 0;
  sim::Duration lifespan = infinite;
  Liveliness liveliness;
};

}  // namespace takt::dds
