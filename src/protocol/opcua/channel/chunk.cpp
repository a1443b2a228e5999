// SPDX-License-Identifier: Apache-2.0
#include "opcua/channel/chunk.hpp"

#include <algorithm>

#include "security/key_derivation.hpp"
#include "sim/check.hpp"

namespace takt::opcua {
namespace {

using security::aes_block_octets;

void set_size(std::vector<std::byte>& chunk, std::size_t size) {
  uadp::store_little_endian(chunk.data() + 4, static_cast<std::uint32_t>(size));
}

/// Padding before a signature: its length, so many octets that hold it, and its upper octet if `is_wide`.
void add_padding(std::vector<std::byte>& chunk, std::size_t octets, bool is_wide) {
  const auto low = static_cast<std::byte>(octets & 0xFF);
  chunk.insert(chunk.end(), octets + 1, low);
  if (is_wide) chunk.push_back(static_cast<std::byte>(octets >> 8));
}

/// The octets before the padding of what was padded and stands before a signature; nothing if the padding is none.
/// Looks at every octet of it.
std::optional<Octets> without_padding(Octets padded, bool is_wide) {
  const std::size_t sizes = is_wide ? 2 : 1;
  if (padded.size() < sizes) return std::nullopt;
  const std::byte last = padded.back();
  const std::byte low = padded[padded.size() - sizes];
  const std::size_t octets = static_cast<std::size_t>(low) | (is_wide ? static_cast<std::size_t>(last) << 8 : 0U);
  if (octets + sizes > padded.size()) return std::nullopt;
  std::byte difference{0};
  for (const std::byte each : padded.subspan(padded.size() - sizes - octets, octets)) difference |= each ^ low;
  // The octet of the length stands in front of the padding, and the padding repeats it.
  const std::size_t first = padded.size() - (is_wide ? 1 : 0) - octets - 1;
  difference |= padded[first] ^ low;
  return difference == std::byte{0} ? std::optional(padded.first(first)) : std::nullopt;
}

}  // namespace

ChunkKeys::ChunkKeys(const PolicyInfo& policy, security::Octets derived)
    : hmac_(security::Hash::sha256, derived.first(signing_key_octets)),
      cipher_(derived.subspan(signing_key_octets, policy.encrypting_key_octets)) {
  std::copy_n(derived.end() - static_cast<std::ptrdiff_t>(aes_block_octets), aes_block_octets, initial_vector_.begin());
}

TokenKeys derive_keys(const PolicyInfo& policy, Octets client_nonce, Octets server_nonce) {
  const std::size_t octets = ChunkKeys::octets(policy);
  return {ChunkKeys(policy, security::p_sha256(server_nonce, client_nonce, octets).octets()),
          ChunkKeys(policy, security::p_sha256(client_nonce, server_nonce, octets).octets())};
}

void seal(std::vector<std::byte>& chunk, ChunkKeys& keys, MessageSecurityMode mode) {
  const bool encrypts = mode == MessageSecurityMode::SignAndEncrypt;
  if (encrypts) {
    const std::size_t clear = chunk.size() - symmetric_header_octets + 1 + signature_octets;
    add_padding(chunk, sim::rounded_up(clear, aes_block_octets) - clear, false);
  }
  const std::size_t is_signed = chunk.size();
  set_size(chunk, is_signed + signature_octets);
  chunk.resize(is_signed + signature_octets);
  const std::span<std::byte> all(chunk);
  keys.hmac_.sign(all.first(is_signed), all.subspan(is_signed));
  if (encrypts) keys.cipher_.encrypt(keys.initial_vector_, all.subspan(symmetric_header_octets));
}

std::optional<Octets> open(std::span<std::byte> chunk, ChunkKeys& keys, MessageSecurityMode mode) {
  const bool is_encrypted = mode == MessageSecurityMode::SignAndEncrypt;
  if (chunk.size() < symmetric_header_octets + sequence_header_octets + signature_octets) return std::nullopt;
  if (is_encrypted) {
    const std::span<std::byte> cipher = chunk.subspan(symmetric_header_octets);
    if (cipher.size() % aes_block_octets != 0) return std::nullopt;
    keys.cipher_.decrypt(keys.initial_vector_, cipher);
  }
  const std::size_t is_signed = chunk.size() - signature_octets;
  // Whether the signature holds is known before anything that was encrypted is looked at.
  if (!keys.hmac_.verify(chunk.first(is_signed), chunk.subspan(is_signed))) return std::nullopt;
  const Octets clear = chunk.subspan(symmetric_header_octets, is_signed - symmetric_header_octets);
  const auto body = is_encrypted ? without_padding(clear, false) : std::optional(clear);
  return body && body->size() >= sequence_header_octets ? body : std::nullopt;
}

std::size_t most_body_octets(std::size_t chunk_octets, MessageSecurityMode mode) {
  const std::size_t space = chunk_octets - symmetric_header_octets;
  switch (mode) {
    case MessageSecurityMode::SignAndEncrypt:
      return space / aes_block_octets * aes_block_octets - sequence_header_octets - signature_octets - 1;
    case MessageSecurityMode::Sign:
      return space - sequence_header_octets - signature_octets;
    default:
      return space - sequence_header_octets;
  }
}

std::optional<std::size_t> decode_asymmetric_header(Octets chunk, AsymmetricHeader& header) {
  if (chunk.size() < channel_header_octets) return std::nullopt;
  Decoder decoder(chunk.subspan(channel_header_octets));
  decode(decoder, header);
  if (decoder.failed() || header.policy_uri.value.size() > 255) return std::nullopt;
  return channel_header_octets + decoder.position();
}

bool seal_asymmetric(std::vector<std::byte>& chunk, std::size_t clear_from, const PolicyInfo& policy,
                     const security::PrivateKey& own, const security::PublicKey& other) {
  if (other.octets() <= security::padding_octets(policy.encryption)) return false;
  const bool is_wide = other.octets() > 256;
  const std::size_t block = other.clear_octets(policy.encryption);
  const std::size_t signature = own.public_key().octets();
  const std::size_t clear = chunk.size() - clear_from + (is_wide ? 2 : 1) + signature;
  const std::size_t padded = sim::rounded_up(clear, block);
  add_padding(chunk, padded - clear, is_wide);
  set_size(chunk, clear_from + padded / block * other.octets());
  const std::vector<std::byte> made = own.sign(policy.signature, chunk);
  chunk.insert(chunk.end(), made.begin(), made.end());
  const auto cipher = other.encrypt(policy.encryption, Octets(chunk).subspan(clear_from));
  if (!cipher) return false;
  chunk.resize(clear_from);
  chunk.insert(chunk.end(), cipher->begin(), cipher->end());
  return true;
}

std::optional<std::vector<std::byte>> open_asymmetric(Octets chunk, std::size_t clear_from, const PolicyInfo& policy,
                                                      const security::PrivateKey& own,
                                                      const security::PublicKey& other) {
  const auto clear = own.decrypt(policy.encryption, chunk.subspan(clear_from));
  if (!clear || clear->size() < other.octets() + sequence_header_octets + 1) return std::nullopt;
  std::vector<std::byte> all(chunk.begin(), chunk.begin() + static_cast<std::ptrdiff_t>(clear_from));
  all.insert(all.end(), clear->octets().begin(), clear->octets().end());
  const std::size_t is_signed = all.size() - other.octets();
  if (!other.verify(policy.signature, Octets(all).first(is_signed), Octets(all).subspan(is_signed)))
    return std::nullopt;
  const auto body =
      without_padding(Octets(all).subspan(clear_from, is_signed - clear_from), own.public_key().octets() > 256);
  if (!body || body->size() < sequence_header_octets) return std::nullopt;
  return std::vector<std::byte>(body->begin(), body->end());
}

}  // namespace takt::opcua
