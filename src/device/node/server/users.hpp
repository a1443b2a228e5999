// SPDX-License-Identifier: Apache-2.0
// The file of a server's users: names, roles and hashes of passwords.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "json/diagnostics.hpp"
#include "node/server_config.hpp"
#include "opcua/server/settings.hpp"

namespace takt::node {

struct UserEntry {
  json::Source where;
  std::string name;
  std::string password;  ///< "scrypt$..."
  UserRole role = UserRole::observer;
  bool operator==(const UserEntry&) const = default;
};
struct UserFile {
  json::Source where;
  std::vector<UserEntry> users;
  bool operator==(const UserFile&) const = default;
};
const json::Object& describe(json::Type<UserEntry>);
const json::Object& describe(json::Type<UserFile>);

/// The users of a file that nobody else may read. Nothing if there is a mistake.
std::optional<std::vector<opcua::User>> load_users(const std::string& path, json::Diagnostics& diagnostics);

/// What stands in such a file for a password.
std::string hash_of_password(const std::string& password);

}  // namespace takt::node
