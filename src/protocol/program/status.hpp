// SPDX-License-Identifier: Apache-2.0
// The OPC UA StatusCodes (OPC 10000-4, 7.39) that Programs and PubSub components give.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace takt::program {

enum class StatusCode : std::uint32_t {
  Good = 0x00000000,
  BadResourceUnavailable = 0x80040000,
  BadTimeout = 0x800A0000,
  BadShutdown = 0x800C0000,
  BadUserAccessDenied = 0x801F0000,
  BadNodeIdUnknown = 0x80340000,
  BadOutOfRange = 0x803C0000,
  BadTypeMismatch = 0x80740000,
  BadMethodInvalid = 0x80750000,
  BadArgumentsMissing = 0x80760000,
  BadInvalidArgument = 0x80AB0000,
  BadInvalidState = 0x80AF0000,    ///< the method is not allowed in the present state; nothing has changed
  BadStateNotActive = 0x80BF0000,  ///< of a variable of a nested machine whose parent state is not active
  BadTooManyArguments = 0x80E50000,
  BadNotExecutable = 0x81110000,
};

struct StatusInfo {
  StatusCode code;
  std::string_view name;  ///< as in the standard's StatusCode.csv, "Bad_" written apart
};

inline constexpr std::array<StatusInfo, 15> status_codes{{
    {StatusCode::Good, "Good"},
    {StatusCode::BadResourceUnavailable, "Bad_ResourceUnavailable"},
    {StatusCode::BadTimeout, "Bad_Timeout"},
    {StatusCode::BadShutdown, "Bad_Shutdown"},
    {StatusCode::BadUserAccessDenied, "Bad_UserAccessDenied"},
    {StatusCode::BadNodeIdUnknown, "Bad_NodeIdUnknown"},
    {StatusCode::BadOutOfRange, "Bad_OutOfRange"},
    {StatusCode::BadTypeMismatch, "Bad_TypeMismatch"},
    {StatusCode::BadMethodInvalid, "Bad_MethodInvalid"},
    {StatusCode::BadArgumentsMissing, "Bad_ArgumentsMissing"},
    {StatusCode::BadInvalidArgument, "Bad_InvalidArgument"},
    {StatusCode::BadInvalidState, "Bad_InvalidState"},
    {StatusCode::BadStateNotActive, "Bad_StateNotActive"},
    {StatusCode::BadTooManyArguments, "Bad_TooManyArguments"},
    {StatusCode::BadNotExecutable, "Bad_NotExecutable"},
}};

/// OPC 10000-4, 7.39: the two highest bits are the severity; 00 is good.
constexpr bool is_good(StatusCode code) { return (static_cast<std::uint32_t>(code) >> 30) == 0; }

/// The standard's name; "(unknown)" for a code that is not in the table.
constexpr std::string_view name_of(StatusCode code) {
  for (const StatusInfo& each : status_codes)
    if (each.code == code) return each.name;
  return "(unknown)";
}

}  // namespace takt::program
