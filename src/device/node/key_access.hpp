// SPDX-License-Identifier: Apache-2.0
// What a node needs to pull keys from a key service, and what a server needs to be one: read from their files and
// checked.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "node/key_file.hpp"
#include "node/message_security.hpp"
#include "node/server_config.hpp"
#include "security/certificate.hpp"

namespace takt::node {

struct LoadedKeyAccess {
  std::string group;
  EndpointAddress address;  ///< an IPv4 address, or the name of a host
  security::Certificate certificate;
  security::Secret password;
};
/// Nothing if there was a mistake.
std::optional<LoadedKeyAccess> load_key_access(const MessageSecurity& security, json::Diagnostics& diagnostics);

/// What `security` needs: keys of a file, or the way to a service.
struct LoadedSecurity {
  std::optional<LoadedKeys> keys;
  std::optional<LoadedKeyAccess> access;
};
LoadedSecurity load_security(const MessageSecurity& security, json::Diagnostics& diagnostics);

/// A SecurityGroup that the server of this node gives the keys of.
struct LoadedGroup {
  LoadedKeys keys;
  sim::Duration lifetime;
  std::vector<std::string> users;  ///< empty: all who may have keys
};
std::vector<LoadedGroup> load_groups(const ServerConfig& server, json::Diagnostics& diagnostics);

}  // namespace takt::node
