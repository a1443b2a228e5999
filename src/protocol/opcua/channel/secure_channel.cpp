// SPDX-License-Identifier: Apache-2.0
#include "opcua/channel/secure_channel.hpp"

#include <algorithm>

#include "sim/check.hpp"

namespace takt::opcua {

SecureChannel::SecureChannel(std::uint32_t id, const ChannelSecurity& security,
                             std::optional<security::Certificate> other, std::uint32_t first_sequence_number, Side side,
                             std::uint32_t sent)
    : side_(side),
      id_(id),
      security_(security),
      other_(std::move(other)),
      received_(first_sequence_number),
      sent_(sent) {}

ChannelSecurityToken SecureChannel::issue(sim::LocalTime now, DateTime utc, std::uint32_t requested_ms,
                                          const TokenLifetimes& lifetimes, Octets client_nonce, Octets server_nonce) {
  const auto requested = sim::Duration::from_ps(std::int64_t{requested_ms} * 1'000'000'000);
  const sim::Duration lifetime = std::clamp(requested, lifetimes.least, lifetimes.most);
  Token token;
  token.id = ++last_token_;
  token.ends = now + lifetime + lifetime / 4;
  if (is_secured(security_.policy)) token.keys = derive_keys(info(security_.policy), client_nonce, server_nonce);
  (used_ ? next_ : used_) = std::move(token);
  return {id_, last_token_, utc, static_cast<std::uint32_t>(lifetime.ps() / 1'000'000'000)};
}

void SecureChannel::take(const ChannelSecurityToken& issued, sim::LocalTime now, Octets client_nonce,
                         Octets server_nonce) {
  TAKT_CHECK(side_ == Side::client, "a server issues tokens");
  const auto lifetime = sim::Duration::from_ps(std::int64_t{issued.revised_lifetime} * 1'000'000'000);
  Token token;
  token.id = issued.token_id;
  token.ends = now + lifetime + lifetime / 4;
  if (is_secured(security_.policy)) token.keys = derive_keys(info(security_.policy), client_nonce, server_nonce);
  used_ = std::move(token);
}

StatusCode SecureChannel::accept_sequence_number(std::uint32_t number) {
  if (!follows(number, received_)) return StatusCode::BadSecurityChecksFailed;
  received_ = number;
  return StatusCode::Good;
}

StatusCode SecureChannel::open(std::span<std::byte> chunk, sim::LocalTime now, OpenedChunk& opened) {
  const auto header = decode_message_header(chunk);
  if (!header || chunk.size() < symmetric_header_octets + sequence_header_octets)
    return StatusCode::BadSecurityChecksFailed;
  uadp::Reader reader(Octets(chunk).subspan(message_header_octets));
  if (reader.get<std::uint32_t>() != id_) return StatusCode::BadTcpSecureChannelUnknown;
  const auto token_id = reader.get<std::uint32_t>();
  const bool is_next = next_ && next_->id == token_id;
  if (!is_next && !(used_ && used_->id == token_id)) return StatusCode::BadSecureChannelTokenUnknown;
  Token& token = is_next ? *next_ : *used_;
  if (now >= token.ends) return StatusCode::BadSecureChannelTokenUnknown;
  std::optional<Octets> clear = Octets(chunk).subspan(symmetric_header_octets);
  if (token.keys) clear = opcua::open(chunk, of_other(*token.keys), security_.mode);
  if (!clear) return StatusCode::BadSecurityChecksFailed;
  uadp::Reader sequence(*clear);
  opened.sequence.sequence_number = sequence.get<std::uint32_t>();
  opened.sequence.request_id = sequence.get<std::uint32_t>();
  if (const StatusCode status = accept_sequence_number(opened.sequence.sequence_number); status != StatusCode::Good)
    return status;
  if (is_next) {  // and the old one is over
    used_ = std::move(next_);
    next_.reset();
  }
  opened.kind = header->chunk;
  opened.body = clear->subspan(sequence_header_octets);
  return StatusCode::Good;
}

bool SecureChannel::seal_message(std::uint32_t request_id, Octets body, const SendLimits& limits,
                                 std::vector<std::byte>& out, MessageType type) {
  TAKT_CHECK(used_.has_value(), "a channel has a token before it sends");
  const std::size_t most = most_body_octets(limits.chunk_octets, security_.mode);
  const std::size_t chunks = std::max<std::size_t>(1, (body.size() + most - 1) / most);
  if ((limits.message_octets != 0 && body.size() > limits.message_octets) ||
      (limits.chunks != 0 && chunks > limits.chunks))
    return false;
  for (std::size_t i = 0; i < chunks; ++i) {
    const Octets part = body.subspan(i * most, std::min(most, body.size() - i * most));
    Encoder encoder;
    encode_message_header(encoder, type, i + 1 == chunks ? ChunkKind::Final : ChunkKind::Intermediate);
    encoder.put(id_);
    encoder.put(used_->id);
    const SequenceHeader header = next_sequence(request_id);
    encoder.put(header.sequence_number);
    encoder.put(header.request_id);
    encoder.put_octets(part);
    encoder.patch(4, static_cast<std::uint32_t>(encoder.position()));
    std::vector<std::byte> chunk = encoder.take();
    if (used_->keys) seal(chunk, own(*used_->keys), security_.mode);
    out.insert(out.end(), chunk.begin(), chunk.end());
  }
  return true;
}

sim::LocalTime SecureChannel::ends() const {
  return std::max(used_ ? used_->ends : sim::LocalTime(), next_ ? next_->ends : sim::LocalTime());
}

}  // namespace takt::opcua
