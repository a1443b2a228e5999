// SPDX-License-Identifier: Apache-2.0
// What files say of the security of a Program's messages: the words for modes and policies, wherever it runs, and what
// a scenario says.
#pragma once

#include <cstdint>

#include "json/fields.hpp"
#include "security/message_policy.hpp"

// Words of files for values of protocol code: a description is looked for in the namespace of what it describes.
namespace takt::security {
const json::Enumeration& describe(json::Type<MessageMode>);
const json::Enumeration& describe(json::Type<MessagePolicy>);
}  // namespace takt::security

namespace takt::plant {

/// Of a Program in a scenario. Real nodes say it for all of their Programs, with their keys.
struct ProgramSecurity {
  json::Source where;
  security::MessageMode mode = security::MessageMode::sign_and_encrypt;
  security::MessagePolicy policy = security::MessagePolicy::aes128_ctr;
  bool operator==(const ProgramSecurity&) const = default;
};

const json::Object& describe(json::Type<ProgramSecurity>);

}  // namespace takt::plant
