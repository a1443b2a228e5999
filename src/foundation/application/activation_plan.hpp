// SPDX-License-Identifier: Apache-2.0
// Which activation a thread answers next, and how long after it is due.
#pragma once

#include <cstdint>

#include "sim/distribution.hpp"
#include "sim/random.hpp"
#include "sim/time.hpp"

namespace takt::application {

/// The response time of an activation is drawn. If it is not over before the next activation is due, the activation is
/// missed: the call does not take place, and the thread takes up the next one, which draws anew: one draw for each
/// activation, missed or not, from the last begin() on.
class ActivationPlan {
 public:
  /// The distribution outlives it.
  ActivationPlan(sim::Duration every, const sim::Distribution& response, const sim::RandomStream& chance)
      : every_(every), response_(&response), chance_(chance) {}

  /// That activation is the next one.
  void begin(std::int64_t activation) {
    number_ = activation;
    draw();
  }
  /// The activation that is next.
  std::int64_t number() const { return number_; }
  /// Whether it is answered, response() after it is due. Otherwise all that were drawn so far are missed, and this one
  /// draws when it is due.
  bool is_call() const { return is_call_; }
  /// Less than the interval; 0 if there is no call.
  sim::Duration response() const { return is_call_ ? drawn_ : sim::Duration(); }
  /// The call begins, or the activation without one is due.
  void next() {
    if (is_call_) ++number_;
    draw();
  }

 private:
  static constexpr int most_draws = 64;  // in one go, so that a response that is always too long does not hang
  void draw() {
    is_call_ = false;
    for (int draws = 0; draws < most_draws; ++draws, ++number_) {
      drawn_ = response_->draw(chance_);
      is_call_ = drawn_ < every_;
      if (is_call_) break;
    }
  }

  sim::Duration every_;
  const sim::Distribution* response_;
  sim::RandomStream chance_;
  std::int64_t number_ = 0;
  sim::Duration drawn_;
  bool is_call_ = false;
};

}  // namespace takt::application
