// SPDX-License-Identifier: Apache-2.0
#include "opcua/channel/trust_list.hpp"

#include <algorithm>

namespace takt::opcua {
namespace {

using security::Certificate;

constexpr int most_authorities = 8;  // of a chain

const Certificate* issuer_of(const Certificate& certificate, const std::vector<Certificate>& among) {
  const auto found = std::find_if(among.begin(), among.end(), [&](const Certificate& each) {
    return each.is_authority() && certificate.is_issued_by(each);
  });
  return found == among.end() ? nullptr : &*found;
}

bool is_revoked(const Certificate& certificate, const Certificate& issuer, const TrustList& trust) {
  return std::any_of(trust.revoked.begin(), trust.revoked.end(),
                     [&](const auto& list) { return list.is_issued_by(issuer) && list.has(certificate); });
}

/// What speaks against an authority that `below` others stand under; nothing if all is well.
const char* refused_as_authority(const Certificate& authority, int below, std::int64_t now_s) {
  if (!authority.is_strong())
    return "its authority is weak: less than SHA-256, or a key of less than 2048 or more than 4096 bits";
  if (now_s < authority.valid_from() || now_s > authority.valid_until()) return "its authority is not valid now";
  const auto length = authority.path_length();
  return length && below > *length ? "its authority may not have so many below it" : nullptr;
}

/// Up the chain to one that is trusted, or to its end. Nothing but the lists makes the chain: what a client brings
/// along is not needed.
TrustVerdict check_chain(const Certificate& certificate, const TrustList& trust, std::int64_t now_s) {
  bool is_trusted = std::find(trust.trusted.begin(), trust.trusted.end(), certificate) != trust.trusted.end();
  const Certificate* at = &certificate;
  for (int i = 0; i < most_authorities; ++i) {
    const Certificate* const trusted = issuer_of(*at, trust.trusted);
    const Certificate* const issuer = trusted != nullptr ? trusted : issuer_of(*at, trust.issuers);
    if (issuer == nullptr || issuer == at || *issuer == *at) break;
    if (const char* const reason = refused_as_authority(*issuer, i, now_s))
      return {StatusCode::BadSecurityChecksFailed, reason};
    is_trusted = is_trusted || trusted != nullptr;
    if (is_revoked(*at, *issuer, trust)) return {StatusCode::BadSecurityChecksFailed, "revoked by its authority"};
    at = issuer;
  }
  return is_trusted ? TrustVerdict() : TrustVerdict{StatusCode::BadSecurityChecksFailed, "not in the trust list"};
}

}  // namespace

std::vector<std::string> authorities_without_list(const TrustList& trust) {
  std::vector<std::string> subjects;
  for (const auto* const list : {&trust.trusted, &trust.issuers})
    for (const Certificate& each : *list) {
      const bool has_list = std::any_of(trust.revoked.begin(), trust.revoked.end(),
                                        [&](const auto& revoked) { return revoked.is_issued_by(each); });
      if (each.is_authority() && !has_list) subjects.push_back(each.subject());
    }
  return subjects;
}

TrustVerdict check_certificate(const Certificate& certificate, const TrustList& trust, std::int64_t now_s) {
  if (!certificate.is_strong())
    return {StatusCode::BadSecurityChecksFailed,
            "signed by less than SHA-256, or a key of less than 2048 or more than 4096 bits"};
  if (const TrustVerdict chain = check_chain(certificate, trust, now_s); chain.status != StatusCode::Good) return chain;
  if (now_s < certificate.valid_from() || now_s > certificate.valid_until())
    return {StatusCode::BadCertificateTimeInvalid, "not valid now"};
  if (!certificate.may_sign_and_encrypt() || !certificate.may_be_client())
    return {StatusCode::BadCertificateUseNotAllowed, "not for signing, encrypting and being a client"};
  return {};
}

}  // namespace takt::opcua
