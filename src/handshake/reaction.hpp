// How long a group takes to react: from an accepted command to the moment at which all have reached the state it names.
//
// A ghost like GroupObserver: it sees all participants and true time; no protocol code asks it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "handshake/participant.hpp"
#include "sim/time.hpp"

namespace takt::handshake {

enum class ReactionOutcome : std::uint8_t {
  Pending,
  Completed,
  Superseded,  ///< something with another goal came before it was complete
};

struct Reaction {
  IntentKind kind = IntentKind::Halt;
  std::uint16_t initiator = 0;  ///< participant
  Alarm alarm = Alarm::None;    ///< not None: a halt that nobody commanded
  ReactionOutcome outcome = ReactionOutcome::Pending;
  sim::TrueTime began;
  sim::TrueTime completed = sim::TrueTime::never();  ///< never() unless Completed
};

class ReactionTracker {
 public:
  explicit ReactionTracker(std::size_t participants);

  /// All that one step means here: a reaction begins if it has raised an intent, and its changes of state count.
  void on_step(std::size_t participant, const Outputs& outputs, const Word& after, sim::TrueTime at);
  /// The participant is new: Halted.
  void on_restart(std::size_t participant, sim::TrueTime at);

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
  };
  std::vector<PublishedState> state_;
  std::array<std::size_t, published_state_count> count_{};  ///< participants in each state
  std::vector<Reaction> reactions_;
  std::vector<Open> open_;
};

}  // namespace takt::handshake
