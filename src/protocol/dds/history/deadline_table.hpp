// SPDX-License-Identifier: Apache-2.0
// DeadlineTable: when each instance is due next (DEADLINE, DDS 1.4, 2.2.3.7).
#pragma once

#include <map>
#include <set>
#include <utility>

#include "dds/history/instance_key.hpp"
#include "sim/check.hpp"
#include "sim/time.hpp"

namespace takt::dds {

/// Instances whose times are equal are due in the order of their keys.
class DeadlineTable {
 public:
  /// A period of Duration::max() is infinite: nothing is ever due.
  explicit DeadlineTable(sim::Duration period) : period_(period) {
    TAKT_CHECK(period > sim::Duration(), "a deadline has a period");
  }

  bool is_infinite() const { return period_ == sim::Duration::max(); }
  sim::LocalTime next() const { return due_.empty() ? sim::LocalTime::never() : due_.begin()->first; }

  /// The instance was updated: it is due a period later.
  void updated(const InstanceKey& key, sim::LocalTime now) {
    if (is_infinite()) return;
    const auto [at, is_new] = times_.try_emplace(key, now.plus_saturated(period_));
    if (!is_new) {
      due_.erase({at->second, key});
      at->second = now.plus_saturated(period_);
    }
    due_.insert({at->second, key});
  }
  void forget(const InstanceKey& key) {
    const auto at = times_.find(key);
    if (at == times_.end()) return;
    due_.erase({at->second, key});
    times_.erase(at);
  }

  /// Tells `missed(key)` of the instances that are due by now, once for each period that has passed.
  template <class Missed>
  void advance(sim::LocalTime now, Missed missed) {
    while (!due_.empty() && due_.begin()->first <= now) {
      const auto [time, key] = *due_.begin();
      due_.erase(due_.begin());
      times_[key] = time.plus_saturated(period_);
      due_.insert({times_[key], key});
      missed(key);
    }
  }

 private:
  sim::Duration period_;
  std::map<InstanceKey, sim::LocalTime> times_;
  std::set<std::pair<sim::LocalTime, InstanceKey>> due_;
};

}  // namespace takt::dds
