// SPDX-License-Identifier: Apache-2.0
// The stations of a group with roles, as numbers: the master, which binds the roles, and the candidates. Each step is
// taken once by the very handshake::Binder, Candidate and Participant, as wire/program_node.cpp drives them, and then
// remembered.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "explore/model/hash_index.hpp"
#include "explore/model/members.hpp"
#include "explore/properties/small_observer.hpp"
#include "handshake/binder.hpp"
#include "handshake/coupling.hpp"

namespace takt::explore {

using handshake::Binding;
using StationId = std::uint32_t;
using NoticeId = std::uint32_t;  ///< 0: nothing
inline constexpr NoticeId no_notice = 0;

/// What stands in a register.
struct Notice {
  enum class Kind : std::uint8_t { none, announcement, word, table };
  Kind kind = Kind::none;
  std::uint8_t role = 0;  ///< word of a candidate: the role in which it says so
  handshake::Announcement announcement;
  handshake::Word word;
  std::array<Binding, most_explored_roles> bindings{};  ///< table
  std::array<std::uint32_t, most_explored_candidates> used_lives{};
  bool operator==(const Notice&) const = default;
};

/// What happens to a station.
enum class Happens : std::uint8_t {
  received,
  initialised,
  call,
  finished,
  role_silent,
  announcer_silent,
  master_silent,
  peer_silent,
  join,
  leave
};

/// What a step means to whoever watches the roles.
struct RoleEvent {
  enum class Kind : std::uint8_t { step, bound, dropped };
  Kind kind = Kind::step;
  std::uint8_t participant = 0;  ///< 0 the master, then the roles; of an outer group its participants
  bool is_outer = false;         ///< step: of a participant of the outer group
  Effect effect;                 ///< step
  Binding self;                  ///< step of a role, dropped: whose; bound: to whom
  handshake::PublishedState after = handshake::PublishedState::Halted;
  bool operator==(const RoleEvent&) const = default;
};
struct RoleEvents {
  std::vector<RoleEvent> each;
  PropertySet properties;
  bool refused = false;  ///< call
  bool operator==(const RoleEvents&) const = default;
};

class Stations {
 public:
  struct Master {
    Participant participant;
    std::uint32_t binder = 0;
    bool down = false;
    std::optional<Participant> outer;  ///< its group is nested: what its node is outside
    handshake::Coupling coupling;
    bool operator==(const Master&) const = default;
  };
  struct Node {
    std::uint8_t number = 0;  ///< of the candidate
    handshake::Candidate candidate;
    std::optional<Participant> member;  ///< while it has a role
    bool down = false;
    bool operator==(const Node&) const = default;
  };
  /// A participant of the outer group alone.
  struct Outsider {
    Participant participant;
    bool down = false;
    bool operator==(const Outsider&) const = default;
  };
  struct Stepped {
    StationId station = 0;
    std::uint32_t events = 0;  ///< 0: nothing to see
  };

  explicit Stations(const Query& query);

  StationId master(std::uint32_t incarnation, bool down);
  StationId candidate(std::size_t number, std::uint32_t life, bool joined, bool down);

  const Master& master(StationId id) const { return masters_[id]; }
  const handshake::Binder& binder(StationId master) const { return binders_[masters_[master].binder]; }
  const Node& node(StationId id) const { return nodes_[id]; }
  StationId outsider(std::size_t index, std::uint32_t incarnation, bool down) {
    return outsiders_.intern({Participant(config(index, incarnation, handshake::Side::outer)), down});
  }
  const Outsider& outsider(StationId id) const { return outsiders_[id]; }
  const Notice& notice(NoticeId id) const { return notices_[id]; }
  const RoleEvents& events(std::uint32_t id) const { return events_[id]; }
  std::size_t size() const { return masters_.size() + nodes_.size() + outsiders_.size(); }
  std::size_t notice_count() const { return notices_.size(); }

  Stepped step_master(StationId id, Happens what, std::size_t which, NoticeId notice = no_notice) {
    return step(id, 0, what, which, notice);
  }
  /// As a slave of the outer group.
  Stepped step_outside(StationId master, Happens what, std::size_t which, NoticeId notice = no_notice) {
    return step(master, from_outside, what, which, notice);
  }
  Stepped step_outsider(StationId id, Happens what, std::size_t which, NoticeId notice = no_notice) {
    return step(id, from_outsiders, what, which, notice);
  }
  Stepped step_node(StationId id, Happens what, std::size_t which = 0, NoticeId notice = no_notice) {
    return step(id, from_nodes, what, which, notice);
  }

  NoticeId word_of_master(StationId id);
  NoticeId table(StationId id);
  NoticeId announcement(StationId id);  ///< nothing if it does not announce itself
  NoticeId word_of_node(StationId id);  ///< nothing without a role
  NoticeId word_outside(StationId master) { return word_notice(masters_[master].outer->word()); }
  NoticeId word_of_outsider(StationId id) { return word_notice(outsiders_[id].participant.word()); }

 private:
  static constexpr std::uint64_t from_nodes = std::uint64_t{1} << 63;
  static constexpr std::uint64_t from_outside = std::uint64_t{1} << 62;
  static constexpr std::uint64_t from_outsiders = std::uint64_t{1} << 61;
  template <class Value>
  struct Hash {
    std::size_t operator()(const Value& value) const;
  };

  Stepped step(StationId id, std::uint64_t kind, Happens what, std::size_t which, NoticeId notice);
  StationId stepped_master(StationId id, Happens what, std::size_t which, const Notice& notice, RoleEvents& events);
  StationId stepped_outside(StationId id, Happens what, std::size_t which, const Notice& notice, RoleEvents& events);
  StationId stepped_outsider(StationId id, Happens what, std::size_t which, const Notice& notice, RoleEvents& events);
  StationId stepped_node(StationId id, Happens what, std::size_t which, const Notice& notice, RoleEvents& events);
  void settle(Master& master, handshake::Binder& binder, Happens what, RoleEvents& events) const;
  bool stabilise_roles(Master& master, handshake::Binder& binder, RoleEvents& events) const;
  StationId settled(Master& master, handshake::Binder& binder, Happens what, RoleEvents& events);
  NoticeId word_notice(const handshake::Word& word);
  handshake::Config config(std::size_t index, std::uint32_t incarnation,
                           handshake::Side side = handshake::Side::inner) const;

  Query query_;
  std::vector<handshake::SkillId> skills_;  ///< by role
  Interner<Master, Hash<Master>> masters_;
  Interner<handshake::Binder, Hash<handshake::Binder>> binders_;
  Interner<Node, Hash<Node>> nodes_;
  Interner<Outsider, Hash<Outsider>> outsiders_;
  Interner<Notice, Hash<Notice>> notices_;
  Interner<RoleEvents, Hash<RoleEvents>> events_;
  Memo steps_;
};

}  // namespace takt::explore
