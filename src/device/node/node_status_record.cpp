// SPDX-License-Identifier: Apache-2.0
#include <optional>
#include <string_view>

#include "json/record.hpp"
#include "node/node_status.hpp"
#include "sim/check.hpp"

namespace takt::node {
namespace {

using Name = std::string_view;
using OptionalName = std::optional<std::string_view>;

const wire::ProgramEndpoint* endpoint_of(const ProgramStatus& status) { return status.node->endpoint(); }
const auto& participant_of(const ProgramStatus& status) { return endpoint_of(status)->participant(); }

Name participant_name(const ProgramStatus& status, std::size_t participant) {
  const Program& program = *status.program;
  TAKT_CHECK(participant <= (program.roles.empty() ? program.slaves.size() : program.roles.size()),
             "an intent is one of the group's");
  if (participant == 0) return program.master;
  return program.roles.empty() ? program.slaves[participant - 1] : program.roles[participant - 1].name;
}

struct Peer {
  const ProgramStatus* of = nullptr;
  std::size_t number = 0;

  const PeerStatistics& seen() const { return of->peers->peers()[number]; }
  Name name() const { return participant_name(*of, participant_of(*of).participant_of(number)); }
  bool is_heard() const { return seen().state.has_value(); }
  OptionalName state() const { return is_heard() ? OptionalName(handshake::name_of(*seen().state)) : std::nullopt; }
  std::int64_t silent_ns() const { return (of->now - seen().last_heard).ps() / 1000; }
  std::uint32_t incarnation() const { return seen().incarnation; }
  const Distribution& answer() const { return seen().answer; }
  const Distribution& round_trip() const { return seen().round_trip; }
};

const json::Record& describe(json::Type<Peer>) {
  static constexpr json::Output outputs[] = {
      json::output<&Peer::name>("name", "The participant."),
      json::output<&Peer::state>("state", "Its published state; null: it was not heard yet."),
      json::only_if<&Peer::is_heard>(
          json::output<&Peer::silent_ns>("silent_ns", "Since it was heard last.", {.unit = "ns"}),
          "of one that was heard"),
      json::output<&Peer::incarnation>("incarnation", "Of its node; 0: not heard yet."),
      json::output<&Peer::answer>("answer",
                                  "From a publishing of the own state to the first message of the peer behind it, with "
                                  "the phase between the two."),
      json::output<&Peer::round_trip>("round_trip",
                                      "From publishing a new intent to the first word of the peer that holds it."),
  };
  static constexpr json::Record record{"peer", "Another participant that this one hears.", outputs};
  return record;
}

wire::EndpointCounts counts_of(const ProgramStatus& status) {
  return endpoint_of(status) == nullptr ? wire::EndpointCounts() : endpoint_of(status)->counts();
}
const Distribution& late(const ProgramStatus& status) { return status.cycles->late; }
const Distribution& cpu(const ProgramStatus& status) { return status.cycles->cpu; }
std::int64_t jitter(const ProgramStatus& status) { return late(status).greatest() - late(status).least(); }
std::uint64_t missed_cycles(const ProgramStatus& status) {
  return endpoint_of(status) == nullptr ? 0 : endpoint_of(status)->missed_cycles();
}
std::uint64_t missed_by_code(const ProgramStatus& status) { return status.cycles->missed_by_code; }
std::uint64_t missed_by_system(const ProgramStatus& status) { return status.cycles->missed_by_system; }
std::uint64_t taken(const ProgramStatus& status) { return counts_of(status).taken; }
std::uint64_t foreign(const ProgramStatus& status) { return counts_of(status).foreign; }
std::uint64_t unsubscribed(const ProgramStatus& status) { return counts_of(status).unsubscribed; }
std::uint64_t stale(const ProgramStatus& status) { return counts_of(status).stale; }
std::uint64_t not_running(const ProgramStatus& status) { return counts_of(status).not_running; }

const json::Record& statistics() {
  static constexpr json::Output outputs[] = {
      json::output<&late>("late", "Waking up for a cycle, against its instant."),
      json::output<&cpu>("cpu", "CPU time of the thread from publishing to publishing."),
      json::output<&jitter>("jitter_ns", "The greatest lateness less the least.", {.unit = "ns"}),
      json::output<&missed_cycles>("missed_cycles", "Cycles in which nothing was published."),
      json::output<&missed_by_code>("missed_by_code", "Of them: the thread itself used its CPU for so long."),
      json::output<&missed_by_system>("missed_by_system", "Of them: the operating system did not let it run."),
      json::output<&taken>("taken", "Messages of the group that were taken."),
      json::output<&foreign>("foreign", "Messages that are none of the group's."),
      json::output<&unsubscribed>("unsubscribed", "Messages of participants that this one does not hear."),
      json::output<&stale>("stale", "Messages that were overtaken, or came twice."),
      json::output<&not_running>("not_running",
                                 "Process data of another run, or while this participant was not Running."),
      json::output<&ProgramStatus::send_failures>("send_failures", "Messages that the node's socket refused."),
  };
  static constexpr json::Record record{"statistics", "What the node has measured since it began.", outputs};
  return record;
}

struct RoleStatus {
  const ProgramStatus* of = nullptr;
  std::size_t number = 0;

  const handshake::Binding& binding() const { return of->node->binder()->binding(number); }
  Name name() const { return of->program->roles[number].name; }
  Name skill() const { return of->program->roles[number].skill; }
  bool is_bound() const { return binding().bound(); }
  OptionalName node() const {
    return is_bound() ? OptionalName(of->program->candidates[binding().candidate]) : std::nullopt;
  }
  std::uint32_t life() const { return binding().life; }
};

const json::Record& describe(json::Type<RoleStatus>) {
  static constexpr json::Output outputs[] = {
      json::output<&RoleStatus::name>("name", "The role."),
      json::output<&RoleStatus::skill>("skill", "What it asks of its node."),
      json::output<&RoleStatus::node>("node", "Who has it; null: nobody."),
      json::only_if<&RoleStatus::is_bound>(json::output<&RoleStatus::life>("life", "Of its node."),
                                           "of a role that somebody has"),
  };
  static constexpr json::Record record{"role", "A role of the group, as its master binds it.", outputs};
  return record;
}

struct CandidateStatus {
  const ProgramStatus* of = nullptr;
  std::uint8_t number = 0;

  Name name() const { return of->program->candidates[number]; }
  bool is_present() const { return of->node->binder()->present(number); }
  OptionalName role() const {
    const handshake::Binder& binder = *of->node->binder();
    for (std::size_t r = binder.roles(); r-- > 0;)
      if (binder.binding(r).bound() && binder.binding(r).candidate == number) return of->program->roles[r].name;
    return std::nullopt;
  }
};

const json::Record& describe(json::Type<CandidateStatus>) {
  static constexpr json::Output outputs[] = {
      json::output<&CandidateStatus::name>("name", "The node."),
      json::output<&CandidateStatus::is_present>("present", "It announces itself."),
      json::output<&CandidateStatus::role>("role", "What it has; null: nothing."),
  };
  static constexpr json::Record record{"candidate", "A node that may have a role.", outputs};
  return record;
}

struct IntentStatus {
  const ProgramStatus* of = nullptr;

  const handshake::Intent& intent() const { return participant_of(*of).intent(); }
  std::uint32_t number() const { return intent().number; }
  Name kind() const { return handshake::name_of(intent().kind); }
  Name origin() const { return participant_name(*of, intent().origin); }
};

const json::Record& describe(json::Type<IntentStatus>) {
  static constexpr json::Output outputs[] = {
      json::output<&IntentStatus::number>("number", "0: none yet."),
      json::output<&IntentStatus::kind>("kind", "What the group is asked for."),
      json::output<&IntentStatus::origin>("origin", "The participant that asked."),
  };
  static constexpr json::Record record{"intent", "The last intent of the group that this participant knows.", outputs};
  return record;
}

// The Program of a node.
bool is_master(const ProgramStatus& status) {
  return endpoint_of(status) != nullptr && participant_of(status).config().role == handshake::Role::master;
}
bool has_endpoint(const ProgramStatus& status) { return endpoint_of(status) != nullptr; }
bool is_robust(const ProgramStatus& status) { return status.program->variant == Variant::robust; }
bool has_intents(const ProgramStatus& status) { return has_endpoint(status) && is_robust(status); }
bool has_binder(const ProgramStatus& status) { return status.node->binder() != nullptr; }
bool is_candidate(const ProgramStatus& status) { return status.node->candidate() != nullptr; }
const handshake::Candidate& candidate_of(const ProgramStatus& status) { return *status.node->candidate(); }
const std::string& program_of(const ProgramStatus& status) { return status.program->name; }
Name variant_of(const ProgramStatus& status) { return is_robust(status) ? "robust" : "paper"; }
Name role_of(const ProgramStatus& status) {
  return is_master(status) ? "master" : is_candidate(status) ? "candidate" : "slave";
}
std::vector<RoleStatus> roles_of(const ProgramStatus& status) {
  std::vector<RoleStatus> all;
  for (std::size_t r = 0; r < status.node->binder()->roles(); ++r) all.push_back({&status, r});
  return all;
}
std::vector<CandidateStatus> candidates_of(const ProgramStatus& status) {
  std::vector<CandidateStatus> all;
  for (std::uint8_t c = 0; c < status.node->binder()->candidates(); ++c) all.push_back({&status, c});
  return all;
}
bool is_complete(const ProgramStatus& status) { return status.node->binder()->complete(); }
OptionalName bound_to(const ProgramStatus& status) {
  const auto role = candidate_of(status).role();
  return role ? OptionalName(status.program->roles[*role].name) : std::nullopt;
}
bool announces(const ProgramStatus& status) { return candidate_of(status).announces(); }
bool is_leaving(const ProgramStatus& status) { return candidate_of(status).announcement().leaving; }
std::uint32_t life_of(const ProgramStatus& status) { return candidate_of(status).announcement().life; }
Name state_of(const ProgramStatus& status) { return handshake::name_of(status.node->state()); }
std::uint32_t incarnation_of(const ProgramStatus& status) { return participant_of(status).config().incarnation; }
IntentStatus intent_of(const ProgramStatus& status) { return {&status}; }
auto run_of(const ProgramStatus& status) { return participant_of(status).run(); }
std::vector<Peer> peers_of(const ProgramStatus& status) {
  std::vector<Peer> all;
  for (std::size_t p = 0; has_endpoint(status) && p < status.peers->peers().size(); ++p) all.push_back({&status, p});
  return all;
}

bool is_secured(const NodeStatus& status) { return status.security.has_value(); }
const SecurityStatus& security_of(const NodeStatus& status) { return *status.security; }
struct TwinStatus {
  std::uint64_t publisher_id = 0;
  std::vector<std::string> addresses;
};

const json::Record& describe(json::Type<TwinStatus>) {
  static constexpr json::Output outputs[] = {
      json::output<&TwinStatus::publisher_id>("publisher_id", "What both say."),
      json::output<&TwinStatus::addresses>("addresses", "Where their messages come from."),
  };
  static constexpr json::Record record{"twins", "Two nodes that send under one name.", outputs};
  return record;
}

std::vector<TwinStatus> twins_of(const NodeStatus& status) {
  std::vector<TwinStatus> all;
  for (const SourceTable::Twins& each : status.twins)
    all.push_back({each.publisher_id, {to_text(each.one), to_text(each.other)}});
  return all;
}

bool has_interface(const NodeStatus& status) { return status.interface.has_value(); }
const InterfaceStatus& interface_of(const NodeStatus& status) { return *status.interface; }
bool is_server(const NodeStatus& status) { return status.server.has_value(); }
const ServerState& server_of(const NodeStatus& status) { return *status.server; }

bool is_alone(const NodeStatus& status) { return status.programs.size() == 1; }
bool has_several(const NodeStatus& status) { return !is_alone(status); }
const ProgramStatus& only_program(const NodeStatus& status) { return status.programs.front(); }

}  // namespace

const json::Record& describe(json::Type<ProgramStatus>) {
  static constexpr json::Output outputs[] = {
      json::output<&program_of>("program", "Its name."),
      json::output<&variant_of>("variant", "Of the handshake: robust or paper."),
      json::output<&role_of>("role", "What this node is in it: master, slave or candidate."),
      json::only_if<&has_binder>(json::output<&roles_of>("roles", "Which node has which role."),
                                 "at a master of roles"),
      json::only_if<&has_binder>(json::output<&candidates_of>("candidates", "Who may have one."),
                                 "at a master of roles"),
      json::only_if<&has_binder>(json::output<&is_complete>("complete", "Each role has a node."),
                                 "at a master of roles"),
      json::only_if<&is_candidate>(json::output<&bound_to>("bound_to", "The role that this node has; null: none."),
                                   "at a candidate"),
      json::only_if<&is_candidate>(json::output<&announces>("announces", "It tells the master what it offers."),
                                   "at a candidate"),
      json::only_if<&is_candidate>(json::output<&is_leaving>("leaving", "It asks to be let go."), "at a candidate"),
      json::only_if<&is_candidate>(json::output<&life_of>("life", "One more with each new beginning."),
                                   "at a candidate"),
      json::output<&state_of>("state", "The published state; of a candidate without a role Halted."),
      json::only_if<&has_endpoint>(
          json::output<&incarnation_of>("incarnation", "One more with each start of the node."), "at a participant"),
      json::only_if<&has_intents>(json::output<&intent_of>("intent", "The last one that it knows."),
                                  "at a participant with the robust handshake"),
      json::only_if<&has_intents>(json::output<&run_of>("run", "The number of the run."),
                                  "at a participant with the robust handshake"),
      json::output<&peers_of>("peers", "Those that it hears."),
      json::part<ProgramStatus, &statistics>("statistics", "What it has measured."),
  };
  static constexpr json::Record record{"program_status", "A Program of the node.", outputs};
  return record;
}

const json::Record& describe(json::Type<InterfaceStatus>) {
  static constexpr json::Output outputs[] = {
      json::output<&InterfaceStatus::name>("name", "Its name."),
      json::output<&InterfaceStatus::is_there>("there", "False: it is gone, or cannot be bound to."),
      json::output<&InterfaceStatus::bound_again>("bound_again",
                                                  "How often it was made anew, and the node has bound to it again."),
  };
  static constexpr json::Record record{"interface_status", "The interface of the node's transport.", outputs};
  return record;
}

const json::Record& describe(json::Type<NodeStatus>) {
  static constexpr json::Output outputs[] = {
      json::output<&NodeStatus::time_ns>("time_ns", "When this was said, on the node's clock.", {.unit = "ns"}),
      json::output<&NodeStatus::node>("node", "Its name."),
      json::only_if<&is_alone>(json::spread<&only_program>(), "of a node with one Program"),
      json::only_if<&has_several>(json::output<&NodeStatus::programs>("programs", "Each of them."),
                                  "of a node with several Programs"),
      json::output<&NodeStatus::sources>(
          "sources", "Whom it hears, and what is refused of them; 64 senders at most, and the others together."),
      json::only_if<&has_interface>(json::output<&interface_of>("interface", "The one that it is bound to."),
                                    "of a node whose transport names one"),
      json::output<&twins_of>("twins",
                              "PublisherIds that messages come under from two addresses, within the last ten seconds."),
      json::only_if<&is_secured>(json::output<&security_of>("security", "Its secured messages."),
                                 "of a node with secured messages"),
      json::only_if<&is_server>(json::output<&server_of>("server", "Its OPC UA server."),
                                "of a node with a server that has begun"),
      json::output<&NodeStatus::log_lines_left_out>(
          "log_lines_left_out", "Lines of its log that were left out: too many at once, or nobody reads them."),
  };
  static constexpr json::Record record{"node_status", "What a node says of itself.", outputs};
  return record;
}

std::string to_json(const NodeStatus& status) { return json::compact(json::ShapeOf<NodeStatus>::write(status)); }

}  // namespace takt::node
