// SPDX-License-Identifier: Apache-2.0
// A password on its way from a client to a server (OPC 10000-4, 7.40.2.2): with the server's nonce behind it, so that
// it is good once, encrypted with its certificate.
#pragma once

#include <string>

#include "opcua/channel/policy.hpp"
#include "security/secret.hpp"

namespace takt::opcua {

inline constexpr std::size_t most_password_octets = 64;

/// Nothing if the key cannot.
std::optional<std::vector<std::byte>> encrypted_password(const PolicyInfo& policy, const security::PublicKey& server,
                                                         security::Octets password, security::Octets nonce);
/// What was encrypted, decrypted again; nothing if it is not sound or has another nonce.
std::optional<std::string> password_in(security::Octets clear, security::Octets nonce);

/// What signatures of sessions are over: a certificate and a nonce.
std::vector<std::byte> joined(security::Octets a, security::Octets b);

}  // namespace takt::opcua
