// SPDX-License-Identifier: Apache-2.0
#include "program/program.hpp"

#include <limits>

namespace takt::program {
namespace {

/// Position in the Value variant of a type by its name.
bool is_of_type(const Value& value, const std::string& data_type) {
  if (data_type == "Boolean") return std::holds_alternative<bool>(value);
  if (data_type == "Int64") return std::holds_alternative<std::int64_t>(value);
  if (data_type == "Double") return std::holds_alternative<double>(value);
  return data_type == "String" && std::holds_alternative<std::string>(value);
}

/// Transitions that end an execution: its result is final then.
bool ends_execution(const Transition& transition) {
  const bool was_executing = transition.from == State::Running || transition.from == State::Suspended;
  return was_executing && (transition.to == State::Halted || transition.to == State::Ready);
}

std::string name_of_substate(const NestedDescription& description, std::uint32_t number) {
  const Substate* const substate = description.substate(number);
  return std::string(substate == nullptr ? name_of(description.parent) : substate->name);
}

}  // namespace

Program::Program(ProgramSettings settings, const Creator& creator, sim::LocalTime now)
    : settings_(std::move(settings)), machine_(settings_.initial) {
  for (const NestedDescription& each : settings_.nested) {
    TAKT_CHECK(nested(each.parent) == nullptr, "at most one machine is nested in a state");
    nested_.emplace_back(each, each.parent == machine_.state());
  }
  diagnostic_.create_session_id = creator.session_id;
  diagnostic_.create_client_name = creator.client_name;
  diagnostic_.invocation_creation_time = now;
}

const NestedMachine* Program::nested(State parent) const {
  for (const NestedMachine& each : nested_)
    if (each.description().parent == parent) return &each;
  return nullptr;
}

NestedMachine* Program::nested_in(State parent) {
  for (NestedMachine& each : nested_)
    if (each.description().parent == parent) return &each;
  return nullptr;
}

void Program::set_behaviour(Method method, MethodBehaviour behaviour) {
  behaviours_[index_of(method)] = std::move(behaviour);
}

const Transition* Program::transition_of(Method method) const {
  if (method == Method::Reset && state() == State::Suspended && !settings_.reset_in_suspended) return nullptr;
  return transition_caused_by(method, state());
}

bool Program::executable(Method method) const {
  return settings_.methods.contains(method) && transition_of(method) != nullptr;
}

/// The first start after the creation is none; 4.2.10 gives no status for the limit.
bool Program::recycle_limit_reached() const {
  return was_started_ && settings_.max_recycle_count >= 0 && recycle_count_ >= settings_.max_recycle_count;
}

StatusCode Program::check(const Call& call) const {
  if (!settings_.methods.contains(call.method)) return StatusCode::BadMethodInvalid;
  if (!executable(call.method)) return StatusCode::BadNotExecutable;
  if (!call.user_permitted) return StatusCode::BadUserAccessDenied;
  const std::vector<Argument>& inputs = behaviours_[index_of(call.method)].inputs;
  if (call.arguments.size() < inputs.size()) return StatusCode::BadArgumentsMissing;
  if (call.arguments.size() > inputs.size()) return StatusCode::BadTooManyArguments;
  for (std::size_t i = 0; i < inputs.size(); ++i)
    if (!is_of_type(call.arguments[i], inputs[i].data_type)) return StatusCode::BadInvalidArgument;
  const Transition& transition = *transition_of(call.method);
  const bool restarts = transition.number == 1 || transition.number == 2;
  return restarts && recycle_limit_reached() ? StatusCode::BadInvalidState : StatusCode::Good;
}

Outcome Program::call(const Call& call, sim::LocalTime now) {
  Outcome outcome;
  const MethodBehaviour& behaviour = behaviours_[index_of(call.method)];
  const State before = state();
  outcome.status = check(call);
  if (is_good(outcome.status) && behaviour.action) outcome.status = behaviour.action(call.arguments, outcome.outputs);
  const bool good = is_good(outcome.status);
  if (!good) outcome.outputs.clear();
  diagnostic_.last_method_call = std::string(name_of(call.method));
  diagnostic_.last_method_session_id = call.session_id;
  diagnostic_.last_method_input_arguments = behaviour.inputs;
  diagnostic_.last_method_output_arguments = behaviour.outputs;
  diagnostic_.last_method_input_values = call.arguments;
  diagnostic_.last_method_output_values = outcome.outputs;
  diagnostic_.last_method_call_time = now;
  diagnostic_.last_method_return_status = outcome.status;
  if (good) take(*transition_of(call.method), now, {}, outcome);
  if (settings_.auditing) {
    AuditEvent audit = audit_of(before, now);
    audit.source_name = "Method/" + std::string(name_of(call.method));
    audit.status = good;
    audit.method_id = info(call.method).node_id;
    audit.client_user_id = call.user_id;
    audit.client_audit_entry_id = call.client_audit_entry_id;
    if (!good) audit.transition_number = 0;
    outcome.audits.push_back(std::move(audit));
  }
  return outcome;
}

Outcome Program::advance(std::uint32_t transition_number, sim::LocalTime now, std::vector<NamedValue> result) {
  Outcome outcome;
  const Transition* const transition = transition_with_number(transition_number);
  const bool restarts = transition_number == 1 && recycle_limit_reached();
  if (transition == nullptr || !transition->internal || transition->from != state() || restarts) {
    outcome.status = StatusCode::BadInvalidState;
    return outcome;
  }
  const State before = state();
  take(*transition, now, std::move(result), outcome);
  if (settings_.auditing) {
    AuditEvent audit = audit_of(before, now);
    audit.source_name = "System";
    outcome.audits.push_back(std::move(audit));
  }
  return outcome;
}

Outcome Program::go_to_substate(std::uint32_t number, sim::LocalTime now, IntermediateResult result) {
  Outcome outcome;
  NestedMachine* const machine = nested_in(state());
  const Subtransition* const transition = machine == nullptr ? nullptr : machine->go(number);
  if (transition == nullptr) {
    outcome.status = StatusCode::BadInvalidState;
    return outcome;
  }
  if (state() == State::Halted && machine->description().substates.data() == init_substates.data()) {
    if (number != 0)
      machine_.enter_init();
    else
      machine_.leave_init();
  }
  describe_nested(*machine, *transition, now, std::move(result), outcome);
  return outcome;
}

/// One time stamp for all that changes. Leaving and entering substates are transitions of their own at the same instant
/// (Annex A.2.3): out of the old substate, the base transition, into the new one.
void Program::take(const Transition& transition, sim::LocalTime now, std::vector<NamedValue> result, Outcome& outcome) {
  if (NestedMachine* const left = nested_in(transition.from); left != nullptr) {
    if (const Subtransition* const out = left->deactivate(); out != nullptr)
      describe_nested(*left, *out, now, {}, outcome);
  }
  machine_.apply(transition);
  diagnostic_.last_transition_time = now;
  if (transition.number == 2) {
    if (was_started_ && recycle_count_ < std::numeric_limits<std::int32_t>::max()) ++recycle_count_;
    was_started_ = true;
  }
  if (ends_execution(transition)) final_result_ = result;
  TransitionEvent event;
  event.source_name = settings_.name;
  event.time = now;
  event.transition_number = transition.number;
  event.transition_name = std::string(transition.name);
  event.from_number = number_of(transition.from);
  event.to_number = number_of(transition.to);
  event.from_name = std::string(name_of(transition.from));
  event.to_name = std::string(name_of(transition.to));
  event.intermediate_result = std::move(result);
  outcome.events.push_back(std::move(event));
  if (NestedMachine* const entered = nested_in(transition.to); entered != nullptr) {
    if (const Subtransition* const in = entered->activate(); in != nullptr)
      describe_nested(*entered, *in, now, {}, outcome);
  }
  outcome.deleted = settings_.auto_delete && transition.to == State::Halted && ends_execution(transition);
}

void Program::describe_nested(const NestedMachine& machine, const Subtransition& transition, sim::LocalTime now,
                              IntermediateResult result, Outcome& outcome) const {
  TransitionEvent event;
  event.source_name = settings_.name;
  event.time = now;
  event.nested = true;
  event.transition_number = transition.number;
  event.transition_name = std::string(transition.name);
  event.from_number = transition.from;
  event.to_number = transition.to;
  event.from_name = name_of_substate(machine.description(), transition.from);
  event.to_name = name_of_substate(machine.description(), transition.to);
  event.intermediate_result = std::move(result);
  outcome.events.push_back(std::move(event));
}

AuditEvent Program::audit_of(State before, sim::LocalTime now) const {
  AuditEvent audit;
  audit.action_time_stamp = now;
  audit.server_id = settings_.name;
  audit.old_state_id = info(before).node_id;
  audit.new_state_id = info(state()).node_id;
  audit.transition_number = machine_.last_transition();
  return audit;
}

}  // namespace takt::program
