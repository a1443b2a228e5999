// SPDX-License-Identifier: Apache-2.0
// The words of "server" in node files.
#include <arpa/inet.h>

#include <algorithm>
#include <charconv>

#include "node/server_config.hpp"

namespace takt::node {
namespace {

using json::name;
using json::optional;
using json::required;
using namespace sim::literals;  // NOLINT: units in limits

constexpr std::uint16_t opc_tcp_port = 4840;

/// Host, as it is written, and port.
std::optional<EndpointAddress> split(const std::string& url) {
  constexpr std::string_view scheme = "opc.tcp://";
  if (!url.starts_with(scheme)) return std::nullopt;
  const std::string_view rest = std::string_view(url).substr(scheme.size());
  const std::size_t colon = rest.find(':');
  EndpointAddress made{std::string(rest.substr(0, colon)), opc_tcp_port};
  if (colon == std::string_view::npos) return made;
  const char* const end = rest.data() + rest.size();
  const auto parsed = std::from_chars(rest.data() + colon + 1, end, made.port);
  return parsed.ec == std::errc() && parsed.ptr == end && made.port != 0 ? std::optional(made) : std::nullopt;
}

bool is_label(std::string_view text) {
  constexpr std::size_t longest = 63;
  const auto is_letter_or_digit = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
  };
  return !text.empty() && text.size() <= longest && text.front() != '-' && text.back() != '-' &&
         std::all_of(text.begin(), text.end(), [&](char c) { return is_letter_or_digit(c) || c == '-' || c == '_'; });
}

/// The last label is no number: 10.0.0 and 10.0.0.300 are addresses with a mistake.
bool is_host_name(std::string_view text) {
  constexpr std::size_t longest = 253;
  if (text.size() > longest) return false;
  for (;;) {
    const std::size_t dot = text.find('.');
    const std::string_view label = text.substr(0, dot);
    if (!is_label(label)) return false;
    if (dot == std::string_view::npos) return label.find_first_not_of("0123456789") != std::string_view::npos;
    text.remove_prefix(dot + 1);
  }
}

}  // namespace

bool is_ipv4_address(const std::string& text) {
  in_addr address = {};
  return ::inet_pton(AF_INET, text.c_str(), &address) == 1;
}

std::optional<EndpointAddress> parse_endpoint(const std::string& url) {
  auto made = split(url);
  if (made && made->address == "localhost") made->address = "127.0.0.1";
  return made && is_ipv4_address(made->address) ? made : std::nullopt;
}

std::optional<EndpointAddress> parse_named_endpoint(const std::string& url) {
  if (auto made = parse_endpoint(url)) return made;
  auto made = split(url);
  return made && is_host_name(made->address) ? made : std::nullopt;
}

const json::Enumeration& describe(json::Type<ServerPolicy>) {
  static constexpr json::EnumName names[] = {
      name(ServerPolicy::none, "None", "no security: for reading, where the network is trusted"),
      name(ServerPolicy::basic256_sha256, "Basic256Sha256", "RSA PKCS #1, AES-256, SHA-256"),
      name(ServerPolicy::aes128_sha256_rsa_oaep, "Aes128_Sha256_RsaOaep", "RSA PKCS #1 and OAEP, AES-128, SHA-256"),
      name(ServerPolicy::aes256_sha256_rsa_pss, "Aes256_Sha256_RsaPss", "RSA PSS and OAEP, AES-256, SHA-256")};
  static constexpr json::Enumeration table = json::enumeration<ServerPolicy>("a security policy", names);
  return table;
}

const json::Enumeration& describe(json::Type<ServerMode>) {
  static constexpr json::EnumName names[] = {
      name(ServerMode::sign, "Sign", "signed, and readable by everybody on the way"),
      name(ServerMode::sign_and_encrypt, "SignAndEncrypt", "signed and encrypted")};
  static constexpr json::Enumeration table = json::enumeration<ServerMode>("a message security mode", names);
  return table;
}

const json::Enumeration& describe(json::Type<UserRole>) {
  static constexpr json::EnumName names[] = {
      name(UserRole::observer, "observer", "reads and subscribes"),
      name(UserRole::operator_, "operator", "calls methods as well"),
      name(UserRole::engineer, "engineer", "an operator who also looks after the trust list"),
      name(UserRole::key_access, "key-access",
           "a node that gets keys of SecurityGroups; it reads, and calls nothing else")};
  static constexpr json::Enumeration table = json::enumeration<UserRole>("a role", names);
  return table;
}

const json::Object& describe(json::Type<ServerLimits>) {
  static constexpr json::Field fields[] = {
      optional<&ServerLimits::connections>(
          "connections",
          "At once; 100 if absent. When there are more, the oldest without a session goes of the host that has most.",
          {.min = 2, .max = 1000}),
      optional<&ServerLimits::chunk_octets>("chunk_octets", "Of a chunk; 65536 if absent.",
                                            {.min = 8192, .max = 1'048'576}),
      optional<&ServerLimits::request_octets>("request_octets", "Of a request; 1 MiB if absent.",
                                              {.min = 8192, .max = 16'777'216}),
      optional<&ServerLimits::request_chunks>("request_chunks", "Of a request; 64 if absent.", {.min = 1, .max = 1024}),
      optional<&ServerLimits::output_octets>("output_octets",
                                             "Waiting for a client that does not read; 4 MiB if absent.",
                                             {.min = 65'536, .max = 67'108'864}),
      optional<&ServerLimits::channels_per_second>(
          "channels_per_second",
          "Secured channels that are opened, and as many that are renewed with a session; 12 of the longest keys if "
          "absent, and more of shorter ones. More wait.",
          {.min = 1, .max = 1000}),
      optional<&ServerLimits::sessions>(
          "sessions", "At once; 50 if absent. For users others go, and those without a connection first.",
          {.min = 1, .max = 1000}),
      optional<&ServerLimits::subscriptions>("subscriptions", "Of all sessions; 200 if absent.",
                                             {.min = 1, .max = 10'000}),
      optional<&ServerLimits::subscriptions_of_session>("subscriptions_of_session", "20 if absent.",
                                                        {.min = 1, .max = 1000}),
      optional<&ServerLimits::items>("items", "Monitored items of a subscription; 1000 if absent.",
                                     {.min = 1, .max = 100'000}),
      optional<&ServerLimits::queue>("queue", "Values of a monitored item that wait; 100 if absent.",
                                     {.min = 1, .max = 10'000}),
      optional<&ServerLimits::event_queue>("event_queue", "Events of a monitored item that wait; 1000 if absent.",
                                           {.min = 1, .max = 100'000}),
      optional<&ServerLimits::publish_requests>("publish_requests", "Of a session that wait; 40 if absent.",
                                                {.min = 2, .max = 1000}),
      optional<&ServerLimits::operations>(
          "operations", "Of a request: nodes to read, methods to call, items to create; 1000 if absent.",
          {.min = 1, .max = 10'000}),
      optional<&ServerLimits::hello_within>(
          "hello_within", "In which a connection says Hello, and then opens its channel; 10 s if absent.",
          {.min = 100_ms, .max = 120_s}),
      optional<&ServerLimits::idle_channel>("idle_channel",
                                            "How long a channel is kept without a session; 60 s if absent.",
                                            {.min = 100_ms, .max = 3600_s}),
      optional<&ServerLimits::output_stall>("output_stall",
                                            "How long a client may not read what waits for it; 30 s if absent.",
                                            {.min = 100_ms, .max = 3600_s}),
      optional<&ServerLimits::call_within>("call_within", "In which the Program answers a call; 5 s if absent.",
                                           {.min = 10_ms, .max = 60_s}),
      optional<&ServerLimits::least_session>("least_session", "Shortest time-out of a session; 10 s if absent.",
                                             {.min = 100_ms, .max = 3600_s}),
      optional<&ServerLimits::most_session>("most_session", "Longest time-out of a session; 1 h if absent.",
                                            {.min = 1_s, .max = 86'400_s}),
      optional<&ServerLimits::least_token>("least_token", "Shortest lifetime of a channel's keys; 10 s if absent.",
                                           {.min = 100_ms, .max = 3600_s}),
      optional<&ServerLimits::most_token>("most_token", "Longest lifetime of a channel's keys; 1 h if absent.",
                                          {.min = 1_s, .max = 86'400_s}),
      optional<&ServerLimits::least_publishing>("least_publishing", "Shortest publishing interval; 10 ms if absent.",
                                                {.min = 1_ms, .max = 60_s}),
      optional<&ServerLimits::session_grace>(
          "session_grace",
          "How long a session without a connection keeps its place when others want it; 10 s if absent.",
          {.min = 100_ms, .max = 3600_s}),
      optional<&ServerLimits::most_subscription>(
          "most_subscription", "Longest lifetime of a subscription; 1 h if absent.", {.min = 1_s, .max = 86'400_s}),
      optional<&ServerLimits::orphan_subscription>(
          "orphan_subscription", "How long a subscription lives whose session is gone; 2 min if absent.",
          {.min = 100_ms, .max = 86'400_s}),
      optional<&ServerLimits::session_octets>(
          "session_octets",
          "Of memory for filters, queues, messages, requests and responses of a session; 4 MiB if absent.",
          {.min = 65'536, .max = 268'435'456}),
      optional<&ServerLimits::user_octets>(
          "user_octets", "The same for all sessions of a user, or of a host without a name; 8 MiB if absent.",
          {.min = 65'536, .max = 268'435'456}),
      optional<&ServerLimits::all_octets>("all_octets", "The same for all sessions; 16 MiB if absent.",
                                          {.min = 65'536, .max = 1'073'741'824}),
  };
  static constexpr json::Object table = json::object<ServerLimits>("server_limits", "How much a server takes.", fields);
  return table;
}

const json::Object& describe(json::Type<ServedGroup>) {
  static constexpr json::Field fields[] = {
      required<&ServedGroup::keys>(
          "keys",
          "The file with its keys, from the folder of this file. It is refused if others than its owner may read it.",
          {.min_length = 1, .max_length = 4096}),
      optional<&ServedGroup::key_lifetime>("key_lifetime", "How long each key is used; 1 h if absent.",
                                           {.min = 1_s, .max = 86'400_s}),
      optional<&ServedGroup::users>("users", "Users with key-access who may have them; all of these if absent.",
                                    {.min_items = 1, .max_items = 1000}),
  };
  static constexpr json::Object table = json::object<ServedGroup>(
      "served_group", "A SecurityGroup that a key service gives the keys of.", fields, {.shorthand = "keys"});
  return table;
}

const json::Object& describe(json::Type<KeyServiceConfig>) {
  static constexpr json::Field fields[] = {
      required<&KeyServiceConfig::groups>("groups", "Its SecurityGroups: each a file of keys, or an object.",
                                          {.min_items = 1, .max_items = 256}),
      optional<&KeyServiceConfig::future_keys>(
          "future_keys", "How many keys behind the current one are given at most; 8 if absent.", {.min = 1, .max = 63}),
  };
  static constexpr json::Object table = json::object<KeyServiceConfig>(
      "key_service",
      "A Security Key Service (OPC 10000-14, 8.3): GetSecurityKeys for users with key-access over encrypted channels.",
      fields);
  return table;
}

const json::Object& describe(json::Type<ServerConfig>) {
  static constexpr json::Field fields[] = {
      required<&ServerConfig::endpoint>(
          "endpoint",
          "\"opc.tcp://127.0.0.1:4840\": the IPv4 address and the port that it listens at; 0.0.0.0 for all addresses.",
          {.min_length = 1, .max_length = 256}),
      optional<&ServerConfig::application_uri>("application_uri",
                                               "Who it is, also in its certificate; urn:takt:NODE if absent.",
                                               {.min_length = 1, .max_length = 256}),
      optional<&ServerConfig::pki>("pki",
                                   "Folder of its key, its certificate and whom it trusts, made at the first start; "
                                   "NODE-pki beside this file if absent.",
                                   {.min_length = 1, .max_length = 4096}),
      optional<&ServerConfig::policies>("policies", "Security policies that it offers; all but None if absent.",
                                        {.min_items = 1, .max_items = 4}),
      optional<&ServerConfig::modes>("modes", "Security modes that it offers with them; SignAndEncrypt if absent.",
                                     {.min_items = 1, .max_items = 2}),
      optional<&ServerConfig::anonymous>("anonymous", "Lets clients in without a name, as observers."),
      optional<&ServerConfig::users>("users", "File of users, which only its owner may read (docs/opcua-server.md).",
                                     {.min_length = 1, .max_length = 4096}),
      optional<&ServerConfig::calls_without_encryption>("calls_without_encryption",
                                                        "Operators may call methods over None and Sign, too."),
      optional<&ServerConfig::halt_without_encryption>("halt_without_encryption",
                                                       "Operators may call Halt over None and Sign, too."),
      optional<&ServerConfig::limits>("limits", "How much it takes."),
      optional<&ServerConfig::key_service>(
          "key_service", "It is a key service, too: other nodes pull the keys of their messages from it."),
  };
  static constexpr json::Object table = json::object<ServerConfig>(
      "server", "The OPC UA server (opc.tcp) of a node: its Programs for OPC UA clients.", fields);
  return table;
}

}  // namespace takt::node
