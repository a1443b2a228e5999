// SPDX-License-Identifier: Apache-2.0
// One Program as OPC 10000-10 has it whole: states and substates, methods with their checks, events, diagnostics,
// lifetime and results. The machine inside is the same `Machine` that a distributed participant moves.
#pragma once

#include <functional>

#include "program/diagnostic.hpp"
#include "program/event.hpp"
#include "program/machine.hpp"
#include "program/nested_machine.hpp"

namespace takt::program {

struct ProgramSettings {
  std::string name;
  State initial = State::Halted;  ///< Halted or Ready (4.2.10)
  /// A method that is absent cannot cause its transitions (5.2.1).
  MethodSet methods{Method::Start, Method::Suspend, Method::Resume, Method::Halt, Method::Reset};
  bool deletable = true;
  bool auto_delete = false;             ///< the server removes it when its execution has ended in Halted
  std::int32_t max_recycle_count = -1;  ///< how often it may be started again; below 0: any number; 0: never
  bool auditing = true;
  /// Reset in Suspended: transition 8, as in the nodeset; false: not allowed, as in the text of Part 10.
  bool reset_in_suspended = true;
  std::vector<NestedDescription> nested =
      std::vector<NestedDescription>(1, init_machine);  ///< at most one for each state
};

/// A client's call (OPC 10000-4, 5.11.2) as far as a Program looks at it.
struct Call {
  Method method = Method::Start;
  std::string session_id;
  std::string user_id;
  std::string client_audit_entry_id;
  bool user_permitted = true;    ///< UserExecutable
  std::vector<Value> arguments;  ///< must be as many as the method's input arguments, of their types
};

/// What a method takes, and what the Program does when it is called.
struct MethodBehaviour {
  std::vector<Argument> inputs;  ///< types Boolean, Int64, Double, String
  std::vector<Argument> outputs;
  /// Before the transition. A status that is not Good refuses the call and is returned; `outputs` are filled by it.
  std::function<StatusCode(const std::vector<Value>& inputs, std::vector<Value>& outputs)> action;
};

/// What a step led to, in the order in which it is sent: transition events, audit events, then the response.
struct Outcome {
  StatusCode status = StatusCode::Good;
  std::vector<TransitionEvent> events;
  std::vector<AuditEvent> audits;
  std::vector<Value> outputs;
  bool deleted = false;  ///< AutoDelete: the owner removes the Program and its results now
};

class Program {
 public:
  /// Who makes it, for the diagnostics.
  struct Creator {
    std::string session_id;
    std::string client_name;
  };
  Program(ProgramSettings settings, const Creator& creator, sim::LocalTime now);

  const std::string& name() const { return settings_.name; }
  const ProgramSettings& settings() const { return settings_; }
  const Machine& machine() const { return machine_; }
  State state() const { return machine_.state(); }
  /// The machine nested in a state; nullptr if there is none.
  const NestedMachine* nested(State parent) const;
  const ProgramDiagnostic& diagnostic() const { return diagnostic_; }
  std::int32_t recycle_count() const { return recycle_count_; }
  const FinalResultData& final_result() const { return final_result_; }

  void set_behaviour(Method method, MethodBehaviour behaviour);

  /// The Executable attribute: the method is there and causes a transition in the present state (OPC 10000-16, 4.4.2).
  bool executable(Method method) const;
  /// The checks of a client's call in this order: Bad_MethodInvalid, Bad_NotExecutable, Bad_UserAccessDenied,
  /// Bad_ArgumentsMissing, Bad_TooManyArguments, Bad_InvalidArgument; then Bad_InvalidState if the recycle limit is
  /// reached; then the action. A failed call changes nothing but the diagnostics, and is audited with Status false.
  Outcome call(const Call& call, sim::LocalTime now);

  /// A transition that the Program itself causes (`Transition::internal`): Bad_InvalidState if it may not.
  /// `result`: of 3, 4 and 8 the final result; of 1 the intermediate one.
  Outcome advance(std::uint32_t transition_number, sim::LocalTime now, std::vector<NamedValue> result = {});

  /// Goes to a substate of the present state, or to none with 0. Bad_InvalidState if no nested transition leads there.
  Outcome go_to_substate(std::uint32_t number, sim::LocalTime now, IntermediateResult result = {});

 private:
  StatusCode check(const Call& call) const;
  bool recycle_limit_reached() const;
  const Transition* transition_of(Method method) const;
  void take(const Transition& transition, sim::LocalTime now, std::vector<NamedValue> result, Outcome& outcome);
  void describe_nested(const NestedMachine& machine, const Subtransition& transition, sim::LocalTime now,
                       IntermediateResult result, Outcome& outcome) const;
  AuditEvent audit_of(State before, sim::LocalTime now) const;
  NestedMachine* nested_in(State parent);

  ProgramSettings settings_;
  Machine machine_;
  std::vector<NestedMachine> nested_;
  std::array<MethodBehaviour, methods.size()> behaviours_;
  ProgramDiagnostic diagnostic_;
  FinalResultData final_result_;
  std::int32_t recycle_count_ = 0;
  bool was_started_ = false;
};

}  // namespace takt::program
