// SPDX-License-Identifier: Apache-2.0
// Events of a Program as values (OPC 10000-10, 5.2.5): what a server sends is made of these.
#pragma once

#include <string>

#include "program/method.hpp"
#include "program/result.hpp"
#include "program/state.hpp"
#include "sim/time.hpp"

namespace takt::program {

/// ProgramTransitionEventType (i=2378). Of a nested machine the numbers are that machine's.
struct TransitionEvent {
  std::string source_name;  ///< the Program
  sim::LocalTime time;
  std::uint16_t severity = 100;  ///< 1 to 1000
  std::uint32_t transition_number = 0;
  std::string transition_name;
  std::uint32_t from_number = 0;  ///< 0: no substate
  std::uint32_t to_number = 0;
  std::string from_name;
  std::string to_name;
  bool nested = false;                     ///< of a nested machine
  IntermediateResult intermediate_result;  ///< of a terminal transition: the final result
};

/// AuditProgramTransitionEventType (i=11856) with the fields of its base types.
struct AuditEvent {
  std::string source_name;  ///< "Method/Start" and so on, or "System"
  sim::LocalTime action_time_stamp;
  bool status = false;  ///< a method call caused the transition; false for internal causes and failed calls
  std::string server_id;
  std::string client_audit_entry_id;
  std::string client_user_id;
  std::uint16_t method_id = 0;     ///< i=... in namespace 0; 0 if no method caused it
  std::uint16_t old_state_id = 0;  ///< i=... in namespace 0
  std::uint16_t new_state_id = 0;
  std::uint32_t transition_number = 0;  ///< 0 after a failed call
};

/// NodeIds of the event types in namespace 0.
inline constexpr std::uint16_t program_transition_event_type = 2378;
inline constexpr std::uint16_t audit_program_transition_event_type = 11856;

}  // namespace takt::program
