// SPDX-License-Identifier: Apache-2.0
// What can happen to a model: its actions, in the order in which they are tried.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "explore/model/action.hpp"
#include "explore/model/state.hpp"

namespace takt::explore {

/// Those of the network first, calls then, faults last: the part of a Model (model.hpp) that says which there are. The
/// model lists them once, in this order.
class ActionList {
 public:
  std::span<const Action> actions() const { return actions_; }
  std::span<const Action> network_actions() const { return part(0, network_end_); }
  /// Of the adversary, those that a state may allow: nothing that is left out is possible in it.
  std::span<const Action> calls(const State& state) const {
    return part(network_end_, state.commands_left() == 0 ? network_end_ : calls_end_);
  }
  std::span<const Action> faults(const State& state) const {
    return state.faults_left() == 0 ? part(free_begin_, free_end_) : part(calls_end_, actions_.size());
  }

 protected:
  void add(ActionKind kind, std::size_t who, std::size_t what = 0) {
    actions_.push_back({kind, static_cast<std::uint8_t>(who), static_cast<std::uint16_t>(what)});
  }
  void end_network() { network_end_ = actions_.size(); }
  void end_calls() { calls_end_ = free_begin_ = actions_.size(); }
  /// Between these two stand the faults that are possible with none left to spend: whoever is down may come up for
  /// nothing. Without a beginning they are the first of all faults.
  void begin_free() { free_begin_ = actions_.size(); }
  void end_free() { free_end_ = actions_.size(); }

 private:
  std::span<const Action> part(std::size_t begin, std::size_t end) const {
    return std::span(actions_).subspan(begin, end - begin);
  }

  std::vector<Action> actions_;
  std::size_t network_end_ = 0;
  std::size_t calls_end_ = 0;
  std::size_t free_begin_ = 0;
  std::size_t free_end_ = 0;
};

}  // namespace takt::explore
