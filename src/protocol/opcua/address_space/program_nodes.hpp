// SPDX-License-Identifier: Apache-2.0
// One Program of the node as an instance of ProgramStateMachineType (OPC 10000-10, 5.2): its nodes, what they say after
// each piece of news, and its events.
#pragma once

#include "opcua/address_space/address_space.hpp"
#include "opcua/address_space/event.hpp"
#include "opcua/address_space/program_news.hpp"
#include "sim/time.hpp"

namespace takt::opcua {

/// Index 1: nodes of this server.
inline constexpr std::uint16_t own_namespace = 1;

/// A call of one of a Program's methods, for its diagnostics and audit events.
struct CallRecord {
  program::Method method = program::Method::Halt;
  NodeId session;
  Text user;
  Text audit_entry_id;
  DateTime time;
  StatusCode status = StatusCode::Good;
};

/// The folder below which Programs are, and the types of their events; once.
void add_program_types(AddressSpace& space);

class ProgramNodes {
 public:
  /// `space` outlives it. The folder is there.
  ProgramNodes(AddressSpace& space, const ProgramDescription& description, DateTime now);

  const NodeId& id() const { return id_; }
  const std::string& name() const { return name_; }
  /// The method that a client means: that of the instance, or that of the type.
  std::optional<program::Method> method(const NodeId& id) const;

  /// Sets values, and gives the events that tell of it, in order.
  std::vector<Event> take(const ProgramNews& news);
  /// A call is on its way to the Program: its transition may come before its answer.
  void calling(const CallRecord& call) { last_call_ = call; }
  /// A call has been answered. An event if it was refused: those that were not come with their transition.
  std::vector<Event> called(const CallRecord& call);
  /// The event of a call that was refused before it came to the Program.
  Event refused(const CallRecord& call) { return audit(&call, false, state_id_now(), state_id_now(), 0, call.time); }

 private:
  NodeId child(std::string_view path) const { return NodeId(own_namespace, name_ + "." + std::string(path)); }
  void add_variable(std::string_view path, std::uint16_t name_space, std::uint32_t reference, std::uint32_t data_type,
                    Variant value, std::uint32_t type, std::int32_t rank = -1);
  void add_states(DateTime now);
  void add_methods();
  void add_diagnostic(DateTime now);
  void add_group(const ProgramDescription& description);
  void set(std::string_view path, Variant value, DateTime time) {
    space_.set_value(child(path), std::move(value), time);
  }
  void set_state(handshake::PublishedState state, DateTime time);
  std::uint32_t state_id_now() const;
  void set_diagnostic(DateTime time);
  void watch_reaction(DateTime time);
  Event base_event(NodeId type, std::string_view source_name, DateTime time, std::uint16_t severity,
                   const std::string& message);
  std::vector<Event> transition(const ProgramNews& news);
  Event audit(const CallRecord* call, bool caused, std::uint32_t old_state, std::uint32_t new_state,
              std::uint32_t transition_number, DateTime time);

  AddressSpace& space_;
  std::string name_;
  NodeId id_;
  std::vector<std::string> peers_;
  handshake::PublishedState state_ = handshake::PublishedState::Halted;
  std::vector<std::optional<handshake::PublishedState>> peer_states_;
  ProgramDiagnostic2DataType diagnostic_;
  std::optional<CallRecord> last_call_;
  std::int32_t recycles_ = 0;
  bool was_running_ = false;
  std::optional<std::pair<handshake::PublishedState, DateTime>> reaction_;  ///< where the group goes, and since when
};

}  // namespace takt::opcua
