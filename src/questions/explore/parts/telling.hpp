// SPDX-License-Identifier: Apache-2.0
// A run of parts_model.hpp as a run of real registers: each word that is heard was published in time.
#pragma once

#include <cstddef>
#include <vector>

#include "explore/parts/parts_model.hpp"

namespace takt::explore {

class Telling {
 public:
  /// From a state in which each register holds what its receiver heard last, if that is one that it has heard.
  Telling(PartsModel& model, const State& state);

  /// The next step of the run; one that is not possible ends it, and is told as it is.
  void take(Action action);
  /// All steps so far, with `send` where it has to be.
  std::vector<Action> actions() const;

 private:
  /// When a word of a channel can be published: it stands in the register already, its sender still says it, or it said
  /// it until a step.
  struct Chance {
    bool stands = false;
    bool is_over = false;
    std::size_t until = 0;
  };
  struct Sending {
    std::size_t before = 0;  ///< this step
    std::size_t channel = 0;
  };
  const Said& said(const State& state, std::size_t channel) const;
  bool sender_is_up(const State& state, std::size_t channel) const;
  void note(std::size_t channel, const State& before, const State& after);
  void send_in_time(std::size_t channel, std::size_t at);

  PartsModel* model_;
  State state_;
  bool is_over_ = false;
  std::vector<Action> steps_;
  std::vector<Sending> sendings_;
  std::vector<std::vector<Chance>> chances_;  ///< by channel and word
};

}  // namespace takt::explore
