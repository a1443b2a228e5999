// SPDX-License-Identifier: Apache-2.0
// Any octets at a client that pulls keys: the first says how far the service is sound. Raw; in an OPN that the service
// has signed and encrypted; as answers in a channel of the service; as the outputs of GetSecurityKeys; and what became
// of them at the keys of a node. Neither crash nor hang, bounded memory, and the client comes to an end.
#include <cstring>
#include <limits>

#include "security/pull_plan.hpp"
#include "security/pulled_keys.hpp"
#include "support/key_service_bench.hpp"

namespace {

using namespace takt;
using namespace takt::opcua;
using test::at;

class Source {
 public:
  explicit Source(Octets octets) : octets_(octets) {}
  std::uint8_t octet() {
    const Octets one = take(1);
    return one.empty() ? std::uint8_t{0} : static_cast<std::uint8_t>(one[0]);
  }
  template <class T>
  T number() {
    T value = 0;
    const Octets octets = take(sizeof value);
    std::memcpy(&value, octets.data(), octets.size());
    return value;
  }
  Octets take(std::size_t most) {
    const Octets taken = octets_.first(std::min(most, octets_.size()));
    octets_ = octets_.subspan(taken.size());
    return taken;
  }
  bool is_empty() const { return octets_.empty(); }

 private:
  Octets octets_;
};

CallClientSettings settings_of_client() {
  CallClientSettings settings;
  settings.endpoint_url = "opc.tcp://127.0.0.1:4840";
  settings.application_uri = "urn:test:takt:client";
  settings.application_name = "client";
  settings.user = "left";
  settings.password = security::Secret(std::as_bytes(std::span("secret", 6)));
  return settings;
}

/// The outputs of GetSecurityKeys, of which each may be anything.
CallMethodResult any_result(Source& source) {
  SecurityKeys keys{Text(security::uri_of(security::MessagePolicy::aes128_ctr)),
                    source.number<std::uint32_t>(),
                    {},
                    source.number<double>(),
                    source.number<double>()};
  for (int i = source.octet() % 80; i > 0; --i)
    keys.keys.emplace_back(source.octet() % 8 == 0 ? std::size_t{source.octet()} : std::size_t{52});
  CallMethodResult result = result_of(keys);
  const auto which = source.octet();
  if (which < result.output_arguments.size())
    result.output_arguments[which] = which % 2 == 0 ? Variant() : Variant(Text("no number"));
  if (which == 7) result.output_arguments.pop_back();
  return result;
}

/// A service that has the key of its certificate and says what the input says.
class Service {
 public:
  explicit Service(Source& source) : source_(source) {}

  void run() {
    const CallClientSettings settings = settings_of_client();
    test::CountedRandom random;
    CallClient client(settings, test::other_identity(), test::test_identity().certificate, random,
                      call_of({Text("cell"), 0, 4}), at(0));
    const auto stages = source_.octet() % 6;
    if (stages > 0) client.received(framed(MessageType::Acknowledge, Acknowledge{0, 65'536, 65'536, 0, 0}), at(0));
    client.sent(client.output().size());
    if (stages > 1) open(client, stages == 2);
    if (stages > 3) answer(client, session());
    if (stages > 4) answer(client, ActivateSessionResponse());
    TAKT_CHECK(stages == 2 || !client.is_over(), "what is sound is believed");
    for (int i = 0; i < 50 && !source_.is_empty() && !client.is_over(); ++i) say_anything(client);
    client.advance(at(10'000));
    TAKT_CHECK(client.is_over(), "it ends");
    if (client.problem().empty()) keys_in(client.result());
  }

 private:
  /// An OPN that is sound, or one whose body is not.
  void open(CallClient& client, bool is_any) {
    Encoder body;
    OpenSecureChannelResponse response;
    response.response_header.request_handle = ++request_;
    response.security_token = {7, 1, at(0).utc, 60'000};
    response.server_nonce = Bytes(std::vector<std::byte>(nonce_octets));
    if (is_any)
      body.put_octets(source_.take(source_.octet()));
    else
      encode_message(body, response);
    const auto& client_certificate = test::other_identity().certificate;
    const auto chunk =
        sealed_open(7, policy_, {1, request_}, body.octets(), test::test_identity(), &client_certificate);
    channel_.emplace(7, ChannelSecurity{policy_.policy, MessageSecurityMode::SignAndEncrypt}, client_certificate, 1U,
                     Side::server, 1U);
    test::CountedRandom random;  // that of the client: its nonce is known here
    std::vector<std::byte> nonce(nonce_octets);
    random.fill(nonce);
    session_nonce_.resize(nonce_octets);
    random.fill(session_nonce_);
    channel_->issue(at(0).local, at(0).utc, 60'000, {}, nonce, response.server_nonce.value);
    client.received(*chunk, at(0));
  }

  CreateSessionResponse session() const {
    CreateSessionResponse response;
    response.authentication_token = NodeId(1, 1);
    const auto& own = test::test_identity();
    response.server_nonce = Bytes(std::vector<std::byte>(nonce_octets));
    response.server_certificate = Bytes({own.certificate.der().begin(), own.certificate.der().end()});
    std::vector<std::byte> is_signed(test::other_identity().certificate.der().begin(),
                                     test::other_identity().certificate.der().end());
    is_signed.insert(is_signed.end(), session_nonce_.begin(), session_nonce_.end());
    response.server_signature = {Text(policy_.signature_uri), Bytes(own.key.sign(policy_.signature, is_signed))};
    EndpointDescription endpoint;
    endpoint.security_mode = MessageSecurityMode::SignAndEncrypt;
    endpoint.security_policy_uri = Text(policy_.uri);
    endpoint.user_identity_tokens.push_back({Text("user"), UserTokenType::UserName, {}, {}, {}});
    response.server_endpoints.push_back(endpoint);
    return response;
  }

  template <Structure Response>
  void answer(CallClient& client, Response response) {
    response.response_header.request_handle = ++request_;
    Encoder encoder;
    encode_message(encoder, response);
    send(client, encoder.octets());
  }

  void send(CallClient& client, Octets body) {
    std::vector<std::byte> out;
    if (channel_) channel_->seal_message(request_, body, {}, out);
    client.received(out, at(1));
  }

  void say_anything(CallClient& client) {
    const auto how = source_.octet();
    if (!channel_ || how % 8 == 0) return client.received(source_.take(1U + source_.octet()), at(1));
    ++request_;
    if (how % 8 == 1) {
      CallResponse response;
      response.response_header.request_handle = request_;
      response.results.push_back(any_result(source_));
      Encoder encoder;
      encode_message(encoder, response);
      return send(client, encoder.octets());
    }
    constexpr std::uint32_t types[] = {464, 470, 715, 397, 1};
    Encoder encoder;
    encode(encoder, NodeId(types[source_.octet() % std::size(types)]));
    if (how % 8 < 5) {
      ResponseHeader header;
      header.request_handle = request_;
      encode(encoder, header);
    }
    encoder.put_octets(source_.take(source_.octet()));
    send(client, encoder.octets());
  }

  Source& source_;
  const PolicyInfo& policy_ = info(SecurityPolicy::Basic256Sha256);
  std::optional<SecureChannel> channel_;
  std::vector<std::byte> session_nonce_;
  std::uint32_t request_ = 0;
};

/// Answers of a service, one behind the other, at the keys of a node.
void feed_keys(Source& source) {
  security::PulledKeys keys(security::MessagePolicy::aes128_ctr);
  security::KeyRing ring(security::MessagePolicy::aes128_ctr, {1, std::numeric_limits<std::int64_t>::max(), 0},
                         std::make_unique<security::ListedKeys>(1, std::vector<security::Secret>()));
  security::PullPlan plan;
  std::int64_t now = 0;
  std::int64_t wished = std::numeric_limits<std::int64_t>::min();
  std::uint32_t last = 0;
  for (int i = 0; i < 100 && !source.is_empty(); ++i) {
    now += std::int64_t{source.number<std::uint16_t>()} * 1'000'000;
    const auto token = source.number<std::uint32_t>();
    if (ring.find(token, now) == nullptr && ring.is_missing(token, now)) plan.wished(now);
    if (plan.is_wished()) {
      TAKT_CHECK(i == 0 || wished + security::PullPlan::least_between_wishes_ns <= now,
                 "pulls that were wished for are a second apart");
      wished = now;
    }
    auto answer = keys_in(any_result(source));
    const bool is_given = answer && keys.take({answer->policy_uri.value, answer->first_token, std::move(answer->keys),
                                               answer->time_to_next_ms, answer->lifetime_ms},
                                              now)
                                        .empty();
    if (is_given) ring.replace(keys.schedule(), keys.source());
    if (!keys.is_empty()) TAKT_CHECK(keys.next_pull_ns(now) >= now, "the next pull lies ahead");
    is_given ? plan.gave(now, keys.next_pull_ns(now), keys.has_news()) : plan.failed(now, source.octet());
    TAKT_CHECK(plan.next_ns() >= now && !plan.is_wished(), "the next pull lies ahead");
    if (const auto current = ring.current(now)) {
      TAKT_CHECK(last == 0 || !security::is_later_token(last, current->token), "a token is not gone back behind");
      last = current->token;
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Source source(std::as_bytes(std::span(data, size)));
  if (source.octet() % 3 == 0)
    feed_keys(source);
  else
    Service(source).run();
  return 0;
}
