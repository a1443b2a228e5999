// What scenario files say of DDS: quality of service of topics, domains and their discovery (OMG DDS 1.4, 2.2.3; DDSI-RTPS 2.5, 8.5).
// See scenario/description/description.hpp.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "json/fields.hpp"
#include "sim/time.hpp"
#include "vocabulary/dds.hpp"

namespace takt::scenario {

using sim::Duration;

using vocabulary::Durability;
using vocabulary::Qos;
using vocabulary::Reliability;

enum class Publication : std::uint8_t { synchronous, asynchronous };

/// What an asynchronous writer may send at once.
struct FlowControl {
  json::Source where;
  std::uint32_t octets = 0;
  Duration every;
  bool operator==(const FlowControl&) const = default;
};

enum class Discovery : std::uint8_t { simple, static_, server };

/// How the participants of a domain find each other.
struct Domain {
  json::Source where;
  std::uint16_t id = 0;
  Discovery discovery = Discovery::simple;
  std::optional<std::string> server;             ///< application
  std::optional<Duration> announce_every;
  std::optional<Duration> lease_duration;
  bool operator==(const Domain&) const = default;
};

const json::Enumeration& describe(json::Type<Publication>);
const json::Object& describe(json::Type<FlowControl>);
const json::Enumeration& describe(json::Type<Discovery>);
const json::Object& describe(json::Type<Domain>);

}  // namespace takt::scenario
