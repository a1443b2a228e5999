// SPDX-License-Identifier: Apache-2.0
// What a node is in a Program, sans-IO: a participant, the master that binds roles, or a candidate for them. A turn
// goes in, its outputs come out.
//
// The simulated host and the real node own one each and differ only in how they carry the outputs out.
#pragma once

#include <optional>
#include <vector>

#include "handshake/binder.hpp"
#include "wire/program_endpoint.hpp"
#include "wire/role_format.hpp"

namespace takt::wire {

/// How many announcements in a row may be missed.
inline constexpr std::int64_t announcements_missed = 3;
/// After that a node that has announced nothing is gone.
constexpr sim::Duration announce_timeout(sim::Duration announce_cycle) {
  return announce_cycle * announcements_missed + announce_cycle / 2;
}
/// How many cycles there are from one announcement to the next, if nobody says otherwise.
inline constexpr std::int64_t cycles_of_announcement = 10;

/// What a candidate for roles offers.
struct Offer {
  std::uint8_t number = 0;  ///< of the candidate
  std::uint32_t life = 1;   ///< the first one, never 0; a node that starts again begins with one that it never had
  std::vector<handshake::SkillId> skills;
  bool joins_at_start = true;
};

/// Of a Program whose roles are bound while it runs. Without them each participant has had its role from the beginning.
struct RoleSettings {
  std::shared_ptr<const RoleFormat> format;
  sim::Duration announce_cycle;  ///< above 0; of announcements and of the table
  bool restarts = false;         ///< the group goes on by itself when a lost role is bound again
  std::optional<Offer> offer;    ///< the master makes none
};

struct NodeSettings {
  EndpointSettings endpoint;  ///< of a candidate but for index and incarnation, which come with its role
  std::optional<RoleSettings> roles = {};

  /// The node begins with this incarnation; so does the life of a candidate.
  void set_incarnation(std::uint32_t incarnation);
};

class ProgramNode {
 public:
  explicit ProgramNode(NodeSettings settings);

  NodeOutputs& start(sim::LocalTime now);
  /// A method call by a client or the user of this node. A Start while a role has no node is refused with
  /// BadResourceUnavailable, any method at a candidate without a role with BadInvalidState.
  NodeOutputs& call(sim::LocalTime now, program::Method method);
  /// The local process has ended by itself.
  NodeOutputs& finished(sim::LocalTime now);
  /// A NetworkMessage has come.
  NodeOutputs& receive(sim::LocalTime now, uadp::Octets network_message);
  /// An alarm has come due.
  NodeOutputs& wake(sim::LocalTime now, std::size_t alarm);
  /// Publishes an own data set, if the participant is Running.
  NodeOutputs& publish_data(sim::LocalTime now, std::uint8_t data_set);
  /// A candidate begins to announce itself, or asks to be let go.
  NodeOutputs& join(sim::LocalTime now);
  NodeOutputs& leave(sim::LocalTime now);
  /// It loses its memory, as in a crash, and begins another life with `start`; a candidate announces itself if it did
  /// before.
  void crash();

  /// Of a cycle, of an initialisation, and one for each peer as those of its endpoint; behind them those of its role.
  std::size_t alarm_count() const;
  /// Peers that it has, or will have with a role.
  std::size_t peer_count() const { return peers_; }
  /// As which participant it takes part now, 0 for the master; nothing at a candidate without a role.
  std::optional<std::size_t> participant() const {
    return endpoint_ ? std::optional<std::size_t>(endpoint_->settings().handshake.index) : std::nullopt;
  }
  /// Its state as a participant; a candidate without a role is Halted.
  handshake::PublishedState state() const {
    return endpoint_ ? endpoint_->participant().state() : handshake::PublishedState::Halted;
  }
  /// The participant; null without a role.
  const ProgramEndpoint* endpoint() const { return endpoint_ ? &*endpoint_ : nullptr; }
  /// At the master of roles; else null.
  const handshake::Binder* binder() const { return binder_ ? &*binder_ : nullptr; }
  /// At a candidate; else null.
  const handshake::Candidate* candidate() const { return candidate_ ? &*candidate_ : nullptr; }
  /// This life of this candidate.
  handshake::Binding self() const { return {settings_.roles->offer->number, candidate_->announcement().life}; }

 private:
  friend class Nesting;
  /// Joins another Program of its node. The inner one may bind roles; candidates join none.
  ProgramEndpoint& join(Nesting& nesting, handshake::Side side);
  /// Tells the participant what the binder finds; a new table is published at once. False if all is settled.
  bool stabilise_roles(const Turn& turn);
  /// All of its roles are bound, if there are any.
  bool is_complete() const { return !binder_ || binder_->complete(); }

  Turn turn(sim::LocalTime now);
  [[gnu::noinline]] NodeOutputs& receive_with_roles(const Turn& turn, uadp::Octets network_message);
  std::size_t role_alarm() const {
    return ProgramEndpoint::alarm_count(peers_);
  }  // announcement or table; candidates' silence behind it
  void begin();
  bool take(const Turn& turn, const AnnouncementMessage& message);
  bool take(const Turn& turn, const TableMessage& message);
  void read_role();
  void settle(const Turn& turn);
  void publish_table(const Turn& turn);
  void announce(const Turn& turn);
  template <class Message>
  void publish(const Turn& turn, const Message& message, std::uint16_t writer_group);

  NodeSettings settings_;
  std::size_t peers_ = 1;
  std::optional<ProgramEndpoint> endpoint_;
  std::optional<handshake::Binder> binder_;
  std::optional<handshake::Candidate> candidate_;
  std::vector<Arrivals> arrivals_;  ///< announcements by candidate; at a candidate the tables
  std::uint16_t sequence_ = 0;      ///< of its tables or announcements
  sim::LocalTime next_other_life_;  ///< a candidate does not begin another because of a table before
  NodeOutputs outputs_;             ///< without nesting
  Nesting* nesting_ = nullptr;
  handshake::Side side_ = handshake::Side::outer;
};

}  // namespace takt::wire
