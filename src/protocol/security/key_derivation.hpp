// SPDX-License-Identifier: Apache-2.0
// Keys of secrets: P_SHA256 (RFC 5246, 5), and hashes of passwords (scrypt, RFC 7914).
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "security/symmetric.hpp"

namespace takt::security {

/// HMAC(secret, A1 + seed) + HMAC(secret, A2 + seed) + ..., A0 = seed, An = HMAC(secret, An-1).
Secret p_sha256(Octets secret, Octets seed, std::size_t octets);

/// A password as it may stand in a file: "scrypt$LOG2_N$R$P$SALT$HASH", salt and hash in hexadecimal.
class PasswordHash {
 public:
  /// Nothing if it is no such text, or one whose check would take too much time or memory.
  static std::optional<PasswordHash> parse(std::string_view text);
  /// `salt`: 16 octets that nobody can guess.
  static PasswordHash of(std::string_view password, Octets salt);

  std::string text() const;
  /// Takes as long for a wrong password as for the right one: some 50 ms.
  bool matches(std::string_view password) const;

 private:
  unsigned log2_n_ = 14;
  unsigned r_ = 8;
  unsigned p_ = 1;
  std::vector<std::byte> salt_;
  Sha256Digest hash_{};
};

}  // namespace takt::security
