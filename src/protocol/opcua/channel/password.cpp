// SPDX-License-Identifier: Apache-2.0
#include "opcua/channel/password.hpp"

#include <algorithm>

#include "uadp/octets.hpp"

namespace takt::opcua {

std::vector<std::byte> joined(security::Octets a, security::Octets b) {
  std::vector<std::byte> both(a.begin(), a.end());
  both.insert(both.end(), b.begin(), b.end());
  return both;
}

std::optional<std::vector<std::byte>> encrypted_password(const PolicyInfo& policy, const security::PublicKey& server,
                                                         security::Octets password, security::Octets nonce) {
  security::Secret clear(sizeof(std::uint32_t) + password.size() + nonce.size());
  uadp::store_little_endian(clear.octets().data(), static_cast<std::uint32_t>(password.size() + nonce.size()));
  std::copy(nonce.begin(), nonce.end(),
            std::copy(password.begin(), password.end(), clear.octets().begin() + sizeof(std::uint32_t)));
  return server.encrypt(policy.encryption, security::Octets(clear.octets()));
}

/// Length of both, password, nonce, zeros at most.
std::optional<std::string> password_in(security::Octets clear, security::Octets nonce) {
  uadp::Reader reader(clear);
  const std::size_t length = reader.get<std::uint32_t>();
  if (reader.failed() || length < nonce.size() || length > reader.left() ||
      length - nonce.size() > most_password_octets)
    return std::nullopt;
  const security::Octets password = reader.take(length - nonce.size());
  const security::Octets told = reader.take(nonce.size());
  const security::Octets rest = reader.rest();
  if (!security::equal_in_constant_time(told, nonce) ||
      std::any_of(rest.begin(), rest.end(), [](std::byte each) { return each != std::byte{0}; }))
    return std::nullopt;
  return std::string(reinterpret_cast<const char*>(password.data()), password.size());
}

}  // namespace takt::opcua
