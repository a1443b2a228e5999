// SPDX-License-Identifier: Apache-2.0
#include "security/secret.hpp"

#include <openssl/crypto.h>

namespace takt::security {

void wipe(std::span<std::byte> octets) noexcept {
  if (!octets.empty()) OPENSSL_cleanse(octets.data(), octets.size());
}

bool equal_in_constant_time(Octets a, Octets b) noexcept {
  return a.size() == b.size() && (a.empty() || CRYPTO_memcmp(a.data(), b.data(), a.size()) == 0);
}

}  // namespace takt::security
