// SPDX-License-Identifier: Apache-2.0
// Security policies (OPC 10000-7, 6.6.161 and its neighbours) as one table. Those that were withdrawn are not there.
#pragma once

#include <array>
#include <string_view>

#include "opcua/services/channel.hpp"
#include "security/asymmetric.hpp"

namespace takt::opcua {

enum class SecurityPolicy : std::uint8_t { None, Basic256Sha256, Aes128Sha256RsaOaep, Aes256Sha256RsaPss };

struct PolicyInfo {
  SecurityPolicy policy;
  std::string_view name;  ///< as files and logs have it
  std::string_view uri;
  security::SignatureScheme signature = security::SignatureScheme::pkcs1_sha256;
  std::string_view signature_uri = {};
  security::EncryptionScheme encryption = security::EncryptionScheme::oaep_sha1;
  std::string_view encryption_uri = {};
  std::size_t encrypting_key_octets = 0;  ///< of AES-CBC
  std::uint8_t level = 0;                 ///< SecurityLevel with Sign; greater is better
};

inline constexpr std::size_t signing_key_octets = 32;  ///< of HMAC-SHA256, which all of them have
inline constexpr std::size_t signature_octets = 32;
inline constexpr std::size_t nonce_octets = 32;

inline constexpr std::array<PolicyInfo, 4> policies{{
    {SecurityPolicy::None, "None", "http://opcfoundation.org/UA/SecurityPolicy#None"},
    {SecurityPolicy::Basic256Sha256, "Basic256Sha256", "http://opcfoundation.org/UA/SecurityPolicy#Basic256Sha256",
     security::SignatureScheme::pkcs1_sha256, "http://www.w3.org/2001/04/xmldsig-more#rsa-sha256",
     security::EncryptionScheme::oaep_sha1, "http://www.w3.org/2001/04/xmlenc#rsa-oaep", 32, 10},
    {SecurityPolicy::Aes128Sha256RsaOaep, "Aes128_Sha256_RsaOaep",
     "http://opcfoundation.org/UA/SecurityPolicy#Aes128_Sha256_RsaOaep", security::SignatureScheme::pkcs1_sha256,
     "http://www.w3.org/2001/04/xmldsig-more#rsa-sha256", security::EncryptionScheme::oaep_sha1,
     "http://www.w3.org/2001/04/xmlenc#rsa-oaep", 16, 20},
    {SecurityPolicy::Aes256Sha256RsaPss, "Aes256_Sha256_RsaPss",
     "http://opcfoundation.org/UA/SecurityPolicy#Aes256_Sha256_RsaPss", security::SignatureScheme::pss_sha256,
     "http://opcfoundation.org/UA/security/rsa-pss-sha2-256", security::EncryptionScheme::oaep_sha256,
     "http://opcfoundation.org/UA/security/rsa-oaep-sha2-256", 32, 30},
}};

constexpr const PolicyInfo& info(SecurityPolicy policy) { return policies[static_cast<std::size_t>(policy)]; }
constexpr bool is_secured(SecurityPolicy policy) { return policy != SecurityPolicy::None; }

namespace detail {
constexpr bool policies_are_complete() {
  for (std::size_t i = 0; i < policies.size(); ++i)
    if (static_cast<std::size_t>(policies[i].policy) != i) return false;
  return true;
}
static_assert(policies_are_complete(), "policies holds every SecurityPolicy, in order");
}  // namespace detail

/// Null if there is none with this URI.
constexpr const PolicyInfo* policy_with_uri(std::string_view uri) {
  for (const PolicyInfo& each : policies)
    if (each.uri == uri) return &each;
  return nullptr;
}

/// What an endpoint offers: None goes with None only, the others with Sign or SignAndEncrypt.
struct ChannelSecurity {
  SecurityPolicy policy = SecurityPolicy::None;
  MessageSecurityMode mode = MessageSecurityMode::None;
  bool is_encrypted() const { return mode == MessageSecurityMode::SignAndEncrypt; }
  bool operator==(const ChannelSecurity&) const = default;
};

}  // namespace takt::opcua
