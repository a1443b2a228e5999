// SPDX-License-Identifier: Apache-2.0
// How long a group takes to react: from an accepted command, or from what happens to the group (a crash, a link that
// fails), to the moment at which all living participants have reached the state that follows.
//
// Like the Observer it sees all participants and true time; no protocol code asks it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "handshake/cause.hpp"
#include "handshake/participant.hpp"
#include "sim/time.hpp"

namespace takt::handshake {

enum class ReactionOutcome : std::uint8_t {
  pending,
  completed,
  superseded,  ///< something with another goal came before it was complete
};

struct Reaction {
  IntentKind kind = IntentKind::Halt;
  std::uint16_t initiator = 0;  ///< participant: who was called, who has crashed, or who was first to notice
  Cause cause = Cause::command;
  ReactionOutcome outcome = ReactionOutcome::pending;
  sim::TrueTime began;                               ///< the instant of the cause
  sim::TrueTime completed = sim::TrueTime::never();  ///< never() unless Completed
};

/// Why a step has raised an intent, as far as somebody outside knows it.
struct Origin {
  Cause cause = Cause::command;
  sim::TrueTime since = sim::TrueTime::never();  ///< never(): the step itself
  bool by_itself = false;                        ///< a start that nobody called: it goes on after the last fault
};

class ReactionTracker {
 public:
  explicit ReactionTracker(std::size_t participants);

  /// All that one step means here: a reaction begins if it has raised an intent, and its changes of state count. An
  /// alarm has the cause that `origin` gives, or the one that the alarm itself tells, but none from before the
  /// participant left Halted; while the halt after a fault is under way it belongs to that.
  void on_step(std::size_t participant, const Outputs& outputs, const Word& after, sim::TrueTime at,
               const Origin& origin = {});
  /// The participant's node has failed. The others have to halt from now on; who is dead is not waited for.
  void on_crash(std::size_t participant, sim::TrueTime at);
  /// The participant is nobody any more, without a fault: it is not waited for.
  void on_leave(std::size_t participant, sim::TrueTime at);
  /// The participant is new: Halted.
  void on_restart(std::size_t participant, sim::TrueTime at);
  bool is_there(std::size_t participant) const { return is_there_[participant]; }

  /// A reaction begins. One that is still pending and has another goal is superseded by it; but where both carry an
  /// intent (number not 0), the lesser of the two is superseded, whichever began first.
  void begin(const Reaction& reaction, const Intent& intent);
  void move(std::size_t participant, PublishedState to, sim::TrueTime at);
  /// Completes what all have reached already, which `move` does by itself.
  void complete_those_reached(sim::TrueTime at);

  /// All reactions in the order in which they began.
  std::span<const Reaction> reactions() const { return reactions_; }

 private:
  struct Open {
    std::size_t reaction;  ///< position in reactions_
    Intent intent;
    bool is_awaited = false;  ///< after a crash, which nobody has noticed yet: nothing supersedes it
  };
  bool is_reached(IntentKind kind) const;
  /// Drops what is superseded by the reaction; true if that is superseded itself.
  bool supersede(std::size_t position, const Intent& intent);
  bool joins_fault(const Outputs& outputs, const Intent& intent);

  std::vector<PublishedState> state_;
  std::vector<bool> is_there_;
  std::vector<sim::TrueTime> left_halted_;                  ///< by participant
  std::array<std::size_t, published_state_count> count_{};  ///< living participants in each state
  std::size_t living_;
  std::optional<Origin> fault_;  ///< the last one, until somebody calls Start
  std::vector<Reaction> reactions_;
  std::vector<Open> open_;
};

/// Reaction times of the whole tree: until the participants of all its groups have reached the state that was asked
/// for. What one group only passes on to the other is no reaction of its own. Of two reactions the later supersedes.
class TreeReactions {
 public:
  explicit TreeReactions(std::size_t participants) : tracker_(participants) {}
  void on_step(std::size_t number, const Outputs& outputs, sim::TrueTime at, const Origin& origin = {});
  void on_crash(std::size_t number, sim::TrueTime at) { tracker_.on_crash(number, at); }
  void on_leave(std::size_t number, sim::TrueTime at) { tracker_.on_leave(number, at); }
  void on_restart(std::size_t number, sim::TrueTime at) { tracker_.on_restart(number, at); }
  std::span<const Reaction> reactions() const { return tracker_.reactions(); }

 private:
  ReactionTracker tracker_;
};

}  // namespace takt::handshake
