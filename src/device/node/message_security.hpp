// SPDX-License-Identifier: Apache-2.0
// What the file of a node says of the security of its messages. Keys are in a file of their own.
#pragma once

#include <optional>
#include <string>

#include "json/fields.hpp"
#include "plant/message_security.hpp"
#include "security/secure_channel.hpp"
#include "sim/time.hpp"

// Words of files for a value of protocol code: a description is looked for in the namespace of what it describes.
namespace takt::security {
const json::Enumeration& describe(json::Type<Nonces>);
}  // namespace takt::security

namespace takt::node {

/// A key service, and as whom the node asks it.
struct KeyServiceAccess {
  json::Source where;
  std::string endpoint;
  std::string certificate;  ///< a file: the service's, the only one that is trusted
  std::string user;
  std::string password_file;
  std::optional<std::string> pki;
  bool operator==(const KeyServiceAccess&) const = default;
};

struct MessageSecurity {
  json::Source where;
  security::MessageMode mode = security::MessageMode::sign_and_encrypt;
  security::MessagePolicy policy = security::MessagePolicy::aes128_ctr;
  sim::Duration key_lifetime = sim::Duration::from_ps(3'600'000'000'000'000);
  std::optional<std::string> keys;  ///< a file, below the folder of the node's unless it begins with a slash; or
  std::optional<KeyServiceAccess> key_service;
  std::optional<std::string> group;  ///< needed with a service; of a file what it says
  std::optional<std::string> memory;
  security::Nonces nonces = security::Nonces::lives;
  std::optional<std::uint16_t> sender;  ///< of a node with topics, where no PublisherId is its own
  bool operator==(const MessageSecurity&) const = default;
};

const json::Object& describe(json::Type<KeyServiceAccess>);
const json::Object& describe(json::Type<MessageSecurity>);

}  // namespace takt::node
