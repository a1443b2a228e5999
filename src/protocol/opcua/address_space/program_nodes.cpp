// SPDX-License-Identifier: Apache-2.0
#include "opcua/address_space/program_nodes.hpp"

#include <algorithm>

#include "program/table.hpp"

namespace takt::opcua {
namespace {

using handshake::PublishedState;

const NodeId programs_folder(own_namespace, "Programs");
const NodeId transition_event(own_namespace, "ProgramTransitionEvent");
const NodeId audit_event(own_namespace, "AuditProgramTransitionEvent");

std::uint32_t state_id(PublishedState state) { return program::info(handshake::base_state(state)).node_id; }
std::string_view state_name(PublishedState state) { return program::name_of(handshake::base_state(state)); }
std::uint32_t state_number(PublishedState state) { return program::number_of(handshake::base_state(state)); }

bool is_ended_by(std::uint32_t transition) {
  return transition == 3 || transition == 4 || transition == 7 || transition == 8 || transition == 9;
}

/// Fields of a state variable of an event (OPC 10000-16, 4.4.9).
void put_state(Event& event, const std::string& name, PublishedState state) {
  event.fields[name] = Variant(LocalizedText(state_name(state)));
  event.fields[name + "/Id"] = Variant(NodeId(state_id(state)));
  event.fields[name + "/Name"] = Variant(QualifiedName{0, Text(state_name(state))});
  event.fields[name + "/Number"] = Variant(state_number(state));
  event.fields[name + "/EffectiveDisplayName"] = Variant(LocalizedText(handshake::name_of(state)));
}

}  // namespace

std::string cause_text(handshake::Alarm alarm) {
  switch (alarm) {
    case handshake::Alarm::none:
      return "";
    case handshake::Alarm::peer_silent:
      return "a peer is silent";
    case handshake::Alarm::peer_restarted:
      return "a peer was restarted";
    case handshake::Alarm::peer_left:
      return "a peer has left";
    case handshake::Alarm::mismatch:
      return "a peer speaks of something that cannot be followed";
    case handshake::Alarm::other_group:
      return "the nested group did the same";
  }
  return "";
}

void add_program_types(AddressSpace& space) {
  space.add_below(NodeId(ids::objects_folder), ids::organizes,
                  make_node(programs_folder, NodeClass::Object, own_namespace, "Programs"), ids::folder_type);
  space.add_below(NodeId(ids::program_transition_event_type), ids::has_subtype,
                  make_node(transition_event, NodeClass::ObjectType, own_namespace, "ProgramTransitionEvent"), 0);
  space.add_below(NodeId(ids::audit_program_transition_event_type), ids::has_subtype,
                  make_node(audit_event, NodeClass::ObjectType, own_namespace, "AuditProgramTransitionEvent"), 0);
}

ProgramNodes::ProgramNodes(AddressSpace& space, const ProgramDescription& description, DateTime now)
    : space_(space),
      name_(description.name),
      id_(own_namespace, description.name),
      peers_(description.peers),
      peer_states_(description.peers.size()) {
  Node object = make_node(id_, NodeClass::Object, own_namespace, name_);
  object.event_notifier = 1;
  space_.add_below(programs_folder, ids::organizes, std::move(object), ids::program_state_machine_type);
  space_.refer(NodeId(ids::server), ids::has_notifier, id_);
  add_states(now);
  add_methods();
  add_diagnostic(now);
  add_group(description);
}

void ProgramNodes::add_variable(std::string_view path, std::uint16_t name_space, std::uint32_t reference,
                                std::uint32_t data_type, Variant value, std::uint32_t type, std::int32_t rank) {
  const std::size_t dot = path.rfind('.');
  Node node =
      make_node(child(path), NodeClass::Variable, name_space, path.substr(dot == std::string_view::npos ? 0 : dot + 1));
  node.data_type = NodeId(data_type);
  node.value_rank = rank;
  node.value.value = std::move(value);
  space_.add_below(dot == std::string_view::npos ? id_ : child(path.substr(0, dot)), reference, std::move(node), type);
}

void ProgramNodes::add_states(DateTime now) {
  const auto property = [&](std::string_view path, std::uint32_t data_type, Variant value) {
    add_variable(path, 0, ids::has_property, data_type, std::move(value), ids::property_type);
  };
  add_variable("CurrentState", 0, ids::has_component, ids::localized_text, Variant(LocalizedText()),
               ids::finite_state_variable_type);
  property("CurrentState.Id", ids::node_id, Variant(NodeId()));
  property("CurrentState.Number", ids::uint32, Variant(std::uint32_t{0}));
  property("CurrentState.EffectiveDisplayName", ids::localized_text, Variant(LocalizedText()));
  set_state(state_, now);
  add_variable("LastTransition", 0, ids::has_component, ids::localized_text, Variant(LocalizedText()),
               ids::finite_transition_variable_type);
  property("LastTransition.Id", ids::node_id, Variant(NodeId()));
  property("LastTransition.Number", ids::uint32, Variant(std::uint32_t{0}));
  property("LastTransition.TransitionTime", ids::utc_time, Variant(DateTime()));
  property("Deletable", ids::boolean, Variant(false));
  property("AutoDelete", ids::boolean, Variant(false));
  property("RecycleCount", ids::int32, Variant(std::int32_t{0}));
  space_.add_below(id_, ids::has_component,
                   make_node(child("FinalResultData"), NodeClass::Object, 0, "FinalResultData"), ids::base_object_type);
  add_variable("FinalResultData.Cause", own_namespace, ids::has_component, ids::string, Variant(Text()),
               ids::base_data_variable_type);
  add_variable("FinalResultData.Time", own_namespace, ids::has_component, ids::utc_time, Variant(DateTime()),
               ids::base_data_variable_type);
}

void ProgramNodes::add_methods() {
  for (const program::MethodInfo& each : program::methods)
    space_.add_below(id_, ids::has_component, make_node(child(each.name), NodeClass::Method, 0, each.name), 0);
}

std::optional<program::Method> ProgramNodes::method(const NodeId& id) const {
  for (const program::MethodInfo& each : program::methods)
    if (id == NodeId(each.node_id) || id == child(each.name)) return each.method;
  return std::nullopt;
}

void ProgramNodes::add_diagnostic(DateTime now) {
  diagnostic_.create_client_name = Text("takt node");
  diagnostic_.invocation_creation_time = now;
  add_variable("ProgramDiagnostic", 0, ids::has_component, ids::program_diagnostic_2, Variant(),
               ids::program_diagnostic_2_type);
  const auto member = [&](std::string_view name, std::uint32_t data_type, std::int32_t rank = -1) {
    add_variable("ProgramDiagnostic." + std::string(name), 0,
                 name == "LastTransitionTime" ? ids::has_property : ids::has_component, data_type, Variant(),
                 name == "LastTransitionTime" ? ids::property_type : ids::base_data_variable_type, rank);
  };
  member("CreateSessionId", ids::node_id);
  member("CreateClientName", ids::string);
  member("InvocationCreationTime", ids::utc_time);
  member("LastTransitionTime", ids::utc_time);
  member("LastMethodCall", ids::string);
  member("LastMethodSessionId", ids::node_id);
  member("LastMethodInputArguments", ids::argument, 1);
  member("LastMethodOutputArguments", ids::argument, 1);
  member("LastMethodInputValues", ids::base_data_type, 1);
  member("LastMethodOutputValues", ids::base_data_type, 1);
  member("LastMethodCallTime", ids::utc_time);
  member("LastMethodReturnStatus", ids::status_code);
  set_diagnostic(now);
}

void ProgramNodes::set_diagnostic(DateTime time) {
  set("ProgramDiagnostic", Variant(extension_of(diagnostic_)), time);
  set("ProgramDiagnostic.CreateSessionId", Variant(diagnostic_.create_session_id), time);
  set("ProgramDiagnostic.CreateClientName", Variant(diagnostic_.create_client_name), time);
  set("ProgramDiagnostic.InvocationCreationTime", Variant(diagnostic_.invocation_creation_time), time);
  set("ProgramDiagnostic.LastTransitionTime", Variant(diagnostic_.last_transition_time), time);
  set("ProgramDiagnostic.LastMethodCall", Variant(diagnostic_.last_method_call), time);
  set("ProgramDiagnostic.LastMethodSessionId", Variant(diagnostic_.last_method_session_id), time);
  for (const char* const arguments :
       {"ProgramDiagnostic.LastMethodInputArguments", "ProgramDiagnostic.LastMethodOutputArguments"})
    set(arguments, Variant::array(std::vector<ExtensionObject>()), time);
  for (const char* const values :
       {"ProgramDiagnostic.LastMethodInputValues", "ProgramDiagnostic.LastMethodOutputValues"})
    set(values, Variant::array(std::vector<Boxed<Variant>>()), time);
  set("ProgramDiagnostic.LastMethodCallTime", Variant(diagnostic_.last_method_call_time), time);
  set("ProgramDiagnostic.LastMethodReturnStatus", Variant(diagnostic_.last_method_return_status), time);
}

void ProgramNodes::add_group(const ProgramDescription& description) {
  space_.add_below(id_, ids::has_component, make_node(child("Group"), NodeClass::Object, own_namespace, "Group"),
                   ids::base_object_type);
  const auto variable = [&](const std::string& name, std::uint32_t data_type, Variant value, std::int32_t rank = -1) {
    add_variable("Group." + name, own_namespace, ids::has_component, data_type, std::move(value),
                 ids::base_data_variable_type, rank);
  };
  std::vector<Text> participants(description.participants.begin(), description.participants.end());
  variable("Node", ids::string, Variant(Text(description.own)));
  variable("Role", ids::string, Variant(Text(description.role)));
  variable("Master", ids::string, Variant(Text(description.master)));
  variable("Participants", ids::string, Variant::array(participants), 1);
  variable("Handshake", ids::string, Variant(Text(description.handshake)));
  variable("Cycle", ids::duration, Variant(description.cycle_ms));
  variable("LastReaction", ids::duration, Variant(0.0));
  variable("LastAlarm", ids::string, Variant(Text()));
  space_.add_below(child("Group"), ids::organizes,
                   make_node(child("Group.Heard"), NodeClass::Object, own_namespace, "Heard"), ids::folder_type);
  for (const std::string& peer : peers_) {
    Node node = make_node(child("Group.Heard." + peer), NodeClass::Variable, own_namespace, peer);
    node.data_type = NodeId(ids::string);
    node.value.value = Variant(Text());
    space_.add_below(child("Group.Heard"), ids::has_component, std::move(node), ids::base_data_variable_type);
  }
}

void ProgramNodes::set_state(PublishedState state, DateTime time) {
  state_ = state;
  set("CurrentState", Variant(LocalizedText(state_name(state))), time);
  set("CurrentState.Id", Variant(NodeId(state_id(state))), time);
  set("CurrentState.Number", Variant(state_number(state)), time);
  set("CurrentState.EffectiveDisplayName", Variant(LocalizedText(handshake::name_of(state))), time);
}

std::vector<Event> ProgramNodes::take(const ProgramNews& news) {
  std::vector<Event> events;
  switch (news.kind) {
    case ProgramNews::Kind::transition:
      events = transition(news);
      break;
    case ProgramNews::Kind::intent:
      reaction_ = std::pair(handshake::goal_of(news.intent), news.time);
      if (news.alarm != handshake::Alarm::none)
        set("Group.LastAlarm", Variant(Text(cause_text(news.alarm))), news.time);
      break;
    case ProgramNews::Kind::peer:
      if (news.peer < peers_.size()) {
        peer_states_[news.peer] = news.peer_state;
        set("Group.Heard." + peers_[news.peer], Variant(Text(handshake::name_of(news.peer_state))), news.time);
      }
      break;
    case ProgramNews::Kind::methods:
      break;
  }
  watch_reaction(news.time);
  for (const program::MethodInfo& each : program::methods)
    space_.set_executable(child(each.name), news.executable.contains(each.method));
  return events;
}

/// From the intent until this node and all that it hears are where the intent leads.
void ProgramNodes::watch_reaction(DateTime time) {
  if (!reaction_ || state_ != reaction_->first) return;
  if (!std::all_of(peer_states_.begin(), peer_states_.end(),
                   [&](const auto& state) { return state == reaction_->first; }))
    return;
  set("Group.LastReaction", Variant(static_cast<double>(time.ticks - reaction_->second.ticks) / 1e4), time);
  reaction_.reset();
}

Event ProgramNodes::base_event(NodeId type, std::string_view source_name, DateTime time, std::uint16_t severity,
                               const std::string& message) {
  Event event;
  event.type = std::move(type);
  event.source = id_;
  event.fields["EventType"] = Variant(event.type);
  event.fields["SourceNode"] = Variant(id_);
  event.fields["SourceName"] = Variant(Text(source_name));
  event.fields["Time"] = Variant(time);
  event.fields["ReceiveTime"] = Variant(time);
  event.fields["Message"] = Variant(LocalizedText(message));
  event.fields["Severity"] = Variant(severity);
  return event;
}

std::vector<Event> ProgramNodes::transition(const ProgramNews& news) {
  const handshake::StateChange& change = news.change;
  set_state(change.to, news.time);
  const program::Transition* const taken = program::transition_with_number(change.transition);
  if (taken == nullptr) return {};  // only the substate, for which there is no transition of this machine
  set("LastTransition", Variant(LocalizedText(taken->name)), news.time);
  set("LastTransition.Id", Variant(NodeId(taken->node_id)), news.time);
  set("LastTransition.Number", Variant(std::uint32_t{taken->number}), news.time);
  set("LastTransition.TransitionTime", Variant(news.time), news.time);
  diagnostic_.last_transition_time = news.time;
  set_diagnostic(news.time);
  if (taken->number == 2) {
    recycles_ += was_running_ ? 1 : 0;
    was_running_ = true;
    set("RecycleCount", Variant(recycles_), news.time);
  }
  const std::string cause =
      news.by_call ? "called " + std::string(program::name_of(news.method)) : cause_text(news.alarm);
  if (is_ended_by(taken->number)) {
    set("FinalResultData.Cause", Variant(Text(cause.empty() ? "the group" : cause)), news.time);
    set("FinalResultData.Time", Variant(news.time), news.time);
  }
  const std::string message = name_ + ": " + std::string(state_name(change.from)) + " to " +
                              std::string(state_name(change.to)) + (cause.empty() ? "" : ", " + cause);
  Event event =
      base_event(transition_event, name_, news.time, news.alarm == handshake::Alarm::none ? 100 : 500, message);
  event.fields["Transition"] = Variant(LocalizedText(taken->name));
  event.fields["Transition/Id"] = Variant(NodeId(taken->node_id));
  event.fields["Transition/Name"] = Variant(QualifiedName{0, Text(taken->name)});
  event.fields["Transition/Number"] = Variant(std::uint32_t{taken->number});
  event.fields["Transition/EffectiveDisplayName"] = Variant(LocalizedText(taken->name));
  event.fields["Transition/TransitionTime"] = Variant(news.time);
  put_state(event, "FromState", change.from);
  put_state(event, "ToState", change.to);
  event.fields["IntermediateResult"] = Variant();
  event.fields["1:Cause"] = Variant(Text(cause));
  const CallRecord* const call =
      news.by_call && last_call_ && last_call_->method == news.method ? &*last_call_ : nullptr;
  return {std::move(event),
          audit(call, news.by_call, state_id(change.from), state_id(change.to), taken->number, news.time)};
}

Event ProgramNodes::audit(const CallRecord* call, bool caused, std::uint32_t old_state, std::uint32_t new_state,
                          std::uint32_t transition_number, DateTime time) {
  const std::string source = call != nullptr ? "Method/" + std::string(program::name_of(call->method)) : "System";
  Event event = base_event(audit_event, source, time, 100, name_ + ": " + source);
  event.is_audit = true;
  event.fields["ActionTimeStamp"] = Variant(time);
  event.fields["Status"] = Variant(caused && transition_number != 0);
  event.fields["ServerId"] = Variant(Text(name_));
  event.fields["ClientAuditEntryId"] = Variant(call != nullptr ? call->audit_entry_id : Text());
  event.fields["ClientUserId"] = Variant(call != nullptr ? call->user : Text());
  event.fields["MethodId"] = Variant(call != nullptr ? NodeId(program::info(call->method).node_id) : NodeId());
  event.fields["InputArguments"] = Variant::array(std::vector<Boxed<Variant>>());
  event.fields["OldStateId"] = Variant(NodeId(old_state));
  event.fields["NewStateId"] = Variant(NodeId(new_state));
  event.fields["TransitionNumber"] = Variant(transition_number);
  return event;
}

std::uint32_t ProgramNodes::state_id_now() const { return state_id(state_); }

std::vector<Event> ProgramNodes::called(const CallRecord& call) {
  diagnostic_.last_method_call = Text(program::name_of(call.method));
  diagnostic_.last_method_session_id = call.session;
  diagnostic_.last_method_call_time = call.time;
  diagnostic_.last_method_return_status = call.status;
  set_diagnostic(call.time);
  if (is_good(call.status)) return {};
  return {refused(call)};
}

}  // namespace takt::opcua
