// SPDX-License-Identifier: Apache-2.0
// RSA: signatures and encryption as the policies of OPC UA have them (OPC 10000-7), by OpenSSL.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "security/secret.hpp"

struct evp_pkey_st;

namespace takt::security {

/// RSASSA with SHA-256; the salt of PSS is as long as the digest.
enum class SignatureScheme : std::uint8_t { pkcs1_sha256, pss_sha256 };
/// RSAES-OAEP; mask and label by the same digest.
enum class EncryptionScheme : std::uint8_t { oaep_sha1, oaep_sha256 };

/// Octets of a block that padding takes.
constexpr std::size_t padding_octets(EncryptionScheme scheme) {
  return scheme == EncryptionScheme::oaep_sha1 ? 42 : 66;
}

class PublicKey {
 public:
  explicit PublicKey(std::shared_ptr<evp_pkey_st> key) : key_(std::move(key)) {}

  /// Of the modulus: of a signature, and of a block of what is encrypted.
  std::size_t octets() const;
  bool is_rsa() const;
  /// What fits into a block in clear.
  std::size_t clear_octets(EncryptionScheme scheme) const { return octets() - padding_octets(scheme); }

  bool verify(SignatureScheme scheme, Octets octets, Octets signature) const;
  /// Block by block, the last one as long as it is; nothing if the key cannot.
  std::optional<std::vector<std::byte>> encrypt(EncryptionScheme scheme, Octets clear) const;

 private:
  friend class PrivateKey;
  friend struct CertificateAccess;
  std::shared_ptr<evp_pkey_st> key_;
};

class PrivateKey {
 public:
  /// 2048 to 4096 bits. Throws std::runtime_error if OpenSSL cannot.
  static PrivateKey generate(unsigned bits);
  /// RSA only; nothing for anything else.
  static std::optional<PrivateKey> from_pem(std::string_view text);
  /// PKCS #8 without a password: whoever keeps it lets nobody else read it.
  std::string to_pem() const;

  const PublicKey& public_key() const { return public_; }
  std::vector<std::byte> sign(SignatureScheme scheme, Octets octets) const;
  /// Whole blocks. Nothing if they are no blocks or one of them is not sound; which one and why is not told.
  std::optional<Secret> decrypt(EncryptionScheme scheme, Octets cipher) const;

 private:
  explicit PrivateKey(std::shared_ptr<evp_pkey_st> key) : public_(std::move(key)) {}
  PublicKey public_;  // the same object of OpenSSL holds both
};

}  // namespace takt::security
