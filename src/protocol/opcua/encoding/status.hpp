// SPDX-License-Identifier: Apache-2.0
// StatusCodes of a server (OPC 10000-4, 7.39): what its services, its channel and its connections answer.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace takt::opcua {

enum class StatusCode : std::uint32_t {
  Good = 0x00000000,
  /// Good, of a value whose queue ran over behind it (InfoType DataValue, Overflow).
  GoodOverflow = 0x00000480,
  BadUnexpectedError = 0x80010000,
  BadInternalError = 0x80020000,
  BadResourceUnavailable = 0x80040000,
  BadEncodingError = 0x80060000,
  BadDecodingError = 0x80070000,
  BadEncodingLimitsExceeded = 0x80080000,
  BadTimeout = 0x800A0000,
  BadServiceUnsupported = 0x800B0000,
  BadShutdown = 0x800C0000,
  BadNothingToDo = 0x800F0000,
  BadTooManyOperations = 0x80100000,
  BadCertificateInvalid = 0x80120000,
  BadSecurityChecksFailed = 0x80130000,
  BadCertificateTimeInvalid = 0x80140000,
  BadCertificateUriInvalid = 0x80170000,
  BadCertificateUseNotAllowed = 0x80180000,
  BadCertificateUntrusted = 0x801A0000,
  BadUserAccessDenied = 0x801F0000,
  BadIdentityTokenInvalid = 0x80200000,
  BadIdentityTokenRejected = 0x80210000,
  BadSecureChannelIdInvalid = 0x80220000,
  BadNonceInvalid = 0x80240000,
  BadSessionIdInvalid = 0x80250000,
  BadSessionClosed = 0x80260000,
  BadSessionNotActivated = 0x80270000,
  BadSubscriptionIdInvalid = 0x80280000,
  BadTimestampsToReturnInvalid = 0x802B0000,
  BadNodeIdUnknown = 0x80340000,
  BadAttributeIdInvalid = 0x80350000,
  BadIndexRangeInvalid = 0x80360000,
  BadIndexRangeNoData = 0x80370000,
  BadDataEncodingInvalid = 0x80380000,
  BadDataEncodingUnsupported = 0x80390000,
  BadNotReadable = 0x803A0000,
  BadNotWritable = 0x803B0000,
  BadOutOfRange = 0x803C0000,
  BadNotFound = 0x803E0000,
  BadMonitoringModeInvalid = 0x80410000,
  BadMonitoredItemIdInvalid = 0x80420000,
  BadMonitoredItemFilterUnsupported = 0x80440000,
  BadFilterNotAllowed = 0x80450000,
  BadEventFilterInvalid = 0x80470000,
  BadFilterOperandInvalid = 0x80490000,
  BadContinuationPointInvalid = 0x804A0000,
  BadNoContinuationPoints = 0x804B0000,
  BadReferenceTypeIdInvalid = 0x804C0000,
  BadBrowseDirectionInvalid = 0x804D0000,
  BadRequestTypeInvalid = 0x80530000,
  BadSecurityModeRejected = 0x80540000,
  BadSecurityPolicyRejected = 0x80550000,
  BadTooManySessions = 0x80560000,
  BadApplicationSignatureInvalid = 0x80580000,
  BadBrowseNameInvalid = 0x80600000,
  BadViewIdUnknown = 0x806B0000,
  BadNoMatch = 0x806F0000,
  BadMaxAgeInvalid = 0x80700000,
  BadWriteNotSupported = 0x80730000,
  BadTypeMismatch = 0x80740000,
  BadMethodInvalid = 0x80750000,
  BadArgumentsMissing = 0x80760000,
  BadTooManySubscriptions = 0x80770000,
  BadTooManyPublishRequests = 0x80780000,
  BadNoSubscription = 0x80790000,
  BadSequenceNumberUnknown = 0x807A0000,
  BadMessageNotAvailable = 0x807B0000,
  BadTcpServerTooBusy = 0x807D0000,
  BadTcpMessageTypeInvalid = 0x807E0000,
  BadTcpSecureChannelUnknown = 0x807F0000,
  BadTcpMessageTooLarge = 0x80800000,
  BadTcpNotEnoughResources = 0x80810000,
  BadTcpInternalError = 0x80820000,
  BadTcpEndpointUrlInvalid = 0x80830000,
  BadSecureChannelTokenUnknown = 0x80870000,
  BadSequenceNumberInvalid = 0x80880000,
  BadInvalidArgument = 0x80AB0000,
  BadInvalidState = 0x80AF0000,
  BadRequestTooLarge = 0x80B80000,
  BadResponseTooLarge = 0x80B90000,
  BadProtocolVersionUnsupported = 0x80BE0000,
  BadFilterOperatorInvalid = 0x80C10000,
  BadFilterOperatorUnsupported = 0x80C20000,
  BadTooManyMonitoredItems = 0x80DB0000,
  BadTooManyArguments = 0x80E50000,
  BadSecurityModeInsufficient = 0x80E60000,
  BadNotExecutable = 0x81110000,
  GoodSubscriptionTransferred = 0x002D0000,
};

constexpr std::uint32_t code_of(StatusCode status) { return static_cast<std::uint32_t>(status); }
/// Neither Uncertain nor Bad: the two upper bits are the severity.
constexpr bool is_good(StatusCode status) { return code_of(status) >> 30 == 0; }
constexpr bool is_bad(StatusCode status) { return code_of(status) >> 30 >= 2; }

/// The name as in the standard's list for those that a log or an ERR speaks of; "(other)" for the rest.
std::string_view short_name_of(StatusCode status);

}  // namespace takt::opcua
