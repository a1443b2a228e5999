// SPDX-License-Identifier: Apache-2.0
// What a planner does not ask for and a run needs: exports write it beside the problem, and imports take it back.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scenario/description/description.hpp"

namespace takt::interchange {

/// Of one stream.
struct StreamExtras {
  json::Source where;
  std::string stream;               ///< as the problem calls it
  std::optional<std::string> name;  ///< as the scenario does, if otherwise
  scenario::Encapsulation encapsulation = scenario::Encapsulation::udp;
  std::optional<std::uint8_t> pcp;
  std::uint16_t vlan = 0;
  sim::Octets payload{0};
  bool is_burst = false;  ///< a frame a period that the scenario has as a burst of one
  bool operator==(const StreamExtras&) const = default;
};

/// The ports of a cable.
struct CableExtras {
  json::Source where;
  std::string link;  ///< one of its directions, as the problem calls it
  std::uint16_t from = 0;
  std::uint16_t to = 0;
  bool operator==(const CableExtras&) const = default;
};

struct NodeExtras {
  json::Source where;
  std::string node;  ///< as the problem calls it
  std::string name;  ///< as the scenario does
  bool operator==(const NodeExtras&) const = default;
};

struct PlanningExtras {
  json::Source where;
  std::optional<sim::Duration> duration;
  std::uint64_t seed = 1;
  std::vector<NodeExtras> nodes;
  std::vector<StreamExtras> streams;
  std::vector<CableExtras> cables;
  bool operator==(const PlanningExtras&) const = default;
};

const json::Object& describe(json::Type<StreamExtras>);
const json::Object& describe(json::Type<CableExtras>);
const json::Object& describe(json::Type<NodeExtras>);
const json::Object& describe(json::Type<PlanningExtras>);

}  // namespace takt::interchange
