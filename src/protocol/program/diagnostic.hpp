// SPDX-License-Identifier: Apache-2.0
// ProgramDiagnostic2DataType (i=24033; OPC 10000-10, 5.2.8): who made a Program and who called it last.
#pragma once

#include <optional>

#include "program/result.hpp"
#include "program/status.hpp"
#include "sim/time.hpp"

namespace takt::program {

/// An Argument of a method: name and name of its DataType.
struct Argument {
  std::string name;
  std::string data_type;
  bool operator==(const Argument&) const = default;
};

/// The members in the order of the binary encoding. Times are those of the server's clock; a codec adds the epoch.
struct ProgramDiagnostic {
  std::string create_session_id;
  std::string create_client_name;
  sim::LocalTime invocation_creation_time;
  std::optional<sim::LocalTime> last_transition_time;
  std::string last_method_call;  ///< the last call, successful or not; empty before the first one
  std::string last_method_session_id;
  std::vector<Argument> last_method_input_arguments;
  std::vector<Argument> last_method_output_arguments;
  std::vector<Value> last_method_input_values;
  std::vector<Value> last_method_output_values;
  std::optional<sim::LocalTime> last_method_call_time;
  StatusCode last_method_return_status = StatusCode::Good;
  bool operator==(const ProgramDiagnostic&) const = default;
};

}  // namespace takt::program
