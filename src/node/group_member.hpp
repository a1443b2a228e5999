// What a node is in one of its Programs: a participant, the master of roles, or a candidate for them. The values of src/wire behind one
// door; their alarms have the numbers of an endpoint's, and more behind them.
#pragma once

#include <variant>

#include "node/config.hpp"
#include "wire/plug_endpoint.hpp"

namespace takt::node {

class GroupMember {
 public:
  /// `endpoint` is that of `loaded` on this machine, with its incarnation, which makes the first life of a candidate, too.
  GroupMember(const Config& config, const LoadedProgram& loaded, wire::EndpointSettings endpoint);

  void start(wire::PlugHost& host);
  program::StatusCode call(wire::PlugHost& host, program::Method method);
  void finished(wire::PlugHost& host);
  void receive(wire::PlugHost& host, uadp::Octets network_message);
  void wake(wire::PlugHost& host, std::size_t alarm);
  std::size_t alarm_count() const;

  /// Its participant; null at a candidate without a role.
  const wire::ProgramEndpoint* endpoint() const;
  /// At a participant of a Program without roles, for nesting.
  wire::ProgramEndpoint& plain() { return std::get<wire::ProgramEndpoint>(part_); }
  /// Null if it is something else.
  const wire::PlugMaster* master() const { return std::get_if<wire::PlugMaster>(&part_); }
  const wire::CandidateEndpoint* candidate() const { return std::get_if<wire::CandidateEndpoint>(&part_); }
  wire::CandidateEndpoint* candidate() { return std::get_if<wire::CandidateEndpoint>(&part_); }

  /// A candidate without a role is Halted.
  handshake::PublishedState state() const;
  /// Peers that it has, or will have with a role.
  std::size_t peer_count() const { return peer_count_; }

 private:
  using Part = std::variant<wire::ProgramEndpoint, wire::PlugMaster, wire::CandidateEndpoint>;
  static Part make(const Config& config, const LoadedProgram& loaded, wire::EndpointSettings endpoint);

  Part part_;
  std::size_t peer_count_;
};

}  // namespace takt::node
