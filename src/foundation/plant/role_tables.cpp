// SPDX-License-Identifier: Apache-2.0
// The words of roles.
#include "plant/role.hpp"

namespace takt::plant {

using json::name;
using json::required;

const json::Object& describe(json::Type<Role>) {
  static constexpr json::Field fields[] = {
      required<&Role::name>("name", "Unique in the program; stands for the node that has the role.",
                            {.min_length = 1, .max_length = 200}),
      required<&Role::skill>("skill", "The skill that a node must offer to have it.",
                             {.min_length = 1, .max_length = 200}),
  };
  static constexpr json::Object table =
      json::object<Role>("role", "A place in a group for any node that offers a skill.", fields);
  return table;
}

const json::Enumeration& describe(json::Type<OnReplacement>) {
  static constexpr json::EnumName names[] = {
      name(OnReplacement::stay_halted, "stay-halted", "somebody must call Start"),
      name(OnReplacement::restart, "restart", "the master starts the group again by itself"),
  };
  static constexpr json::Enumeration table =
      json::enumeration<OnReplacement>("what follows when a role has a node again", names);
  return table;
}

}  // namespace takt::plant
