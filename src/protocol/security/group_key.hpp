// SPDX-License-Identifier: Apache-2.0
// One key of a SecurityGroup (OPC 10000-14, 8.3 and 7.2.4.4.3): cut into a signing key, an encrypting key and a nonce;
// no derivation.
#pragma once

#include "security/message_policy.hpp"
#include "security/symmetric.hpp"

namespace takt::security {

class GroupKey {
 public:
  /// `key` has key_octets(policy).
  GroupKey(MessagePolicy policy, Octets key);

  /// HMAC-SHA256.
  void sign(Octets message, std::span<std::byte> signature) { signing_.sign(message, signature); }
  bool verify(Octets message, Octets signature) { return signing_.verify(message, signature); }
  /// Makes cipher text of clear text, or clear text of cipher text, in place. `nonce` is the message's, of 8 octets.
  void crypt(Octets nonce, std::span<std::byte> payload);

 private:
  Hmac signing_;
  AesCtr encrypting_;
  std::array<std::byte, key_nonce_octets> key_nonce_;
};

}  // namespace takt::security
