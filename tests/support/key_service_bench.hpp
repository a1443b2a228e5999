// SPDX-License-Identifier: Apache-2.0
// A server that is a key service, and clients that pull from it, without a network.
#pragma once

#include <functional>

#include "opcua/client/call_client.hpp"
#include "support/opcua_bench.hpp"

namespace takt::opcua::test {

/// One group, whose keys are of the number of their token.
class CountedKeys final : public KeyService {
 public:
  static security::Secret key(std::uint32_t token) {
    security::Secret octets(52);
    for (std::byte& each : octets.octets()) each = static_cast<std::byte>(token);
    return octets;
  }
  Answer<SecurityKeys> keys(const SecurityKeysRequest& request, std::string_view user) override {
    users.emplace_back(user);
    if (!(request.group == "cell")) return StatusCode::BadNotFound;
    SecurityKeys made{Text("http://opcfoundation.org/UA/SecurityPolicy#PubSub-Aes128-CTR"), 7, {}, 250, 1000};
    for (std::uint32_t i = 0; i <= std::min(request.count, 10U); ++i) made.keys.push_back(key(7 + i));
    return made;
  }
  std::vector<std::string> users;
};

inline const Identity& other_identity() {
  static const Identity made = [] {
    security::PrivateKey key = security::PrivateKey::generate(2048);
    security::OwnCertificate own;
    own.application_uri = "urn:test:takt:client";
    own.common_name = "client";
    own.valid_from = 1'700'000'000;
    own.valid_until = 1'900'000'000;
    security::Certificate certificate = self_signed(key, own);
    return Identity{std::move(key), std::move(certificate)};
  }();
  return made;
}

inline ServerSettings settings_with_keys() {
  ServerSettings settings = settings_with_users();
  settings.users.push_back({"emil", settings.users[0].password, Role::engineer});
  settings.users.push_back({"left", settings.users[0].password, Role::key_access});
  for (const SecurityPolicy each :
       {SecurityPolicy::Basic256Sha256, SecurityPolicy::Aes128Sha256RsaOaep, SecurityPolicy::Aes256Sha256RsaPss})
    settings.endpoints.push_back({each, MessageSecurityMode::SignAndEncrypt});
  settings.limits.private_key_operations = 1 << 20;
  return settings;
}

struct KeyBench {
  KeyBench() : server(settings_with_keys(), test_identity(), random, host, log, {test_program()}, at(0), &service) {
    TrustList trust;
    trust.trusted.push_back(other_identity().certificate);
    server.trust(std::move(trust));
    settings.endpoint_url = "opc.tcp://127.0.0.1:4840";
    settings.application_uri = "urn:test:takt:client";
    settings.application_name = "client";
    settings.user = "left";
    settings.password = security::Secret(std::as_bytes(std::span("secret", 6)));
  }

  std::unique_ptr<CallClient> client(CallMethodRequest what, std::int64_t now_ms = 0) {
    return std::make_unique<CallClient>(settings, other_identity(), trusted, random, std::move(what), at(now_ms));
  }
  /// To the end, or until neither side has anything to say.
  std::unique_ptr<CallClient> call(CallMethodRequest what, std::int64_t now_ms = 0) {
    auto made = client(std::move(what), now_ms);
    const ConnectionId id = server.connected("192.0.2.9:1000", at(now_ms));
    for (bool is_idle = false; !is_idle;) {
      is_idle = true;
      while (!made->output().empty()) {
        const Octets part = made->output().first(std::min(piece, made->output().size()));
        server.received(id, part, at(now_ms));
        made->sent(part.size());
        is_idle = false;
      }
      while (!server.output(id).empty()) {
        const Octets part = server.output(id).first(std::min(piece, server.output(id).size()));
        std::vector<std::byte> octets(part.begin(), part.end());
        server.sent(id, octets.size(), at(now_ms));
        if (touch) std::for_each(octets.begin(), octets.end(), touch);
        made->received(octets, at(now_ms));
        is_idle = false;
      }
    }
    server.disconnected(id);
    return made;
  }
  std::unique_ptr<CallClient> pull(const SecurityKeysRequest& request, std::int64_t now_ms = 0) {
    return call(call_of(request), now_ms);
  }

  CountedRandom random;
  RecordingHost host;
  SilentLog log;
  CountedKeys service;
  Server server;
  CallClientSettings settings;
  security::Certificate trusted = test_identity().certificate;
  std::size_t piece = 1 << 20;
  std::function<void(std::byte&)> touch;
};

}  // namespace takt::opcua::test
