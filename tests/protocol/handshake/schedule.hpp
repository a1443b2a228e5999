// SPDX-License-Identifier: Apache-2.0
// A schedule of small actions: made from its seed, so that one that fails can be cut down and printed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "dice.hpp"

namespace takt::handshake {

/// What a and b stand for is settled by whoever acts.
template <class Act>
struct Action {
  Act act{};
  std::uint32_t a = 0;
  std::uint32_t b = 0;
};

/// Leaves out whatever is not needed for the failure, in ever smaller pieces. `is_sound` says of a schedule that it
/// does not fail.
template <class Act, class IsSound>
std::vector<Action<Act>> shrink(std::vector<Action<Act>> schedule, const IsSound& is_sound) {
  for (std::size_t piece = schedule.size() / 2; piece > 0; piece /= 2) {
    for (std::size_t from = 0; from + piece <= schedule.size();) {
      std::vector<Action<Act>> shorter = schedule;
      const auto first = shorter.begin() + static_cast<std::ptrdiff_t>(from);
      shorter.erase(first, first + static_cast<std::ptrdiff_t>(piece));
      if (is_sound(shorter))
        from += piece;
      else
        schedule = shorter;
    }
  }
  return schedule;
}

/// `names`: of the acts, by their numbers.
template <class Act>
std::string print(const std::vector<Action<Act>>& schedule, std::span<const char* const> names) {
  std::string text;
  for (const Action<Act>& action : schedule)
    text += "  " + std::string(names[static_cast<std::size_t>(action.act)]) + " " + std::to_string(action.a) + " " +
            std::to_string(action.b) + "\n";
  return text;
}

/// A network that keeps messages until it is told which one arrives. When it is full it loses the oldest.
template <class Message>
class UnderWay {
 public:
  explicit UnderWay(std::size_t most) : most_(most) {}

  bool empty() const { return messages_.empty(); }
  std::size_t size() const { return messages_.size(); }
  const Message& operator[](std::size_t position) const { return messages_[position]; }
  void put(const Message& message) {
    if (messages_.size() >= most_) take(0);
    messages_.push_back(message);
  }
  Message take(std::size_t position) {
    const Message message = messages_[position];
    messages_.erase(messages_.begin() + static_cast<std::ptrdiff_t>(position));
    return message;
  }
  /// Hands on what an action of these numbers delivers: mostly the oldest ones in order, at most `burst`, sometimes any
  /// one.
  template <class Deliver>
  void deliver(std::uint32_t a, std::uint32_t b, std::size_t burst, const Deliver& deliver) {
    if (b % 8 == 0) {
      if (!empty()) deliver(take(a % size()));
    } else {
      for (std::uint32_t i = 0; i <= b % burst && !empty(); ++i) deliver(take(0));
    }
  }

 private:
  std::size_t most_;
  std::vector<Message> messages_;
};

}  // namespace takt::handshake
