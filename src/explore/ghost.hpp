// The observer of an explored group: the rules of handshake::GroupObserver for S1, S2 and S4, packed into a small value.
//
// The explorer keeps one in each state, so it must be small and forget what no longer matters. Tests drive it side by
// side with GroupObserver, and every counter-example is judged by GroupObserver again.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "explore/by_run.hpp"
#include "explore/property.hpp"
#include "explore/renaming.hpp"
#include "handshake/io.hpp"
#include "handshake/participant.hpp"

namespace takt::explore {

/// What a step means to whoever watches. Equal effects are one number (Members).
struct Effect {
  std::uint8_t change_count = 0;
  std::array<handshake::StateChange, handshake::Outputs::max_changes> change{};
  std::uint32_t run = 0;       ///< after the step
  bool joins = false;          ///< Ready before and after, but in another run
  bool raised = false;
  handshake::IntentKind kind = handshake::IntentKind::Start;  ///< of what was raised
  PropertySet properties;      ///< S5, F1, S3 of `robust` violated; transitions reached

  constexpr bool operator==(const Effect&) const = default;
  /// A round of `paper` begins (invariants.hpp).
  bool begins_round() const;
};

class Ghost {
 public:
  /// All Halted. In `paper` there are facts for each participant, in `robust` for each run.
  Ghost(handshake::Variant variant, std::size_t participants);

  /// The step of a participant; S1, S2 and S4 if they are violated by it.
  PropertySet on_effect(std::size_t participant, const Effect& effect);
  void on_restart(std::size_t participant);

  /// `paper` only: the goals of the calls since the group was last at rest; any of them may be what it settles in.
  bool asked(handshake::PublishedState goal) const { return ((asked_ >> handshake::index_of(goal)) & 1U) != 0; }
  void at_rest() { asked_ = 0; }

  Ghost renamed(const Renaming& renaming) const;
  bool operator==(const Ghost&) const = default;
  std::uint64_t hash() const;

 private:
  struct Facts {
    std::uint32_t run = 0;     ///< `paper`: the participant
    std::uint8_t ready = 0;    ///< participants that were Ready in it, bit 0 the master
    std::uint8_t running = 0;
    bool operator==(const Facts&) const = default;
  };
  bool is_paper() const { return paper_ != 0; }
  std::uint8_t everybody() const { return static_cast<std::uint8_t>((1U << participants_) - 1U); }
  void became_ready(std::size_t participant, std::uint32_t run);
  PropertySet became_running(std::size_t participant, std::uint32_t run);
  void begin_round(std::size_t participant);

  std::uint8_t paper_ = 0;
  std::uint8_t participants_ = 0;
  std::uint8_t passed_init_ = 0;
  std::uint8_t ready_now_ = 0;   ///< `paper` only
  std::uint8_t asked_ = 0;       ///< `paper` only
  ByRun<Facts> facts_;
};

}  // namespace takt::explore
