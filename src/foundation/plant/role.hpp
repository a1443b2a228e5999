// SPDX-License-Identifier: Apache-2.0
// What files say of roles that a group needs, instead of slaves by name.
#pragma once

#include <cstdint>
#include <string>

#include "json/fields.hpp"

namespace takt::plant {

/// A place in a group for any node that offers a skill.
struct Role {
  json::Source where;
  std::string name;
  std::string skill;
  bool operator==(const Role&) const = default;
};

enum class OnReplacement : std::uint8_t { stay_halted, restart };

const json::Object& describe(json::Type<Role>);
const json::Enumeration& describe(json::Type<OnReplacement>);

}  // namespace takt::plant
