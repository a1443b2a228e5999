// SPDX-License-Identifier: Apache-2.0
// A server without a network, and a client of it that says what it is told: for tests and for fuzzing.
#pragma once

#include "opcua/server/server.hpp"

namespace takt::opcua::test {

/// The same octets in every run.
class CountedRandom final : public security::RandomOctets {
 public:
  void fill(std::span<std::byte> octets) override {
    for (std::byte& each : octets)
      each = static_cast<std::byte>((state_ = state_ * 6364136223846793005U + 1442695040888963407U) >> 56);
  }

 private:
  std::uint64_t state_ = 1;
};

class RecordingHost final : public ProgramHost {
 public:
  struct Call {
    std::uint64_t serial;
    std::size_t program;
    program::Method method;
  };
  bool call(std::uint64_t serial, std::size_t program, program::Method method) override {
    if (calls.size() >= 1000) return false;
    calls.push_back({serial, program, method});
    return true;
  }
  std::vector<Call> calls;
};

class SilentLog final : public ServerLog {
 public:
  void refused(std::string_view, std::string_view what, std::string_view detail) override {
    ++refusals;
    last = std::string(what) + ": " + std::string(detail);
  }
  void rejected(std::string_view, const security::Certificate&) override { ++rejections; }
  std::size_t refusals = 0;
  std::size_t rejections = 0;
  std::string last;
};

inline Now at(std::int64_t ms) {
  return {sim::LocalTime() + milliseconds(ms), DateTime{(epoch_1970_s + 1'800'000'000) * 10'000'000 + ms * 10'000}};
}

inline const Identity& test_identity() {
  static const Identity made = [] {
    security::PrivateKey key = security::PrivateKey::generate(2048);
    security::OwnCertificate own;
    own.application_uri = "urn:test:takt:server";
    own.common_name = "server";
    own.valid_from = 1'700'000'000;
    own.valid_until = 1'900'000'000;
    security::Certificate certificate = self_signed(key, own);
    return Identity{std::move(key), std::move(certificate)};
  }();
  return made;
}

inline ServerSettings test_settings() {
  ServerSettings settings;
  settings.application_uri = "urn:test:takt:server";
  settings.application_name = "server";
  settings.endpoint_url = "opc.tcp://127.0.0.1:4840";
  settings.endpoints = {{SecurityPolicy::None, MessageSecurityMode::None}};
  settings.anonymous = true;
  settings.calls_without_encryption = true;
  return settings;
}

inline ServerSettings settings_with_users() {
  static const std::vector<std::byte> salt(16, std::byte{7});
  static const security::PasswordHash hash = security::PasswordHash::of("secret", salt);
  ServerSettings settings = test_settings();
  settings.users = {{"anna", hash, Role::operator_}, {"olaf", hash, Role::observer}};
  return settings;
}

inline ProgramDescription test_program() {
  ProgramDescription program;
  program.name = "cell";
  program.handshake = "robust";
  program.own = program.master = "plc";
  program.role = "master";
  program.participants = {"plc", "left"};
  program.peers = {"left"};
  program.cycle_ms = 1;
  return program;
}

struct Bench {
  explicit Bench(ServerSettings settings = test_settings())
      : server(std::move(settings), test_identity(), random, host, log, {test_program()}, at(0)) {}

  CountedRandom random;
  RecordingHost host;
  SilentLog log;
  Server server;
};

/// Over None, with a channel and, if it likes, a session. Requests and responses are bodies.
template <class BenchOf>
class PlainClientOf {
 public:
  explicit PlainClientOf(BenchOf& bench, std::int64_t now_ms = 0)
      : bench_(bench), id_(bench.server.connected("192.0.2.1:1000", at(now_ms))) {}

  ConnectionId id() const { return id_; }
  std::vector<std::byte> octets() {
    const Octets waiting = bench_.server.output(id_);
    std::vector<std::byte> taken(waiting.begin(), waiting.end());
    bench_.server.sent(id_, taken.size(), at(0));
    return taken;
  }
  void send(Octets octets, std::int64_t now_ms = 0) { bench_.server.received(id_, octets, at(now_ms)); }

  /// `most_octets` of a response that it takes; 0: any.
  void open(std::int64_t now_ms = 0, std::uint32_t lifetime_ms = 3'600'000, std::uint32_t most_octets = 0) {
    send(framed(MessageType::Hello, Hello{0, 65'536, 65'536, most_octets, 0, Text("opc.tcp://127.0.0.1:4840")}),
         now_ms);
    octets();
    OpenSecureChannelRequest request;
    request.security_mode = MessageSecurityMode::None;
    request.requested_lifetime = lifetime_ms;
    Encoder encoder;
    encode_message_header(encoder, MessageType::OpenChannel);
    encoder.put(std::uint32_t{0});
    encode(encoder, AsymmetricHeader{Text(info(SecurityPolicy::None).uri), {}, {}});
    encoder.put(++sequence_);
    encoder.put(++request_);
    encode_message(encoder, request);
    encoder.patch(4, static_cast<std::uint32_t>(encoder.position()));
    send(encoder.octets(), now_ms);
    const auto answer = octets();
    channel_ = answer.size() < 12 ? 0 : uadp::load_little_endian<std::uint32_t>(answer.data() + 8);
  }

  /// A MSG with a body that begins with its type.
  void send_body(Octets body, std::int64_t now_ms = 0) { send(chunk_of(body), now_ms); }
  std::vector<std::byte> chunk_of(Octets body) {
    Encoder encoder;
    encode_message_header(encoder, MessageType::Message);
    for (const std::uint32_t each : {channel_, std::uint32_t{1}, ++sequence_, ++request_}) encoder.put(each);
    encoder.put_octets(body);
    encoder.patch(4, static_cast<std::uint32_t>(encoder.position()));
    return encoder.take();
  }

  template <Structure Body>
  void send_request(Body body, std::int64_t now_ms = 0) {
    send_body(octets_of_request(std::move(body)), now_ms);
  }
  /// It has come, and the turn of the server has not.
  template <Structure Body>
  void send_later(Body body, std::int64_t now_ms = 0) {
    bench_.server.take_in(id_, chunk_of(octets_of_request(std::move(body))), at(now_ms));
  }
  template <Structure Body>
  std::vector<std::byte> octets_of_request(Body body) {
    body.request_header.authentication_token = token;
    body.request_header.request_handle = request_ + 1;
    Encoder encoder;
    encode_message(encoder, body);
    return encoder.take();
  }

  struct Received {
    std::uint32_t request = 0;
    NodeId type;
    std::vector<std::byte> body;
    StatusCode result = StatusCode::Good;

    template <Structure Body>
    Body as() const {
      Decoder decoder(body);
      Body made;
      if (type == NodeId(Body::encoding_id)) decode(decoder, made);
      return made;
    }
  };
  /// Whatever has come, each in one chunk.
  std::vector<Received> take() {
    std::vector<Received> all;
    MessageSplitter splitter(1 << 20);
    const auto waiting = octets();
    splitter.feed(waiting);
    while (const auto message = splitter.next()) {
      Received received;
      if (message->size() < symmetric_header_octets + sequence_header_octets) continue;
      received.request = uadp::load_little_endian<std::uint32_t>(message->data() + symmetric_header_octets + 4);
      Decoder decoder(message->subspan(symmetric_header_octets + sequence_header_octets));
      decode(decoder, received.type);
      const Octets rest = message->subspan(symmetric_header_octets + sequence_header_octets + decoder.position());
      received.body.assign(rest.begin(), rest.end());
      ResponseHeader header;
      decode(decoder, header);
      received.result = header.service_result;
      all.push_back(std::move(received));
    }
    return all;
  }
  template <Structure Response, Structure Body>
  Response ask(Body body, std::int64_t now_ms = 0) {
    send_request(std::move(body), now_ms);
    const auto all = take();
    return all.empty() ? Response() : all.back().template as<Response>();
  }
  template <Structure Body>
  StatusCode result_of(Body body, std::int64_t now_ms = 0) {
    send_request(std::move(body), now_ms);
    const auto all = take();
    return all.empty() ? StatusCode::BadUnexpectedError : all.back().result;
  }

  void begin_session(std::int64_t now_ms = 0) {
    CreateSessionRequest create;
    create.requested_session_timeout = 3'600'000;
    token = ask<CreateSessionResponse>(create, now_ms).authentication_token;
    ask<ActivateSessionResponse>(ActivateSessionRequest(), now_ms);
  }

  /// By name: the password goes encrypted, also where the channel is not. The result of the activation.
  StatusCode sign_in(const std::string& name, const std::string& password, std::int64_t now_ms = 0) {
    token = NodeId();
    const auto created = ask<CreateSessionResponse>(CreateSessionRequest(), now_ms);
    token = created.authentication_token;
    Encoder clear;
    clear.put(static_cast<std::uint32_t>(password.size() + created.server_nonce.value.size()));
    clear.put_octets(std::as_bytes(std::span(password.data(), password.size())));
    clear.put_octets(created.server_nonce.value);
    const PolicyInfo& policy = info(SecurityPolicy::Basic256Sha256);
    UserNameIdentityToken named;
    named.policy_id = Text("username_Basic256Sha256");
    named.user_name = Text(name);
    named.password = Bytes(*test_identity().key.public_key().encrypt(policy.encryption, clear.octets()));
    named.encryption_algorithm = Text(policy.encryption_uri);
    ActivateSessionRequest activate;
    activate.user_identity_token = extension_of(named);
    return result_of(activate, now_ms);
  }

  NodeId token;

 private:
  BenchOf& bench_;
  ConnectionId id_;
  std::uint32_t channel_ = 0;
  std::uint32_t sequence_ = 0;
  std::uint32_t request_ = 0;
};
using PlainClient = PlainClientOf<Bench>;

}  // namespace takt::opcua::test
