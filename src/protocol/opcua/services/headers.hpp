// SPDX-License-Identifier: Apache-2.0
// Headers of all requests and responses, and the fault (OPC 10000-4, 7.32 to 7.34).
#pragma once

#include "opcua/encoding/decoder.hpp"

namespace takt::opcua {

struct RequestHeader {
  static constexpr std::uint32_t encoding_id = 391;
  NodeId authentication_token;
  DateTime timestamp;
  std::uint32_t request_handle = 0;
  std::uint32_t return_diagnostics = 0;
  Text audit_entry_id;
  std::uint32_t timeout_hint = 0;
  ExtensionObject additional_header;
  static constexpr auto members() {
    return std::tuple(&RequestHeader::authentication_token, &RequestHeader::timestamp, &RequestHeader::request_handle,
                      &RequestHeader::return_diagnostics, &RequestHeader::audit_entry_id, &RequestHeader::timeout_hint,
                      &RequestHeader::additional_header);
  }
};

struct ResponseHeader {
  static constexpr std::uint32_t encoding_id = 394;
  DateTime timestamp;
  std::uint32_t request_handle = 0;
  StatusCode service_result = StatusCode::Good;
  DiagnosticInfo service_diagnostics;
  List<Text> string_table;
  ExtensionObject additional_header;
  static constexpr auto members() {
    return std::tuple(&ResponseHeader::timestamp, &ResponseHeader::request_handle, &ResponseHeader::service_result,
                      &ResponseHeader::service_diagnostics, &ResponseHeader::string_table,
                      &ResponseHeader::additional_header);
  }
};

struct ServiceFault {
  static constexpr std::uint32_t encoding_id = 397;
  ResponseHeader response_header;
  static constexpr auto members() { return std::tuple(&ServiceFault::response_header); }
};

struct SignatureData {
  static constexpr std::uint32_t encoding_id = 458;
  Text algorithm;
  Bytes signature;
  static constexpr auto members() { return std::tuple(&SignatureData::algorithm, &SignatureData::signature); }
};

}  // namespace takt::opcua
