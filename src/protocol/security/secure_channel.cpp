// SPDX-License-Identifier: Apache-2.0
#include "security/secure_channel.hpp"

#include <algorithm>
#include <cstring>

#include "sim/check.hpp"
#include "uadp/flags.hpp"
#include "uadp/network_message.hpp"

namespace takt::security {
namespace {

constexpr std::uint32_t last_number = 0xFFFF'FFFF;

template <class T>
void put(std::byte* at, T number) {
  sim::store(at, number, sim::ByteOrder::little);
}

std::uint64_t identity_of(const std::optional<uadp::PublisherId>& id) {
  if (!id) return 0;
  std::uint64_t value = id->number;
  for (const char c : id->text)
    value = (value ^ static_cast<unsigned char>(c)) * 0x100'0000'01B3U;  // FNV-1a; who has a key may make two names one
  return value * 8 + 1 + static_cast<std::uint64_t>(id->type);
}

StreamKey stream_of(const uadp::NetworkMessage& message) {
  return {identity_of(message.header.publisher_id),
          message.header.group ? message.header.group->writer_group_id.value_or(0) : std::uint16_t{0}, 0};
}

/// What the SecurityHeader says, before any key is looked for.
SecurityVerdict judge(const uadp::SecurityHeader& header, MessageMode mode) {
  const unsigned flags = header.flags;
  const bool is_signed = (flags & security_flags::is_signed) != 0;
  if (((flags & security_flags::is_encrypted) != 0 && !is_signed) || (flags & security_flags::reserved) != 0)
    return SecurityVerdict::header;
  if ((flags & flags_of(MessageMode::sign_and_encrypt)) != flags_of(mode)) return SecurityVerdict::mode;
  if ((flags & security_flags::has_footer) != 0 || header.nonce.size() != message_nonce_octets)
    return SecurityVerdict::header;
  return SecurityVerdict::good;
}

SecurityVerdict verdict_of(uadp::DecodeStatus status) {
  if (status == uadp::DecodeStatus::secured) return SecurityVerdict::good;
  if (status == uadp::DecodeStatus::ok) return SecurityVerdict::unsecured;
  return status == uadp::DecodeStatus::truncated ? SecurityVerdict::truncated : SecurityVerdict::malformed;
}

}  // namespace

SecureChannel::SecureChannel(const ChannelSettings& settings, KeyRing keys, ReplayMemory memory)
    : settings_(settings), keys_(std::move(keys)), memory_(memory) {
  TAKT_CHECK(settings.mode != MessageMode::none, "a channel secures");
  if (settings.nonces == Nonces::lenient) remembered_.reserve(most_remembered);
}

Octets SecureChannel::seal(Octets clear, std::int64_t now_ns) {
  uadp::NetworkMessage message;
  const auto current = keys_.current(now_ns);
  const bool may_send = current && uadp::decode(clear, message) == uadp::DecodeStatus::ok &&
                        !(current->token == token_ && number_ == last_number);
  if (!may_send) {
    ++unsealed_;
    return {};
  }
  number_ = current->token == token_ ? number_ + 1 : 1;
  token_ = current->token;

  const std::size_t header = message.payload_offset - message.sizes.size();
  const bool has_extended = (std::to_integer<unsigned>(clear[0]) & uadp::flags::extended_1) != 0;
  const std::size_t payload = clear.size() - header;
  const std::size_t size = clear.size() + (has_extended ? 0 : 1) + added_octets(settings_.mode);
  if (sealed_.size() < size) sealed_.resize(size);
  std::byte* at = sealed_.data();
  *at++ = clear[0] | static_cast<std::byte>(uadp::flags::extended_1);
  *at++ = (has_extended ? clear[1] : std::byte{0}) | static_cast<std::byte>(uadp::flags::security);
  const Octets ids = clear.subspan(has_extended ? 2 : 1, header - (has_extended ? 2 : 1));
  at = std::copy(ids.begin(), ids.end(), at);
  *at++ = static_cast<std::byte>(flags_of(settings_.mode));
  put(at, token_);
  at[4] = static_cast<std::byte>(message_nonce_octets);
  at += 5;
  std::byte* const nonce = at;
  put(nonce, settings_.sender);
  put(nonce + 2, settings_.life);
  put(nonce + 4, number_);
  at += message_nonce_octets;
  std::memcpy(at, clear.data() + header, payload);
  if (settings_.mode == MessageMode::sign_and_encrypt)
    current->key->crypt(Octets(nonce, message_nonce_octets), std::span(at, payload));
  at += payload;
  current->key->sign(Octets(sealed_.data(), at), std::span(at, signature_octets));
  return Octets(sealed_).first(size);
}

Opened SecureChannel::open(Octets octets, std::int64_t now_ns) {
  uadp::NetworkMessage message;
  if (const SecurityVerdict verdict = verdict_of(uadp::decode(octets, message)); verdict != SecurityVerdict::good)
    return {verdict, {}};
  const uadp::SecurityHeader& header = *message.security;
  if (const SecurityVerdict verdict = judge(header, settings_.mode); verdict != SecurityVerdict::good)
    return {verdict, {}};
  GroupKey* const key = keys_.find(header.token_id, now_ns);
  if (key == nullptr) return {SecurityVerdict::token, {}, keys_.is_missing(header.token_id, now_ns)};
  if (message.payload.size() < signature_octets) return {SecurityVerdict::truncated, {}};
  const Octets before = octets.first(octets.size() - signature_octets);
  if (!key->verify(before, octets.last(signature_octets))) return {SecurityVerdict::signature, {}};
  // From here on a holder of the key speaks.
  if (!is_fresh(stream_of(message), header.token_id, header.nonce)) return {SecurityVerdict::replayed, {}};

  const std::size_t payload = message.payload.size() - signature_octets;
  const std::size_t ids = message.payload_offset - security_header_octets;
  const std::size_t size = ids + payload;
  if (opened_.size() < size) opened_.resize(size);
  std::memcpy(opened_.data(), octets.data(), ids);
  opened_[1] &= ~static_cast<std::byte>(uadp::flags::security);
  std::byte* const at = opened_.data() + ids;
  if (payload > 0) std::memcpy(at, message.payload.data(), payload);
  if (settings_.mode == MessageMode::sign_and_encrypt) key->crypt(header.nonce, std::span(at, payload));
  return {SecurityVerdict::good, Octets(opened_).first(size), (header.flags & security_flags::force_key_reset) != 0};
}

bool SecureChannel::is_fresh(const StreamKey& stream, std::uint32_t token, Octets nonce) {
  if (settings_.nonces == Nonces::lenient) return is_fresh_leniently(stream, token, nonce);
  const auto number = sim::load<std::uint32_t>(nonce.data() + 4, sim::ByteOrder::little);
  if (settings_.nonces == Nonces::counted) return memory_.take(stream, {token, number, 0});
  StreamKey of_sender = stream;
  of_sender.sender = sim::load<std::uint16_t>(nonce.data(), sim::ByteOrder::little);
  return memory_.take(of_sender, {token, number, sim::load<std::uint16_t>(nonce.data() + 2, sim::ByteOrder::little)});
}

bool SecureChannel::is_fresh_leniently(const StreamKey& stream, std::uint32_t token, Octets nonce) {
  auto found = std::find_if(remembered_.begin(), remembered_.end(),
                            [&](const Remembered& each) { return each.stream == stream; });
  if (found == remembered_.end()) {
    if (remembered_.size() == most_remembered) return false;
    remembered_.push_back({stream, {}, token, 0});
    found = remembered_.end() - 1;
  }
  if (found->token != token) {
    if (!is_later_token(token, found->token)) return false;
    *found = {stream, {}, token, 0};
  }
  const auto value = sim::load<std::uint64_t>(nonce.data(), sim::ByteOrder::little);
  const auto known = found->last.begin() + static_cast<std::ptrdiff_t>(std::min(found->next, Remembered::nonces));
  if (std::find(found->last.begin(), known, value) != known) return false;
  found->last[found->next++ % Remembered::nonces] = value;
  return true;
}

}  // namespace takt::security
