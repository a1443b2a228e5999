// SPDX-License-Identifier: Apache-2.0
#include "opcua/encoding/status.hpp"

namespace takt::opcua {
namespace {

struct Name {
  StatusCode code;
  std::string_view name;
};

/// Those of connections, channels, sessions and calls: what logs speak of.
constexpr Name names[] = {
    {StatusCode::Good, "Good"},
    {StatusCode::BadInternalError, "Bad_InternalError"},
    {StatusCode::BadDecodingError, "Bad_DecodingError"},
    {StatusCode::BadEncodingLimitsExceeded, "Bad_EncodingLimitsExceeded"},
    {StatusCode::BadTimeout, "Bad_Timeout"},
    {StatusCode::BadServiceUnsupported, "Bad_ServiceUnsupported"},
    {StatusCode::BadShutdown, "Bad_Shutdown"},
    {StatusCode::BadCertificateInvalid, "Bad_CertificateInvalid"},
    {StatusCode::BadSecurityChecksFailed, "Bad_SecurityChecksFailed"},
    {StatusCode::BadCertificateTimeInvalid, "Bad_CertificateTimeInvalid"},
    {StatusCode::BadCertificateUriInvalid, "Bad_CertificateUriInvalid"},
    {StatusCode::BadCertificateUseNotAllowed, "Bad_CertificateUseNotAllowed"},
    {StatusCode::BadCertificateUntrusted, "Bad_CertificateUntrusted"},
    {StatusCode::BadUserAccessDenied, "Bad_UserAccessDenied"},
    {StatusCode::BadIdentityTokenInvalid, "Bad_IdentityTokenInvalid"},
    {StatusCode::BadIdentityTokenRejected, "Bad_IdentityTokenRejected"},
    {StatusCode::BadSecureChannelIdInvalid, "Bad_SecureChannelIdInvalid"},
    {StatusCode::BadNonceInvalid, "Bad_NonceInvalid"},
    {StatusCode::BadSessionIdInvalid, "Bad_SessionIdInvalid"},
    {StatusCode::BadSessionClosed, "Bad_SessionClosed"},
    {StatusCode::BadSessionNotActivated, "Bad_SessionNotActivated"},
    {StatusCode::BadRequestTypeInvalid, "Bad_RequestTypeInvalid"},
    {StatusCode::BadSecurityModeRejected, "Bad_SecurityModeRejected"},
    {StatusCode::BadSecurityPolicyRejected, "Bad_SecurityPolicyRejected"},
    {StatusCode::BadTooManySessions, "Bad_TooManySessions"},
    {StatusCode::BadApplicationSignatureInvalid, "Bad_ApplicationSignatureInvalid"},
    {StatusCode::BadTcpServerTooBusy, "Bad_TcpServerTooBusy"},
    {StatusCode::BadTcpMessageTypeInvalid, "Bad_TcpMessageTypeInvalid"},
    {StatusCode::BadTcpSecureChannelUnknown, "Bad_TcpSecureChannelUnknown"},
    {StatusCode::BadTcpMessageTooLarge, "Bad_TcpMessageTooLarge"},
    {StatusCode::BadTcpNotEnoughResources, "Bad_TcpNotEnoughResources"},
    {StatusCode::BadTcpInternalError, "Bad_TcpInternalError"},
    {StatusCode::BadTcpEndpointUrlInvalid, "Bad_TcpEndpointUrlInvalid"},
    {StatusCode::BadSecureChannelTokenUnknown, "Bad_SecureChannelTokenUnknown"},
    {StatusCode::BadSequenceNumberInvalid, "Bad_SequenceNumberInvalid"},
    {StatusCode::BadInvalidState, "Bad_InvalidState"},
    {StatusCode::BadResourceUnavailable, "Bad_ResourceUnavailable"},
    {StatusCode::BadRequestTooLarge, "Bad_RequestTooLarge"},
    {StatusCode::BadResponseTooLarge, "Bad_ResponseTooLarge"},
    {StatusCode::BadProtocolVersionUnsupported, "Bad_ProtocolVersionUnsupported"},
    {StatusCode::BadSecurityModeInsufficient, "Bad_SecurityModeInsufficient"},
    {StatusCode::BadNotExecutable, "Bad_NotExecutable"},
};

}  // namespace

std::string_view short_name_of(StatusCode status) {
  for (const Name& each : names)
    if (each.code == status) return each.name;
  return "(other)";
}

}  // namespace takt::opcua
