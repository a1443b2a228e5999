// SPDX-License-Identifier: Apache-2.0
// Whom the server trusts (OPC 10000-4, 6.1.3): a value that its host fills from a folder, and the checks of a client's
// certificate.
#pragma once

#include "opcua/encoding/status.hpp"
#include "security/certificate.hpp"

namespace takt::opcua {

struct TrustList {
  std::vector<security::Certificate> trusted;  ///< of clients, or of authorities whose certificates are trusted
  std::vector<security::Certificate>
      issuers;  ///< of authorities that are needed for a chain, and not trusted themselves
  std::vector<security::RevocationList> revoked;
};

/// What is to be told of a certificate: on the wire less than in the log.
struct TrustVerdict {
  StatusCode status = StatusCode::Good;  ///< what the wire says
  const char* reason = "";               ///< what the log says
};

/// The subjects of authorities of which there is no revocation list: what they have revoked is not known here.
std::vector<std::string> authorities_without_list(const TrustList& trust);

/// The checks in the order of the standard: key and signature, chain and trust, revocation, validity (`now_s` since
/// 1970), usage. The URI is CreateSession's matter.
TrustVerdict check_certificate(const security::Certificate& certificate, const TrustList& trust, std::int64_t now_s);

}  // namespace takt::opcua
