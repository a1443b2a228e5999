// SPDX-License-Identifier: Apache-2.0
// "server" in the file of a node: the OPC UA server (opc.tcp) of its Programs.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "json/fields.hpp"
#include "sim/time.hpp"

namespace takt::node {

enum class ServerPolicy : std::uint8_t { none, basic256_sha256, aes128_sha256_rsa_oaep, aes256_sha256_rsa_pss };
enum class ServerMode : std::uint8_t { sign, sign_and_encrypt };
enum class UserRole : std::uint8_t { observer, operator_, engineer, key_access };

/// Those that are absent are the server's own.
struct ServerLimits {
  json::Source where;
  std::optional<std::uint32_t> connections;
  std::optional<std::uint32_t> chunk_octets;
  std::optional<std::uint32_t> request_octets;
  std::optional<std::uint32_t> request_chunks;
  std::optional<std::uint32_t> output_octets;
  std::optional<std::uint32_t> channels_per_second;
  std::optional<std::uint32_t> sessions;
  std::optional<std::uint32_t> subscriptions;
  std::optional<std::uint32_t> subscriptions_of_session;
  std::optional<std::uint32_t> items;
  std::optional<std::uint32_t> queue;
  std::optional<std::uint32_t> event_queue;
  std::optional<std::uint32_t> publish_requests;
  std::optional<std::uint32_t> operations;
  std::optional<sim::Duration> hello_within;
  std::optional<sim::Duration> idle_channel;
  std::optional<sim::Duration> output_stall;
  std::optional<sim::Duration> call_within;
  std::optional<sim::Duration> least_session;
  std::optional<sim::Duration> most_session;
  std::optional<sim::Duration> least_token;
  std::optional<sim::Duration> most_token;
  std::optional<sim::Duration> least_publishing;
  std::optional<sim::Duration> session_grace;
  std::optional<sim::Duration> most_subscription;
  std::optional<sim::Duration> orphan_subscription;
  std::optional<std::uint32_t> session_octets;
  std::optional<std::uint32_t> user_octets;
  std::optional<std::uint32_t> all_octets;
  bool operator==(const ServerLimits&) const = default;
};

/// A SecurityGroup that a server gives the keys of.
struct ServedGroup {
  json::Source where;
  std::string keys;  ///< a file of keys
  sim::Duration key_lifetime = sim::Duration::from_ps(3'600'000'000'000'000);
  std::vector<std::string> users;  ///< who may have them; all with key-access if empty
  bool operator==(const ServedGroup&) const = default;
};
struct KeyServiceConfig {
  json::Source where;
  std::vector<ServedGroup> groups;
  std::uint32_t future_keys = 8;
  bool operator==(const KeyServiceConfig&) const = default;
};

struct ServerConfig {
  json::Source where;
  std::string endpoint;
  std::optional<std::string> application_uri;
  std::optional<std::string> pki;
  std::vector<ServerPolicy> policies = {ServerPolicy::basic256_sha256, ServerPolicy::aes128_sha256_rsa_oaep,
                                        ServerPolicy::aes256_sha256_rsa_pss};
  std::vector<ServerMode> modes = {ServerMode::sign_and_encrypt};
  bool anonymous = false;
  std::optional<std::string> users;
  bool calls_without_encryption = false;
  bool halt_without_encryption = false;
  std::optional<ServerLimits> limits;
  std::optional<KeyServiceConfig> key_service;
  bool operator==(const ServerConfig&) const = default;
};

/// "opc.tcp://127.0.0.1:4840": an IPv4 address, or "localhost", and a port; 0.0.0.0 for all.
struct EndpointAddress {
  std::string address;
  std::uint16_t port = 0;
};
std::optional<EndpointAddress> parse_endpoint(const std::string& url);
/// The same with the name of a host in place of the address (labels of letters, digits, hyphens and underscores).
std::optional<EndpointAddress> parse_named_endpoint(const std::string& url);
bool is_ipv4_address(const std::string& text);

const json::Enumeration& describe(json::Type<ServerPolicy>);
const json::Enumeration& describe(json::Type<ServerMode>);
const json::Enumeration& describe(json::Type<UserRole>);
const json::Object& describe(json::Type<ServerLimits>);
const json::Object& describe(json::Type<ServedGroup>);
const json::Object& describe(json::Type<KeyServiceConfig>);
const json::Object& describe(json::Type<ServerConfig>);

}  // namespace takt::node
