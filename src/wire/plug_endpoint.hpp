// Plug and produce on a network, sans-IO: the master that binds its roles, and a node that offers its skills.
//
// Both put a ProgramEndpoint on the network: the master always, a candidate while it has a role.
#pragma once

#include <optional>
#include <vector>

#include "wire/plug_format.hpp"
#include "wire/program_endpoint.hpp"

namespace takt::wire {

/// What they tell the machine they are on, besides what an endpoint tells it.
class PlugHost : public EndpointHost {
 public:
  /// At the master: a role has another node, or none.
  virtual void role_bound(std::size_t role, const handshake::Binding& binding) = 0;
  /// At a candidate: it has this role now, or has been let go. `self` is the life that the role was bound to.
  virtual void role_taken(std::size_t role, const handshake::Binding& self) = 0;
  virtual void role_dropped(std::size_t role, const handshake::Binding& self) = 0;
};

struct PlugSettings {
  /// Of the participant; a candidate's index and incarnation are set when it gets a role.
  EndpointSettings endpoint;
  std::shared_ptr<const PlugFormat> format;
  sim::Duration announce_cycle;    ///< above 0; of announcements and of the table
  sim::Duration announce_timeout;  ///< after that a node that has announced nothing is gone
};

/// How many announcements in a row may be missed.
inline constexpr std::int64_t announcements_missed = 3;
/// How many cycles there are from one announcement to the next, if nobody says otherwise.
inline constexpr std::int64_t cycles_of_announcement = 10;

/// `endpoint` is that of the master, or of a candidate but for index and incarnation.
PlugSettings plug_settings(EndpointSettings endpoint, std::shared_ptr<const PlugFormat> format, sim::Duration announce_cycle);

/// The master of a group with roles.
class PlugMaster {
 public:
  PlugMaster(PlugSettings settings, bool restarts);

  void start(PlugHost& host);
  void forget(std::uint32_t incarnation);
  /// A Start while a role has no node is refused with BadResourceUnavailable.
  program::StatusCode call(PlugHost& host, program::Method method);
  void finished(PlugHost& host);
  void receive(PlugHost& host, uadp::Octets network_message);
  void wake(PlugHost& host, std::size_t alarm);
  std::size_t alarm_count() const { return table_alarm() + 1 + settings_.format->candidates(); }

  const ProgramEndpoint& endpoint() const { return endpoint_; }
  const handshake::Binder& binder() const { return binder_; }

 private:
  std::size_t table_alarm() const { return endpoint_.alarm_count(); }
  handshake::Binder new_binder() const;
  void settle(PlugHost& host);
  void publish_table(PlugHost& host);

  PlugSettings settings_;
  bool restarts_;
  ProgramEndpoint endpoint_;
  handshake::Binder binder_;
  std::vector<Arrivals> announcements_;  ///< by candidate
  std::uint16_t table_sequence_ = 0;
  std::array<std::byte, 1500> buffer_;
};

/// A node that may have a role.
class CandidateEndpoint {
 public:
  /// `life`: the first one, never 0; a node that starts again begins with one that it never had.
  CandidateEndpoint(PlugSettings settings, std::uint8_t number, std::uint32_t life, std::vector<handshake::SkillId> skills, bool joins_at_start);

  void start(PlugHost& host);
  /// A crash; it comes back with `start`, announcing itself if it did before.
  void forget(std::uint32_t life);
  void join(PlugHost& host);
  void leave(PlugHost& host);
  /// BadInvalidState without a role.
  program::StatusCode call(PlugHost& host, program::Method method);
  void finished(PlugHost& host);
  void receive(PlugHost& host, uadp::Octets network_message);
  void wake(PlugHost& host, std::size_t alarm);
  static constexpr std::size_t alarm_count() { return announce_alarm + 1; }

  const handshake::Candidate& candidate() const { return candidate_; }
  /// This life of this node.
  handshake::Binding self() const { return {number_, candidate_.announcement().life}; }
  /// Null without a role.
  const ProgramEndpoint* endpoint() const { return endpoint_ ? &*endpoint_ : nullptr; }

 private:
  static constexpr std::size_t announce_alarm = ProgramEndpoint::alarm_count(1);

  void announce(PlugHost& host);
  void take_role();

  PlugSettings settings_;
  std::uint8_t number_;
  std::vector<handshake::SkillId> skills_;
  handshake::Candidate candidate_;
  std::optional<ProgramEndpoint> endpoint_;
  Arrivals tables_;
  std::uint16_t announcement_sequence_ = 0;
  std::array<std::byte, 128> buffer_;
};

}  // namespace takt::wire
