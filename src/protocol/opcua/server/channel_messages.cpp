// SPDX-License-Identifier: Apache-2.0
// HEL, OPN, MSG and CLO of a connection (OPC 10000-6, 6.7 and 7.1; OPC 10000-4, 5.5).
#include <algorithm>

#include "opcua/server/server.hpp"

namespace takt::opcua {
namespace {

/// What an OPN says fits into less, whatever the keys.
constexpr std::size_t most_blocks_of_open = 8;
/// Of a request without a session: discovery, and signing in.
constexpr std::size_t most_octets_of_strangers = 64 << 10;

/// "opc.tcp://host:port" of a longer URL.
std::string without_path(std::string_view url) {
  constexpr std::string_view scheme = "opc.tcp://";
  return std::string(url.substr(0, url.find('/', scheme.size())));
}

}  // namespace

void Server::take(Connection& connection, Octets message, Now now) {
  const MessageHeader header = *decode_message_header(message);
  const bool is_hello = header.type == MessageType::Hello;
  const bool is_open = header.type == MessageType::OpenChannel;
  const bool has_channel = header.type == MessageType::Message || header.type == MessageType::CloseChannel;
  if (connection.stage == Connection::Stage::hello && is_hello)
    accept_hello(connection, message, now);
  else if (connection.stage != Connection::Stage::hello && is_open)
    accept_open(connection, message, now);
  else if (connection.stage == Connection::Stage::open && has_channel)
    accept_message(connection, message, now);
  else if (connection.stage == Connection::Stage::opening && has_channel)
    refuse(connection, StatusCode::BadTcpSecureChannelUnknown, "a message on a channel that never was");
  else
    refuse(connection, StatusCode::BadTcpMessageTypeInvalid, "a message that is not due now");
}

void Server::accept_hello(Connection& connection, Octets message, Now now) {
  Hello hello;
  Decoder decoder(message.subspan(message_header_octets));
  decode(decoder, hello);
  if (decoder.failed() || hello.endpoint_url.value.size() > most_url_octets ||
      !hello.endpoint_url.value.starts_with("opc.tcp://"))
    return refuse(connection, StatusCode::BadTcpEndpointUrlInvalid, "a HEL");
  if (hello.receive_buffer_size < least_buffer_octets || hello.send_buffer_size < least_buffer_octets)
    return refuse(connection, StatusCode::BadTcpNotEnoughResources, "a HEL with buffers of less than 8192 octets");
  const std::uint32_t chunk = std::max(settings_.limits.chunk_octets, least_buffer_octets);
  Acknowledge acknowledge;
  acknowledge.receive_buffer_size = std::min(chunk, hello.send_buffer_size);
  acknowledge.send_buffer_size = std::min(chunk, hello.receive_buffer_size);
  acknowledge.max_message_size = static_cast<std::uint32_t>(settings_.limits.message_octets);
  acknowledge.max_chunk_count = static_cast<std::uint32_t>(settings_.limits.message_chunks);
  connection.send = {acknowledge.send_buffer_size, hello.max_message_size, hello.max_chunk_count};
  connection.url = without_path(hello.endpoint_url);
  connection.stage = Connection::Stage::opening;
  connection.deadline = now.local + settings_.limits.hello_within;
  connection.put(framed(MessageType::Acknowledge, acknowledge));
}

/// Everything that can be asked of a client before our private key is used for it.
StatusCode Server::check_client(Connection& connection, const AsymmetricHeader& header,
                                std::optional<security::Certificate>& client, Now now) {
  const auto& own = identity_.certificate.thumbprint();
  if (!std::equal(own.begin(), own.end(), header.receiver_thumbprint.value.begin(),
                  header.receiver_thumbprint.value.end()))
    return StatusCode::BadCertificateInvalid;
  client = security::Certificate::from_der(header.sender_certificate.value);
  if (!client) return StatusCode::BadSecurityChecksFailed;
  const TrustVerdict verdict = check_certificate(*client, trust_, seconds_since_1970(now.utc));
  if (!is_good(verdict.status)) {
    log_.refused(connection.source, "a certificate", std::string(verdict.reason) + ": " + client->subject());
    if (verdict.status == StatusCode::BadSecurityChecksFailed) log_.rejected(connection.source, *client);
  }
  return verdict.status;
}

void Server::accept_open(Connection& connection, Octets message, Now now) {
  AsymmetricHeader header;
  const auto clear_from = decode_asymmetric_header(message, header);
  if (!clear_from || *clear_from + sequence_header_octets > message.size())
    return refuse(connection, StatusCode::BadSecurityChecksFailed, "an OPN that is malformed");
  const PolicyInfo* const policy = policy_with_uri(header.policy_uri);
  const bool is_offered =
      policy != nullptr && (!is_secured(policy->policy) ||
                            std::any_of(settings_.endpoints.begin(), settings_.endpoints.end(),
                                        [&](const ChannelSecurity& each) { return each.policy == policy->policy; }));
  if (!is_offered)
    return refuse(connection, StatusCode::BadSecurityPolicyRejected, "an OPN with a policy that is not offered");
  const auto channel_id = uadp::load_little_endian<std::uint32_t>(message.data() + message_header_octets);
  if (connection.channel && channel_id != connection.channel->id())
    return refuse(connection, StatusCode::BadTcpSecureChannelUnknown, "an OPN of another channel");
  if (connection.opening) return refuse(connection, StatusCode::BadTcpServerTooBusy, "an OPN behind one that waits");
  if (is_secured(policy->policy)) {
    std::optional<security::Certificate> client;
    if (const StatusCode status = check_client(connection, header, client, now); !is_good(status))
      return refuse(connection, status, "an OPN");
    if ((message.size() - *clear_from) / identity_.key.public_key().octets() > most_blocks_of_open)
      return refuse(connection, StatusCode::BadTcpMessageTooLarge, "an OPN");
    connection.opening =
        WaitingOpen{{message.begin(), message.end()}, *clear_from, policy, std::move(*client), ++waited_};
    return;
  }
  answer_open(connection, message.subspan(*clear_from), {policy->policy, MessageSecurityMode::Invalid}, {}, now);
}

/// One for each block, and one for the signature of the answer.
std::uint64_t Server::key_operations_of(const WaitingOpen& open) const {
  return (open.message.size() - open.clear_from) / identity_.key.public_key().octets() + 1;
}

void Server::open_channel(Connection& connection, WaitingOpen open, Now now) {
  const auto clear = open_asymmetric(open.message, open.clear_from, *open.policy, identity_.key, open.client.key());
  if (!clear) return refuse(connection, StatusCode::BadSecurityChecksFailed, "an OPN whose security does not hold");
  answer_open(connection, *clear, {open.policy->policy, MessageSecurityMode::Invalid}, std::move(open.client), now);
}

void Server::answer_open(Connection& connection, Octets clear, const ChannelSecurity& asked,
                         std::optional<security::Certificate> client, Now now) {
  uadp::Reader reader(clear);
  SequenceHeader sequence;
  sequence.sequence_number = reader.get<std::uint32_t>();
  sequence.request_id = reader.get<std::uint32_t>();
  Decoder decoder(reader.rest());
  NodeId type;
  OpenSecureChannelRequest request;
  decode(decoder, type);
  decode(decoder, request);
  if (decoder.failed() || type != NodeId(OpenSecureChannelRequest::encoding_id))
    return refuse(connection, StatusCode::BadDecodingError, "an OPN without a request");
  const ChannelSecurity security{asked.policy, request.security_mode};
  const bool has_policy = is_secured(security.policy);
  const bool is_renewal = request.request_type == SecurityTokenRequestType::Renew;
  // Without security GetEndpoints can always be asked; sessions only where an endpoint offers them.
  const bool is_offered = has_policy ? std::find(settings_.endpoints.begin(), settings_.endpoints.end(), security) !=
                                           settings_.endpoints.end()
                                     : security.mode == MessageSecurityMode::None;
  if (!is_offered)
    return refuse(connection, StatusCode::BadSecurityModeRejected, "an OPN with a mode that is not offered");
  if (request.client_protocol_version != 0)
    return refuse(connection, StatusCode::BadProtocolVersionUnsupported, "an OPN");
  if (is_renewal != (connection.channel != nullptr) || static_cast<std::uint32_t>(request.request_type) > 1)
    return refuse(connection, StatusCode::BadRequestTypeInvalid,
                  "an OPN that renews nothing, or opens a second channel");
  if (has_policy && request.client_nonce.value.size() != nonce_octets)
    return refuse(connection, StatusCode::BadNonceInvalid, "an OPN");
  if (is_renewal) {
    const bool is_same =
        connection.channel->security() == security && (!client || *client == *connection.channel->client_certificate());
    if (!is_same) return refuse(connection, StatusCode::BadSecurityChecksFailed, "an OPN that renews as somebody else");
    if (!is_good(connection.channel->accept_sequence_number(sequence.sequence_number)))
      return refuse(connection, StatusCode::BadSecurityChecksFailed, "an OPN that was seen before");
  } else {
    connection.channel =
        std::make_unique<SecureChannel>(++last_channel_, security, std::move(client), sequence.sequence_number);
    connection.stage = Connection::Stage::open;
    connection.deadline = now.local + settings_.limits.idle_channel;
  }
  OpenSecureChannelResponse response;
  response.response_header.timestamp = now.utc;
  response.response_header.request_handle = request.request_header.request_handle;
  if (has_policy) {
    response.server_nonce = Bytes(std::vector<std::byte>(nonce_octets));
    random_.fill(response.server_nonce.value);
  }
  response.security_token =
      connection.channel->issue(now.local, now.utc, request.requested_lifetime, settings_.limits.tokens,
                                request.client_nonce.value, response.server_nonce.value);
  send_open(connection, sequence.request_id, response);
}

void Server::send_open(Connection& connection, std::uint32_t request_id, const OpenSecureChannelResponse& response) {
  SecureChannel& channel = *connection.channel;
  Encoder body;
  encode_message(body, response);
  const auto chunk = sealed_open(channel.id(), info(channel.security().policy), channel.next_sequence(request_id),
                                 body.octets(), identity_, channel.client_certificate());
  if (!chunk) return refuse(connection, StatusCode::BadSecurityChecksFailed, "a certificate whose key cannot be used");
  connection.put(*chunk);
}

void Server::accept_message(Connection& connection, Octets message, Now now) {
  std::vector<std::byte> chunk(message.begin(), message.end());
  OpenedChunk opened;
  if (const StatusCode status = connection.channel->open(chunk, now.local, opened); !is_good(status))
    return refuse(connection, status, "a message whose security does not hold");
  if (decode_message_header(message)->type == MessageType::CloseChannel)
    return connection.requests.push_back({0, {}, true});
  using Verdict = MessageAssembler::Verdict;
  const std::size_t most = services_.has_session(connection.id)
                               ? settings_.limits.message_octets
                               : std::min(settings_.limits.message_octets, most_octets_of_strangers);
  switch (connection.assembler.take(opened, most, settings_.limits.message_chunks)) {
    case Verdict::more:
    case Verdict::dropped:
      return;
    case Verdict::mixed:
      return refuse(connection, StatusCode::BadSecurityChecksFailed, "chunks of two messages at once");
    case Verdict::too_large:
      return refuse(connection, StatusCode::BadTcpMessageTooLarge, "a request that is too long");
    case Verdict::complete:
      queue_request(connection, opened.sequence.request_id, connection.assembler.accept_message());
  }
}

void Server::queue_request(Connection& connection, std::uint32_t id, std::vector<std::byte> message) {
  Decoder decoder(message);
  NodeId type;
  decode(decoder, type);
  CallRequest call;
  if (type == NodeId(CallRequest::encoding_id) && message.size() <= most_octets_of_strangers) decode(decoder, call);
  if (!decoder.failed() && !call.methods_to_call.empty() && services_.is_urgent(connection.id, call)) {
    calls_.push_back({connection.id, {id, std::move(message), false}});
    return;
  }
  connection.waiting_octets += message.size();
  connection.requests.push_back({id, std::move(message), false});
}

}  // namespace takt::opcua
