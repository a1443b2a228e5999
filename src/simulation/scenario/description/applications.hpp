// SPDX-License-Identifier: Apache-2.0
// What scenario files say of applications beside the plant: who keeps what they say. See
// scenario/description/description.hpp.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "json/fields.hpp"
#include "plant/application.hpp"
#include "plant/program.hpp"
#include "scenario/description/dds.hpp"
#include "sim/time.hpp"

namespace takt::scenario {

using namespace sim::literals;  // NOLINT: units in default values

using plant::Application;
using plant::Gateway;
using plant::Overflow;
using plant::Pattern;
using plant::Payload;
using plant::Protocol;
using plant::Scheduler;
using plant::Signal;
using plant::Thread;
using plant::Topic;

/// A persistence service: keeps topics of DDS whose durability is transient or persistent.
struct Persistence {
  json::Source where;
  std::string name;
  std::string on;
  std::vector<std::string> topics;
  bool operator==(const Persistence&) const = default;
};

const json::Object& describe(json::Type<Persistence>);

}  // namespace takt::scenario
