// SPDX-License-Identifier: Apache-2.0
// X.509 certificates as OPC UA uses them (OPC 10000-6, 6.2): what is read of one, and our own.
#pragma once

#include <cstdint>

#include "security/asymmetric.hpp"
#include "security/symmetric.hpp"

struct x509_st;
struct X509_crl_st;

namespace takt::security {

/// Octets of the first DER object, which may have others behind it (a chain); 0 if there is none.
std::size_t first_der_octets(Octets octets);

class Certificate {
 public:
  /// The first of a chain. Nothing if it is none or its key is not RSA.
  static std::optional<Certificate> from_der(Octets octets);
  static std::optional<Certificate> from_pem(std::string_view text);

  Octets der() const { return der_; }
  std::string to_pem() const;
  const Sha1Digest& thumbprint() const { return thumbprint_; }
  const PublicKey& key() const { return key_; }

  /// The first URI of subjectAltName; empty if there is none.
  std::string application_uri() const;
  /// The subject on one line, for people.
  std::string subject() const;
  /// Seconds since 1970.
  std::int64_t valid_from() const;
  std::int64_t valid_until() const;
  /// Signed with SHA-256 or better, and a key of 2048 to 4096 bits.
  bool is_strong() const;
  /// What no usage extension forbids: digitalSignature and keyEncipherment, clientAuth.
  bool may_sign_and_encrypt() const;
  bool may_be_client() const;
  bool is_authority() const;
  /// How many authorities may stand between it and a certificate; nothing: any number.
  std::optional<std::int64_t> path_length() const;
  bool is_issued_by(const Certificate& issuer) const;

  bool operator==(const Certificate& other) const { return der_ == other.der_; }

 private:
  Certificate(std::shared_ptr<x509_st> certificate, PublicKey key);
  static std::optional<Certificate> take(x509_st* certificate);
  friend class RevocationList;
  friend Certificate self_signed(const PrivateKey& key, const struct OwnCertificate& what);

  std::shared_ptr<x509_st> certificate_;
  std::vector<std::byte> der_;
  Sha1Digest thumbprint_{};
  PublicKey key_;
};

class RevocationList {
 public:
  static std::optional<RevocationList> from_der(Octets octets);
  static std::optional<RevocationList> from_pem(std::string_view text);
  bool is_issued_by(const Certificate& issuer) const;
  bool has(const Certificate& certificate) const;

 private:
  explicit RevocationList(std::shared_ptr<X509_crl_st> list) : list_(std::move(list)) {}
  std::shared_ptr<X509_crl_st> list_;
};

/// What our own certificate says.
struct OwnCertificate {
  std::string application_uri;
  std::string common_name;
  std::vector<std::string> dns_names;
  std::vector<std::string> addresses;  ///< IPv4 or IPv6
  std::uint64_t serial = 1;            ///< not 0, and not twice of one name
  std::int64_t valid_from = 0;         ///< seconds since 1970
  std::int64_t valid_until = 0;
  bool is_authority = false;  ///< signs others; for tests of chains
};
/// SHA-256, with the usages that OPC 10000-6, 6.2.2 asks for. Throws std::runtime_error if OpenSSL takes no such text.
Certificate self_signed(const PrivateKey& key, const OwnCertificate& what);

}  // namespace takt::security
