// SPDX-License-Identifier: Apache-2.0
// How long values are under way that an application publishes to one topic and takes from another, which others have
// filled with what they took: round trips.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "application/duration_figures.hpp"
#include "sim/time.hpp"

namespace takt::application {

/// Values that are out, the oldest first; each is known by its fields, so that no two that are out at once should be
/// equal: those of a counter are not. A value that comes back takes those with it that went out before, which will not
/// come back any more or come too late; one that has come back is not out, so a repetition counts for nothing.
class RoundTrips {
 public:
  /// Of those that are out, so many at most are remembered; older ones are forgotten.
  static constexpr std::size_t most_out = 1024;

  void published(std::span<const std::byte> fields, sim::LocalTime now) {
    if (out_ == most_out) forget(1);
    if (values_.size() < most_out) values_.resize(most_out);
    Value& value = values_[(first_ + out_) % most_out];
    value.fields.assign(fields.begin(), fields.end());
    value.at = now;
    ++out_;
  }
  void taken(std::span<const std::byte> fields, sim::LocalTime now) {
    for (std::size_t i = 0; i < out_; ++i) {
      const Value& value = values_[(first_ + i) % most_out];
      if (!std::ranges::equal(value.fields, fields)) continue;
      figures_.add(now - value.at);
      forget(i + 1);
      return;
    }
  }
  /// The application begins anew: what is out belongs to its former life.
  void restart() { first_ = out_ = 0; }

  const DurationFigures& figures() const { return figures_; }

 private:
  struct Value {
    std::vector<std::byte> fields;
    sim::LocalTime at;
  };
  void forget(std::size_t count) {
    first_ = (first_ + count) % most_out;
    out_ -= count;
  }

  std::vector<Value> values_;  // a ring
  std::size_t first_ = 0;
  std::size_t out_ = 0;
  DurationFigures figures_;
};

}  // namespace takt::application
