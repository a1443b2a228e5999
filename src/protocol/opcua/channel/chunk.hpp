// SPDX-License-Identifier: Apache-2.0
// Chunks of the secure conversation (OPC 10000-6, 6.7): how one is signed, encrypted, and opened again. Both
// directions, both sides.
#pragma once

#include "opcua/channel/policy.hpp"
#include "opcua/transport/message.hpp"
#include "security/certificate.hpp"
#include "security/symmetric.hpp"

namespace takt::opcua {

inline constexpr std::size_t sequence_header_octets = 8;
/// Where the sequence header of a MSG or CLO begins: behind channel id and token id.
inline constexpr std::size_t symmetric_header_octets = channel_header_octets + 4;

struct SequenceHeader {
  std::uint32_t sequence_number = 0;
  std::uint32_t request_id = 0;
};

/// Of one direction of one token.
class ChunkKeys {
 public:
  /// What P_SHA256 gives of the nonces: signing key, encrypting key, initial vector, one behind the other.
  ChunkKeys(const PolicyInfo& policy, security::Octets derived);
  static std::size_t octets(const PolicyInfo& policy) {
    return signing_key_octets + policy.encrypting_key_octets + security::aes_block_octets;
  }

 private:
  friend void seal(std::vector<std::byte>& chunk, ChunkKeys& keys, MessageSecurityMode mode);
  friend std::optional<Octets> open(std::span<std::byte> chunk, ChunkKeys& keys, MessageSecurityMode mode);
  security::Hmac hmac_;
  security::AesCbc cipher_;
  security::AesBlock initial_vector_{};
};

/// Of both directions (OPC 10000-6, 6.7.5).
struct TokenKeys {
  ChunkKeys client;
  ChunkKeys server;
};
TokenKeys derive_keys(const PolicyInfo& policy, Octets client_nonce, Octets server_nonce);

/// `chunk` is a MSG or CLO in clear, headers and body; padding and signature are added, its size is set, and it is
/// encrypted if the mode says so.
void seal(std::vector<std::byte>& chunk, ChunkKeys& keys, MessageSecurityMode mode);
/// In place. Sequence header and body; nothing if anything of it is not sound, and not what.
std::optional<Octets> open(std::span<std::byte> chunk, ChunkKeys& keys, MessageSecurityMode mode);
/// How long the body of a MSG may be, so that the chunk has at most so many octets.
std::size_t most_body_octets(std::size_t chunk_octets, MessageSecurityMode mode);

/// The security header of an OPN.
struct AsymmetricHeader {
  Text policy_uri;
  Bytes sender_certificate;   ///< a chain, or null
  Bytes receiver_thumbprint;  ///< SHA-1, or null
  static constexpr auto members() {
    return std::tuple(&AsymmetricHeader::policy_uri, &AsymmetricHeader::sender_certificate,
                      &AsymmetricHeader::receiver_thumbprint);
  }
};
/// Where the sequence header begins; nothing if the header is malformed.
std::optional<std::size_t> decode_asymmetric_header(Octets chunk, AsymmetricHeader& header);

/// `chunk` is an OPN in clear whose sequence header begins at `clear_from`. Signed with our key, encrypted with the
/// other's. False if a key cannot.
bool seal_asymmetric(std::vector<std::byte>& chunk, std::size_t clear_from, const PolicyInfo& policy,
                     const security::PrivateKey& own, const security::PublicKey& other);
/// Sequence header and body in clear; nothing if anything of it is not sound.
std::optional<std::vector<std::byte>> open_asymmetric(Octets chunk, std::size_t clear_from, const PolicyInfo& policy,
                                                      const security::PrivateKey& own,
                                                      const security::PublicKey& other);

/// What may come behind a sequence number: the next one, or after the end a small one (OPC 10000-6, 6.7.2.4).
constexpr bool follows(std::uint32_t next, std::uint32_t last) {
  return next == last + 1 || (last > 4'294'966'271U && next < 1024);
}

}  // namespace takt::opcua
