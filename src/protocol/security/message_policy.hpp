// SPDX-License-Identifier: Apache-2.0
// How messages of OPC UA PubSub are secured (OPC 10000-14, 7.2.4.4.3): modes, policies, and the octets that they take.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace takt::security {

/// MessageSecurityMode of a WriterGroup or ReaderGroup.
enum class MessageMode : std::uint8_t { none, sign, sign_and_encrypt };
/// SecurityPolicy of a SecurityGroup.
enum class MessagePolicy : std::uint8_t { aes128_ctr, aes256_ctr };

inline constexpr std::size_t signing_key_octets = 32;
inline constexpr std::size_t key_nonce_octets = 4;
inline constexpr std::size_t message_nonce_octets = 8;
inline constexpr std::size_t signature_octets = 32;
/// SecurityFlags, SecurityTokenId, NonceLength, MessageNonce.
inline constexpr std::size_t security_header_octets = 1 + 4 + 1 + message_nonce_octets;

constexpr std::size_t encrypting_key_octets(MessagePolicy policy) {
  return policy == MessagePolicy::aes128_ctr ? 16 : 32;
}
/// Of a whole key: SigningKey, EncryptingKey, KeyNonce, one behind the other.
constexpr std::size_t key_octets(MessagePolicy policy) {
  return signing_key_octets + encrypting_key_octets(policy) + key_nonce_octets;
}
/// What security adds to a message that has ExtendedFlags1 already, as all of Programs have.
constexpr std::size_t added_octets(MessageMode mode) {
  return mode == MessageMode::none ? 0 : security_header_octets + signature_octets;
}

constexpr std::string_view uri_of(MessagePolicy policy) {
  return policy == MessagePolicy::aes128_ctr ? "http://opcfoundation.org/UA/SecurityPolicy#PubSub-Aes128-CTR"
                                             : "http://opcfoundation.org/UA/SecurityPolicy#PubSub-Aes256-CTR";
}

/// SecurityFlags.
namespace security_flags {
inline constexpr unsigned is_signed = 0x01;
inline constexpr unsigned is_encrypted = 0x02;
inline constexpr unsigned has_footer = 0x04;
inline constexpr unsigned force_key_reset = 0x08;
inline constexpr unsigned reserved = 0xF0;
}  // namespace security_flags

constexpr unsigned flags_of(MessageMode mode) {
  return mode == MessageMode::none   ? 0U
         : mode == MessageMode::sign ? security_flags::is_signed
                                     : security_flags::is_signed | security_flags::is_encrypted;
}

}  // namespace takt::security
