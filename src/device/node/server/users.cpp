// SPDX-License-Identifier: Apache-2.0
#include "node/server/users.hpp"

#include <algorithm>

#include "json/reader.hpp"
#include "node/private_file.hpp"
#include "security/random.hpp"

namespace takt::node {

const json::Object& describe(json::Type<UserEntry>) {
  static constexpr json::Field fields[] = {
      json::required<&UserEntry::name>("name", "As the client gives it.", {.min_length = 1, .max_length = 64}),
      json::required<&UserEntry::password>("password",
                                           "The hash of the password: `takt node --hash-password` makes it.",
                                           {.min_length = 1, .max_length = 256}),
      json::required<&UserEntry::role>("role", "What the user may do."),
  };
  static constexpr json::Object table = json::object<UserEntry>("user", "A user of the server.", fields);
  return table;
}

const json::Object& describe(json::Type<UserFile>) {
  static constexpr json::Field fields[] = {
      json::required<&UserFile::users>("users", "Whom the server lets in.", {.min_items = 1, .max_items = 1000})};
  static constexpr json::Object table = json::object<UserFile>("users", "The users of an OPC UA server.", fields);
  return table;
}

std::optional<std::vector<opcua::User>> load_users(const std::string& path, json::Diagnostics& diagnostics) {
  json::Place place;
  place.file = path;
  auto text = read_private(path, "users", place, diagnostics);
  if (!text) return std::nullopt;
  const auto document = json::parse(*text, path, diagnostics);
  wipe(*text);
  if (!document) return std::nullopt;
  UserFile file;
  json::decode(*document, file, diagnostics);
  if (diagnostics.has_errors()) return std::nullopt;
  std::vector<opcua::User> users;
  for (const UserEntry& each : file.users) {
    const auto hash = security::PasswordHash::parse(each.password);
    const bool is_known =
        std::any_of(users.begin(), users.end(), [&](const opcua::User& other) { return other.name == each.name; });
    if (!hash)
      diagnostics.error(each.where.at("password"), "no hash of a password",
                        {"something else", "what takt node --hash-password prints"});
    if (is_known) diagnostics.error(each.where.at("name"), "a user twice", {json::quote(each.name), "another name"});
    if (hash) users.push_back({each.name, *hash, static_cast<opcua::Role>(each.role)});
  }
  return diagnostics.has_errors() ? std::nullopt : std::optional(std::move(users));
}

std::string hash_of_password(const std::string& password) {
  std::array<std::byte, 16> salt{};
  security::SystemRandom().fill(salt);
  return security::PasswordHash::of(password, salt).text();
}

}  // namespace takt::node
