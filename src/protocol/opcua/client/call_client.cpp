// SPDX-License-Identifier: Apache-2.0
#include "opcua/client/call_client.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "opcua/channel/password.hpp"

namespace takt::opcua {
namespace {

constexpr std::uint32_t chunk_octets = 65'536;
constexpr std::uint32_t most_message_octets = 262'144;
constexpr std::uint32_t most_chunks = 16;
constexpr std::uint32_t channel_lifetime_ms = 60'000;
constexpr double session_timeout_ms = 30'000;
constexpr std::size_t most_nonce_octets = 128;

std::string name_of(StatusCode status) {
  const std::string_view name = short_name_of(status);
  return name == "(other)" ? fmt::format("0x{:08X}", code_of(status)) : std::string(name);
}

std::vector<std::byte> random_nonce(security::RandomOctets& random) {
  std::vector<std::byte> nonce(nonce_octets);
  random.fill(nonce);
  return nonce;
}

}  // namespace

CallClient::CallClient(const CallClientSettings& settings, const Identity& own, const security::Certificate& server,
                       security::RandomOctets& random, CallMethodRequest call, Now now)
    : settings_(settings),
      own_(own),
      server_(server),
      random_(random),
      policy_(info(settings.policy)),
      call_(std::move(call)),
      deadline_(now.local + settings.within),
      splitter_(chunk_octets) {
  const std::int64_t now_s = seconds_since_1970(now.utc);
  if (now_s < server.valid_from() || now_s > server.valid_until()) fail("its certificate is not valid now");
  if (!server.is_strong())
    fail("its certificate is signed by less than SHA-256, or has a key of less than 2048 or more than 4096 bits");
  if (!is_over())
    output_ = framed(MessageType::Hello, Hello{0, chunk_octets, chunk_octets, most_message_octets, most_chunks,
                                               Text(settings.endpoint_url)});
}

void CallClient::fail(std::string problem) {
  if (stage_ == Stage::over) return;
  stage_ = Stage::over;
  problem_ = std::move(problem);
  channel_.reset();
}
void CallClient::fail(std::string_view what, StatusCode status) { fail(fmt::format("{}: {}", what, name_of(status))); }

void CallClient::ended() {
  static constexpr std::array<std::string_view, 6> behind = {
      "Hello", "the channel was asked for", "the session was asked for", "the sign-in", "the call", "the end"};
  fail(fmt::format("it closed the connection behind {}", behind[static_cast<std::size_t>(stage_)]));
}

void CallClient::advance(Now now) {
  if (now.local >= deadline_) fail(fmt::format("no answer within {} ms", settings_.within.ps() / 1'000'000'000));
}

void CallClient::received(Octets octets, Now now) {
  if (is_over()) return;
  splitter_.feed(octets);
  while (!is_over()) {
    const auto message = splitter_.next();
    if (!message) break;
    take(*message, now);
  }
  if (!is_over() && splitter_.failure() != StatusCode::Good)
    fail("what it says is no message of UA-TCP, or one that is too long", splitter_.failure());
}

void CallClient::take(Octets message, Now now) {
  const MessageType type = decode_message_header(message)->type;
  if (type == MessageType::Error) {
    ErrorMessage error;
    Decoder decoder(message.subspan(message_header_octets));
    decode(decoder, error);
    return decoder.failed() ? fail("an ERR that is malformed") : fail("it refuses", error.error);
  }
  if (stage_ == Stage::hello && type == MessageType::Acknowledge) return accept_acknowledge(message, now);
  if (stage_ == Stage::opening && type == MessageType::OpenChannel) return accept_open(message, now);
  if (stage_ > Stage::opening && type == MessageType::Message) return accept_chunk(message, now);
  fail("a message that is not due now");
}

void CallClient::accept_acknowledge(Octets message, Now now) {
  Acknowledge acknowledge;
  Decoder decoder(message.subspan(message_header_octets));
  decode(decoder, acknowledge);
  if (decoder.failed() || acknowledge.receive_buffer_size < least_buffer_octets ||
      acknowledge.send_buffer_size < least_buffer_octets)
    return fail("an ACK that is malformed");
  limits_ = {std::min(chunk_octets, acknowledge.receive_buffer_size), acknowledge.max_message_size,
             acknowledge.max_chunk_count};
  nonce_ = random_nonce(random_);
  OpenSecureChannelRequest request;
  request.request_header.timestamp = now.utc;
  request.request_header.request_handle = ++request_;
  request.security_mode = MessageSecurityMode::SignAndEncrypt;
  request.client_nonce = Bytes(nonce_);
  request.requested_lifetime = channel_lifetime_ms;
  Encoder body;
  encode_message(body, request);
  const auto chunk = sealed_open(0, policy_, {1, request_}, body.octets(), own_, &server_);
  if (!chunk) return fail("the key of its certificate cannot be used");
  output_.insert(output_.end(), chunk->begin(), chunk->end());
  stage_ = Stage::opening;
}

/// Nobody but who has the key of the certificate that we know can have signed it.
void CallClient::accept_open(Octets message, Now now) {
  AsymmetricHeader header;
  const auto clear_from = decode_asymmetric_header(message, header);
  if (!clear_from || *clear_from + sequence_header_octets > message.size()) return fail("an OPN that is malformed");
  const auto& own = own_.certificate.thumbprint();
  if (!(header.policy_uri == policy_.uri)) return fail("an OPN of another policy");
  const auto sender = security::Certificate::from_der(header.sender_certificate.value);
  if (!sender || !(*sender == server_)) return fail("another certificate than the one that is trusted");
  if (!std::equal(own.begin(), own.end(), header.receiver_thumbprint.value.begin(),
                  header.receiver_thumbprint.value.end()))
    return fail("an OPN for somebody else");
  const auto opened = open_asymmetric(message, *clear_from, policy_, own_.key, server_.key());
  if (!opened) return fail("an OPN whose security does not hold");
  uadp::Reader reader(*opened);
  const auto sequence_number = reader.get<std::uint32_t>();
  const auto request_id = reader.get<std::uint32_t>();
  Decoder decoder(reader.rest());
  NodeId type;
  decode(decoder, type);
  if (request_id != request_) return fail("an answer to something that was not asked");
  OpenSecureChannelResponse response;
  if (type == NodeId(ServiceFault::encoding_id)) return fail("it refuses a channel");
  if (type != NodeId(OpenSecureChannelResponse::encoding_id)) return fail("an OPN with another answer in it");
  if (!decoded(decoder, response, "a channel")) return;
  const auto channel_id = uadp::load_little_endian<std::uint32_t>(message.data() + message_header_octets);
  if (response.server_nonce.value.size() != nonce_octets || response.security_token.channel_id != channel_id ||
      response.security_token.revised_lifetime == 0)
    return fail("a channel that is none: its nonce, id or lifetime");
  channel_ =
      std::make_unique<SecureChannel>(channel_id, ChannelSecurity{policy_.policy, MessageSecurityMode::SignAndEncrypt},
                                      server_, sequence_number, Side::client, 1);
  channel_->take(response.security_token, now.local, nonce_, response.server_nonce.value);

  nonce_ = random_nonce(random_);
  CreateSessionRequest create;
  create.client_description.application_uri = Text(settings_.application_uri);
  create.client_description.product_uri = Text("urn:takt:node");
  create.client_description.application_name = LocalizedText(settings_.application_name);
  create.client_description.application_type = ApplicationType::Client;
  create.endpoint_url = Text(settings_.endpoint_url);
  create.session_name = Text(settings_.application_name);
  create.client_nonce = Bytes(nonce_);
  create.client_certificate = Bytes({own_.certificate.der().begin(), own_.certificate.der().end()});
  create.requested_session_timeout = session_timeout_ms;
  create.max_response_message_size = most_message_octets;
  ask(Stage::creating, std::move(create), now);
}

template <Structure Body>
void CallClient::ask(Stage stage, Body body, Now now) {
  body.request_header.authentication_token = token_;
  body.request_header.timestamp = now.utc;
  body.request_header.request_handle = ++request_;
  body.request_header.timeout_hint = static_cast<std::uint32_t>(settings_.within.ps() / 1'000'000'000);
  Encoder encoder;
  encode_message(encoder, body);
  const MessageType type =
      std::is_same_v<Body, CloseSecureChannelRequest> ? MessageType::CloseChannel : MessageType::Message;
  if (!channel_->seal_message(request_, encoder.octets(), limits_, output_, type))
    return fail("it takes no request of this length");
  stage_ = stage;
}

/// Its header says whether there is more behind it.
template <Structure Body>
bool CallClient::decoded(Decoder& decoder, Body& body, std::string_view what) {
  decode(decoder, body);
  if (decoder.failed())
    fail(fmt::format("the answer to {}", what), decoder.status());
  else if (!is_good(body.response_header.service_result))
    fail(fmt::format("it refuses {}", what), body.response_header.service_result);
  else if (body.response_header.request_handle != request_)
    fail("an answer to something that was not asked");
  return !is_over();
}

void CallClient::accept_chunk(Octets message, Now now) {
  std::vector<std::byte> chunk(message.begin(), message.end());
  OpenedChunk opened;
  if (const StatusCode status = channel_->open(chunk, now.local, opened); !is_good(status))
    return fail("a message whose security does not hold", status);
  using Verdict = MessageAssembler::Verdict;
  switch (assembler_.take(opened, most_message_octets, most_chunks)) {
    case Verdict::more:
      break;
    case Verdict::dropped:
      return fail("an answer that it gave up");
    case Verdict::mixed:
      return fail("chunks of two messages at once");
    case Verdict::too_large:
      return fail("an answer that is too long");
    case Verdict::complete:
      if (opened.sequence.request_id != request_) return fail("an answer to something that was not asked");
      accept_response(assembler_.accept_message(), now);
  }
  security::wipe(chunk);
}

void CallClient::accept_response(Octets body, Now now) {
  Decoder decoder(body);
  NodeId type;
  decode(decoder, type);
  static constexpr std::array<std::string_view, 3> asked = {"a session", "the sign-in", "the call"};
  static constexpr std::array<std::uint32_t, 3> answers = {
      CreateSessionResponse::encoding_id, ActivateSessionResponse::encoding_id, CallResponse::encoding_id};
  const std::size_t which = static_cast<std::size_t>(stage_) - static_cast<std::size_t>(Stage::creating);
  if (type == NodeId(ServiceFault::encoding_id)) {
    ServiceFault fault;
    if (decoded(decoder, fault, asked[which]))
      fail(fmt::format("it refuses {}, and says that all is well", asked[which]));
    return;
  }
  if (decoder.failed() || type != NodeId(answers[which]))
    return fail(fmt::format("another answer than to {}", asked[which]));
  if (stage_ == Stage::creating) return accept_session(decoder, now);
  if (stage_ == Stage::calling) return accept_result(decoder, now);
  ActivateSessionResponse response;
  if (!decoded(decoder, response, asked[which])) return;
  CallRequest request;
  request.methods_to_call.push_back(call_);
  ask(Stage::calling, std::move(request), now);
}

void CallClient::accept_session(Decoder& decoder, Now now) {
  CreateSessionResponse response;
  if (!decoded(decoder, response, "a session")) return;
  const auto certificate = security::Certificate::from_der(response.server_certificate.value);
  if (!certificate || !(*certificate == server_)) return fail("another certificate in its session than in its channel");
  if (!server_.key().verify(policy_.signature, joined(own_.certificate.der(), nonce_),
                            response.server_signature.signature.value))
    return fail("a session whose signature does not hold");
  const std::size_t nonce = response.server_nonce.value.size();
  if (nonce < nonce_octets || nonce > most_nonce_octets) return fail("a session with a nonce of another length");
  if (!choose_user_token(response.server_endpoints))
    return fail("it does not let users in by name over a channel that is secured like ours");
  token_ = response.authentication_token;
  ActivateSessionRequest request;
  if (sign_in(request, response.server_nonce)) ask(Stage::activating, std::move(request), now);
}

bool CallClient::choose_user_token(const List<EndpointDescription>& endpoints) {
  for (const EndpointDescription& endpoint : endpoints) {
    if (endpoint.security_mode != MessageSecurityMode::SignAndEncrypt || !(endpoint.security_policy_uri == policy_.uri))
      continue;
    for (const UserTokenPolicy& token : endpoint.user_identity_tokens) {
      const PolicyInfo* const policy = policy_with_uri(
          token.security_policy_uri.empty() ? policy_.uri : std::string_view(token.security_policy_uri));
      if (token.token_type != UserTokenType::UserName || policy == nullptr || !is_secured(policy->policy)) continue;
      user_policy_id_ = token.policy_id;
      user_policy_uri_ = policy->uri;
      return true;
    }
  }
  return false;
}

bool CallClient::sign_in(ActivateSessionRequest& request, const Bytes& server_nonce) {
  const PolicyInfo& policy = *policy_with_uri(user_policy_uri_);
  auto password = encrypted_password(policy, server_.key(), settings_.password.octets(), server_nonce.value);
  if (!password) {
    fail("the key of its certificate cannot be used");
    return false;
  }
  UserNameIdentityToken user;
  user.policy_id = user_policy_id_;
  user.user_name = Text(settings_.user);
  user.password = Bytes(std::move(*password));
  user.encryption_algorithm = Text(policy.encryption_uri);
  request.user_identity_token = extension_of(user);
  request.client_signature = {Text(policy_.signature_uri),
                              Bytes(own_.key.sign(policy_.signature, joined(server_.der(), server_nonce.value)))};
  return true;
}

void CallClient::accept_result(Decoder& decoder, Now now) {
  CallResponse response;
  if (!decoded(decoder, response, "the call")) return;
  if (response.results.size() != 1) return fail("another number of results than of calls");
  result_ = std::move(response.results.front());
  close(now);
}

/// Without waiting for what the server says to it.
void CallClient::close(Now now) {
  CloseSessionRequest session;
  session.delete_subscriptions = true;
  ask(Stage::over, std::move(session), now);
  ask(Stage::over, CloseSecureChannelRequest(), now);
  channel_.reset();
}

}  // namespace takt::opcua
