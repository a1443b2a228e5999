// SPDX-License-Identifier: Apache-2.0
// The scheduler of an application on a simulated host: how late it looks at the end of each window of a criterion.
#pragma once

#include <cstdint>
#include <string_view>

#include "plant/criterion.hpp"
#include "sim/distribution.hpp"
#include "sim/random.hpp"
#include "sim/time.hpp"

namespace takt::scenario {

class WindowCounter {
 public:
  /// Times in ps of the host's clock. `path` names the scheduler in the random streams. The distribution outlives it.
  WindowCounter(const plant::Criterion::Settings& settings, const sim::Distribution& response, std::uint64_t seed,
                std::string_view path)
      : criterion_(settings), response_(&response), chance_(seed, path, "scheduler") {}

  void begin(sim::LocalTime now) { criterion_.begin(now.ps()); }
  void end() { criterion_.end(); }
  /// So many by the call for the activation that was due then.
  void add(sim::LocalTime due, std::uint64_t count = 1) {
    close_until(due);
    criterion_.add(due.ps(), count);
  }
  /// What is over by then is a test or discarded.
  void close_until(sim::LocalTime now) {
    for (auto window = criterion_.open(); window && now.ps() >= window->to; window = criterion_.open())
      criterion_.look(sim::LocalTime::from_ps(window->to).plus_saturated(response_->draw(chance_)).ps());
  }
  const plant::CriterionFigures& figures() const { return criterion_.figures(); }

 private:
  plant::Criterion criterion_;
  const sim::Distribution* response_;
  sim::RandomStream chance_;
};

}  // namespace takt::scenario
