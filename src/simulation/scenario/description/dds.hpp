// SPDX-License-Identifier: Apache-2.0
// What scenario files say of DDS beside the plant: domains and their discovery (DDSI-RTPS 2.5, 8.5).
// See scenario/description/description.hpp.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "json/fields.hpp"
#include "plant/application.hpp"
#include "plant/dds.hpp"
#include "sim/time.hpp"

namespace takt::scenario {

using sim::Duration;

using plant::Durability;
using plant::FlowControl;
using plant::Publication;
using plant::Qos;
using plant::Reliability;

enum class Discovery : std::uint8_t { simple, static_, server };

/// How the participants of a domain find each other.
struct Domain {
  json::Source where;
  std::uint16_t id = 0;
  Discovery discovery = Discovery::simple;
  std::optional<std::string> server;  ///< application
  std::optional<Duration> announce_every;
  std::optional<Duration> lease_duration;
  bool multicast = false;
  bool operator==(const Domain&) const = default;
};

const json::Enumeration& describe(json::Type<Discovery>);
const json::Object& describe(json::Type<Domain>);

}  // namespace takt::scenario
