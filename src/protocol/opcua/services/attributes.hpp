// SPDX-License-Identifier: Apache-2.0
// Read, Write and Call (OPC 10000-4, 5.10 and 5.11), and the structures that values hold.
#pragma once

#include "opcua/services/headers.hpp"

namespace takt::opcua {

enum class TimestampsToReturn : std::int32_t { Source, Server, Both, Neither };
/// OPC 10000-6, Annex A.1.
enum class AttributeId : std::uint32_t {
  NodeId = 1,
  NodeClass,
  BrowseName,
  DisplayName,
  Description,
  WriteMask,
  UserWriteMask,
  IsAbstract,
  Symmetric,
  InverseName,
  ContainsNoLoops,
  EventNotifier,
  Value,
  DataType,
  ValueRank,
  ArrayDimensions,
  AccessLevel,
  UserAccessLevel,
  MinimumSamplingInterval,
  Historizing,
  Executable,
  UserExecutable,
  DataTypeDefinition,
  RolePermissions,
  UserRolePermissions,
  AccessRestrictions,
  AccessLevelEx
};

struct ReadValueId {
  static constexpr std::uint32_t encoding_id = 628;
  NodeId node_id;
  std::uint32_t attribute_id = 0;
  Text index_range;
  QualifiedName data_encoding;
  static constexpr auto members() {
    return std::tuple(&ReadValueId::node_id, &ReadValueId::attribute_id, &ReadValueId::index_range,
                      &ReadValueId::data_encoding);
  }
};

struct ReadRequest {
  static constexpr std::uint32_t encoding_id = 631;
  RequestHeader request_header;
  double max_age = 0;
  TimestampsToReturn timestamps_to_return = TimestampsToReturn::Source;
  List<ReadValueId> nodes_to_read;
  static constexpr auto members() {
    return std::tuple(&ReadRequest::request_header, &ReadRequest::max_age, &ReadRequest::timestamps_to_return,
                      &ReadRequest::nodes_to_read);
  }
};

struct ReadResponse {
  static constexpr std::uint32_t encoding_id = 634;
  ResponseHeader response_header;
  List<DataValue> results;
  List<DiagnosticInfo> diagnostic_infos;
  static constexpr auto members() {
    return std::tuple(&ReadResponse::response_header, &ReadResponse::results, &ReadResponse::diagnostic_infos);
  }
};

struct WriteValue {
  static constexpr std::uint32_t encoding_id = 670;
  NodeId node_id;
  std::uint32_t attribute_id = 0;
  Text index_range;
  DataValue value;
  static constexpr auto members() {
    return std::tuple(&WriteValue::node_id, &WriteValue::attribute_id, &WriteValue::index_range, &WriteValue::value);
  }
};

struct WriteRequest {
  static constexpr std::uint32_t encoding_id = 673;
  RequestHeader request_header;
  List<WriteValue> nodes_to_write;
  static constexpr auto members() { return std::tuple(&WriteRequest::request_header, &WriteRequest::nodes_to_write); }
};

struct WriteResponse {
  static constexpr std::uint32_t encoding_id = 676;
  ResponseHeader response_header;
  List<StatusCode> results;
  List<DiagnosticInfo> diagnostic_infos;
  static constexpr auto members() {
    return std::tuple(&WriteResponse::response_header, &WriteResponse::results, &WriteResponse::diagnostic_infos);
  }
};

struct CallMethodRequest {
  static constexpr std::uint32_t encoding_id = 706;
  NodeId object_id;
  NodeId method_id;
  List<Variant> input_arguments;
  static constexpr auto members() {
    return std::tuple(&CallMethodRequest::object_id, &CallMethodRequest::method_id,
                      &CallMethodRequest::input_arguments);
  }
};

struct CallRequest {
  static constexpr std::uint32_t encoding_id = 712;
  RequestHeader request_header;
  List<CallMethodRequest> methods_to_call;
  static constexpr auto members() { return std::tuple(&CallRequest::request_header, &CallRequest::methods_to_call); }
};

struct CallMethodResult {
  static constexpr std::uint32_t encoding_id = 709;
  StatusCode status_code = StatusCode::Good;
  List<StatusCode> input_argument_results;
  List<DiagnosticInfo> input_argument_diagnostic_infos;
  List<Variant> output_arguments;
  static constexpr auto members() {
    return std::tuple(&CallMethodResult::status_code, &CallMethodResult::input_argument_results,
                      &CallMethodResult::input_argument_diagnostic_infos, &CallMethodResult::output_arguments);
  }
};

struct CallResponse {
  static constexpr std::uint32_t encoding_id = 715;
  ResponseHeader response_header;
  List<CallMethodResult> results;
  List<DiagnosticInfo> diagnostic_infos;
  static constexpr auto members() {
    return std::tuple(&CallResponse::response_header, &CallResponse::results, &CallResponse::diagnostic_infos);
  }
};

struct Argument {
  static constexpr std::uint32_t encoding_id = 298;
  Text name;
  NodeId data_type;
  std::int32_t value_rank = 0;
  List<std::uint32_t> array_dimensions;
  LocalizedText description;
  static constexpr auto members() {
    return std::tuple(&Argument::name, &Argument::data_type, &Argument::value_rank, &Argument::array_dimensions,
                      &Argument::description);
  }
};

struct BuildInfo {
  static constexpr std::uint32_t encoding_id = 340;
  Text product_uri;
  Text manufacturer_name;
  Text product_name;
  Text software_version;
  Text build_number;
  DateTime build_date;
  static constexpr auto members() {
    return std::tuple(&BuildInfo::product_uri, &BuildInfo::manufacturer_name, &BuildInfo::product_name,
                      &BuildInfo::software_version, &BuildInfo::build_number, &BuildInfo::build_date);
  }
};

struct ServerStatusDataType {
  static constexpr std::uint32_t encoding_id = 864;
  DateTime start_time;
  DateTime current_time;
  std::int32_t state = 0;
  BuildInfo build_info;
  std::uint32_t seconds_till_shutdown = 0;
  LocalizedText shutdown_reason;
  static constexpr auto members() {
    return std::tuple(&ServerStatusDataType::start_time, &ServerStatusDataType::current_time,
                      &ServerStatusDataType::state, &ServerStatusDataType::build_info,
                      &ServerStatusDataType::seconds_till_shutdown, &ServerStatusDataType::shutdown_reason);
  }
};

struct ProgramDiagnostic2DataType {
  static constexpr std::uint32_t encoding_id = 24034;
  NodeId create_session_id;
  Text create_client_name;
  DateTime invocation_creation_time;
  DateTime last_transition_time;
  Text last_method_call;
  NodeId last_method_session_id;
  List<Argument> last_method_input_arguments;
  List<Argument> last_method_output_arguments;
  List<Variant> last_method_input_values;
  List<Variant> last_method_output_values;
  DateTime last_method_call_time;
  StatusCode last_method_return_status = StatusCode::Good;
  static constexpr auto members() {
    return std::tuple(
        &ProgramDiagnostic2DataType::create_session_id, &ProgramDiagnostic2DataType::create_client_name,
        &ProgramDiagnostic2DataType::invocation_creation_time, &ProgramDiagnostic2DataType::last_transition_time,
        &ProgramDiagnostic2DataType::last_method_call, &ProgramDiagnostic2DataType::last_method_session_id,
        &ProgramDiagnostic2DataType::last_method_input_arguments,
        &ProgramDiagnostic2DataType::last_method_output_arguments,
        &ProgramDiagnostic2DataType::last_method_input_values, &ProgramDiagnostic2DataType::last_method_output_values,
        &ProgramDiagnostic2DataType::last_method_call_time, &ProgramDiagnostic2DataType::last_method_return_status);
  }
};

}  // namespace takt::opcua
