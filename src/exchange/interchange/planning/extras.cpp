// SPDX-License-Identifier: Apache-2.0
#include "interchange/planning/extras.hpp"

namespace takt::interchange {

using json::optional;
using json::required;

const json::Object& describe(json::Type<StreamExtras>) {
  static constexpr json::Field fields[] = {
      required<&StreamExtras::stream>("stream", "Its name in the problem."),
      optional<&StreamExtras::name>("name", "Its name in the scenario, if that is another.",
                                    {.min_length = 1, .max_length = 200}),
      optional<&StreamExtras::encapsulation>("encapsulation", "What stands before the payload."),
      optional<&StreamExtras::pcp>("pcp", "Priority in a VLAN tag; untagged if absent.", {.max = 7}),
      optional<&StreamExtras::vlan>("vlan", "VLAN identifier in the tag.", {.max = 4094}),
      required<&StreamExtras::payload>("payload", "Octets of user data in each frame.", {.max = sim::Octets{1500}}),
      optional<&StreamExtras::is_burst>("burst", "The scenario calls its frames a burst."),
  };
  static constexpr json::Object table =
      json::object<StreamExtras>("stream_extras", "What a problem does not say of a stream.", fields);
  return table;
}

const json::Object& describe(json::Type<CableExtras>) {
  static constexpr json::Field fields[] = {
      required<&CableExtras::link>("link", "The name of one direction in the problem."),
      required<&CableExtras::from>("from", "The port from which it goes.", {.max = 1023}),
      required<&CableExtras::to>("to", "The port to which it goes.", {.max = 1023}),
  };
  static constexpr json::Object table = json::object<CableExtras>("cable_extras", "The ports of a cable.", fields);
  return table;
}

const json::Object& describe(json::Type<NodeExtras>) {
  static constexpr json::Field fields[] = {
      required<&NodeExtras::node>("node", "Its name in the problem."),
      required<&NodeExtras::name>("name", "Its name in the scenario.", {.min_length = 1, .max_length = 200}),
  };
  static constexpr json::Object table = json::object<NodeExtras>("node_extras", "The name of a node.", fields);
  return table;
}

const json::Object& describe(json::Type<PlanningExtras>) {
  using namespace sim::literals;  // NOLINT: units in limits
  static constexpr json::Field fields[] = {
      optional<&PlanningExtras::duration>("duration", "Of the scenario.", {.min = 1_ns}),
      optional<&PlanningExtras::seed>("seed", "Of the scenario."),
      optional<&PlanningExtras::nodes>("nodes", "Names of nodes, where the problem has others."),
      optional<&PlanningExtras::streams>("streams", "Of each stream."),
      optional<&PlanningExtras::cables>("cables",
                                        "Of each cable, where ports are not numbered in the order of the links."),
  };
  static constexpr json::Object table =
      json::object<PlanningExtras>("planning_extras", "What a problem does not say of a scenario.", fields);
  return table;
}

}  // namespace takt::interchange
