// SPDX-License-Identifier: Apache-2.0
// Digests, HMAC and AES, by OpenSSL. What is made of a key is made once; a message allocates nothing.
//
// Lengths are in octets. One that does not fit is an error of takt (TAKT_CHECK), never of a user: whoever reads a key
// from outside looks at its length first.
#pragma once

#include <array>
#include <memory>

#include "security/secret.hpp"

struct evp_mac_ctx_st;
struct evp_cipher_ctx_st;

namespace takt::security {

enum class Hash : std::uint8_t { sha1, sha256 };
constexpr std::size_t digest_octets(Hash hash) { return hash == Hash::sha1 ? 20 : 32; }
inline constexpr std::size_t aes_block_octets = 16;

using Sha1Digest = std::array<std::byte, 20>;
using Sha256Digest = std::array<std::byte, 32>;
using AesBlock = std::array<std::byte, aes_block_octets>;

Sha1Digest sha1(Octets octets);
Sha256Digest sha256(Octets octets);

/// HMAC (RFC 2104) with one key, over octets that come in pieces or at once.
class Hmac {
 public:
  /// The key has at least one octet.
  Hmac(Hash hash, Octets key);
  Hmac(Hmac&&) noexcept;
  Hmac& operator=(Hmac&&) noexcept;
  ~Hmac();

  std::size_t size() const { return digest_octets(hash_); }
  void add(Octets octets);
  /// Of all that was added since the last one; `mac` has room for size() octets.
  void finish(std::span<std::byte> mac);
  /// The same at once.
  void sign(Octets octets, std::span<std::byte> mac);
  /// Whether `mac` is the whole code of the octets; in constant time.
  bool verify(Octets octets, Octets mac);

 private:
  void begin();

  Hash hash_;
  bool begun_ = false;
  struct Drop {
    void operator()(evp_mac_ctx_st* context) const;
  };
  std::unique_ptr<evp_mac_ctx_st, Drop> context_;
};

namespace detail {
struct DropCipher {
  void operator()(evp_cipher_ctx_st* context) const;
};
using Cipher = std::unique_ptr<evp_cipher_ctx_st, DropCipher>;
}  // namespace detail

/// AES in counter mode (NIST SP 800-38A, 6.5); the same makes cipher text of clear text and clear text of cipher text.
class AesCtr {
 public:
  /// A key of 16 or 32 octets.
  explicit AesCtr(Octets key);
  /// In place. `counter` is the first counter block; the whole of it counts, as one big-endian number.
  void apply(const AesBlock& counter, std::span<std::byte> octets);

 private:
  detail::Cipher cipher_;
};

/// AES in cipher block chaining mode (NIST SP 800-38A, 6.2), without padding of its own.
class AesCbc {
 public:
  /// A key of 16 or 32 octets.
  explicit AesCbc(Octets key);
  /// In place; whole blocks only.
  void encrypt(const AesBlock& initial_vector, std::span<std::byte> octets);
  void decrypt(const AesBlock& initial_vector, std::span<std::byte> octets);

 private:
  detail::Cipher encrypting_;
  detail::Cipher decrypting_;
};

}  // namespace takt::security
