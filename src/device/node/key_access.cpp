// SPDX-License-Identifier: Apache-2.0
#include "node/key_access.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>

#include "node/private_file.hpp"

namespace takt::node {
namespace {

constexpr std::size_t longest_password = 64;
constexpr std::streamsize longest_certificate = 1 << 16;

std::optional<security::Certificate> load_certificate(const std::string& path, const json::Place& named_at,
                                                      json::Diagnostics& diagnostics) {
  std::ifstream file(path, std::ios::binary);
  std::string text(static_cast<std::size_t>(longest_certificate), '\0');
  file.read(text.data(), longest_certificate);
  text.resize(static_cast<std::size_t>(std::max<std::streamsize>(file.gcount(), 0)));
  auto certificate = security::Certificate::from_der(std::as_bytes(std::span(text)));
  if (!certificate) certificate = security::Certificate::from_pem(text);
  if (!certificate)
    diagnostics.error(
        named_at, "no certificate",
        {json::quote(path), "a file with the certificate of the key service, as its own/certs/certificate.der"});
  return certificate;
}

std::optional<security::Secret> load_password(const std::string& path, const json::Place& named_at,
                                              json::Diagnostics& diagnostics) {
  auto text = read_private(path, "a password", named_at, diagnostics);
  if (!text) return std::nullopt;
  const std::size_t size = std::min(text->find_first_of("\r\n"), text->size());
  std::optional<security::Secret> password;
  if (size == 0 || size > longest_password)
    diagnostics.error(named_at, "no password",
                      {"a first line of " + std::to_string(size) + " octets", "1 to 64 octets"});
  else
    password.emplace(std::as_bytes(std::span(*text).first(size)));
  wipe(*text);
  return password;
}

}  // namespace

std::optional<LoadedKeyAccess> load_key_access(const MessageSecurity& security, json::Diagnostics& diagnostics) {
  const KeyServiceAccess& access = *security.key_service;
  const auto address = parse_named_endpoint(access.endpoint);
  if (!address || address->address == "0.0.0.0")
    diagnostics.error(access.where.at("endpoint"), "no endpoint",
                      {json::quote(access.endpoint),
                       "\"opc.tcp://\", an IPv4 address or the name of a host, \":\" and a port, as in "
                       "\"opc.tcp://sks.plant:4840\""});
  if (!security.group)
    diagnostics.error(access.where.place(), "keys of no group",
                      {"a key service without \"group\" beside it", "the SecurityGroup, as in \"group\": \"cell\""});
  if (security.where.has("key_lifetime"))
    diagnostics.error(security.where.at("key_lifetime"), "a lifetime of keys that a service gives",
                      {"both", "none: the service tells it"});
  auto certificate = load_certificate(beside(access.where.at("certificate"), access.certificate),
                                      access.where.at("certificate"), diagnostics);
  auto password = load_password(beside(access.where.at("password_file"), access.password_file),
                                access.where.at("password_file"), diagnostics);
  if (!address || !security.group || !certificate || !password) return std::nullopt;
  return LoadedKeyAccess{*security.group, *address, std::move(*certificate), std::move(*password)};
}

LoadedSecurity load_security(const MessageSecurity& security, json::Diagnostics& diagnostics) {
  LoadedSecurity loaded;
  const json::Place place = security.where.at("keys");
  if (security.keys) loaded.keys = load_keys(beside(place, *security.keys), place, diagnostics);
  if (security.key_service) loaded.access = load_key_access(security, diagnostics);
  if (loaded.keys && loaded.keys->policy != security.policy)
    diagnostics.error(place, "keys of another policy", {"other lengths", "those of \"policy\" beside it"});
  if (loaded.keys && security.group && *security.group != loaded.keys->group)
    diagnostics.error(security.where.at("group"), "keys of another group",
                      {json::quote(loaded.keys->group) + " in the file", json::quote(*security.group)});
  return loaded;
}

std::vector<LoadedGroup> load_groups(const ServerConfig& server, json::Diagnostics& diagnostics) {
  const KeyServiceConfig& service = *server.key_service;
  const bool encrypts =
      std::find(server.modes.begin(), server.modes.end(), ServerMode::sign_and_encrypt) != server.modes.end() &&
      std::any_of(server.policies.begin(), server.policies.end(),
                  [](ServerPolicy each) { return each != ServerPolicy::none; });
  if (!encrypts)
    diagnostics.error(
        service.where.place(), "keys that nobody can have",
        {"a server that does not encrypt", "\"SignAndEncrypt\" among its \"modes\", and a policy beside None"});
  if (!server.users)
    diagnostics.error(service.where.place(), "keys that nobody can have",
                      {"a server without users", "\"users\": a file in which nodes have the role \"key-access\""});
  std::vector<LoadedGroup> groups;
  for (const ServedGroup& each : service.groups) {
    const json::Place place = each.where.at("keys");
    auto keys = load_keys(beside(place, each.keys), place, diagnostics);
    if (!keys) continue;
    if (std::any_of(groups.begin(), groups.end(),
                    [&](const LoadedGroup& other) { return other.keys.group == keys->group; }))
      diagnostics.error(place, "a group twice", {json::quote(keys->group), "one file for each SecurityGroup"});
    groups.push_back({std::move(*keys), each.key_lifetime, each.users});
  }
  return groups;
}

}  // namespace takt::node
