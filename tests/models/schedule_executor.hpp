// SPDX-License-Identifier: Apache-2.0
// The three state machines of IEEE 802.1Q clause 8.6.9, run literally, one tick of 1 ns after the other: the oracle for
// what models/egress/cyclic_schedule.hpp computes. Only whole nanoseconds; a copy runs on into the future.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

namespace takt::models::test {

using Ns = std::int64_t;

/// A list and what comes with it, as management writes it. Entry has a member interval_ns.
template <class Entry>
struct ExecutorConfig {
  std::vector<Entry> list;
  Ns base_time = 0;
  Ns cycle_time = 0;
  Ns extension = 0;
};

template <class Entry>
class ScheduleExecutor {
 public:
  using Config = ExecutorConfig<Entry>;

  /// What came of a request.
  struct Change {
    Ns config_change_time = 0;
    bool error_counted = false;
  };

  /// Goes on to instant `now`, which is one tick after the last one, with the requests for a change that come in it.
  /// The order within an instant: a list whose time has come, the requests, Cycle Timer, List Execute.
  std::vector<Change> tick(Ns now, const std::vector<Config>& requests = {}) {
    now_ = now;
    std::vector<Change> changes;
    update_config();
    for (const Config& request : requests) {
      changes.push_back(config_change(request));
      update_config();
    }
    cycle_timer();
    list_execute();
    return changes;
  }

  bool running() const { return oper_cycle_time_ > 0; }
  const Entry& entry() const { return oper_.list[executed_]; }
  /// When the operation in force was executed.
  Ns executed_at() const { return executed_at_; }
  bool config_pending() const { return config_pending_; }
  /// Operations executed since the last look, for state that lasts longer than an entry. In order.
  std::vector<Entry> drain_executed() { return std::exchange(just_executed_, {}); }

 private:
  /// CONFIG_PENDING: SetConfigChangeTime.
  Change config_change(const Config& admin) {
    admin_ = admin;
    config_change_time_ = admin_.base_time;
    while (config_change_time_ < now_) config_change_time_ += admin_.cycle_time;
    config_pending_ = true;
    return {config_change_time_, admin_.base_time < now_ && running()};
  }
  void update_config() {
    if (!config_pending_ || config_change_time_ > now_) return;
    oper_ = admin_;
    oper_cycle_time_ = oper_.cycle_time;
    config_pending_ = false;
    set_cycle_start_time(
        now_);  // NewConfigCT: CYCLE_IDLE, then SET_CYCLE_START_TIME, before another request is looked at
  }

  Ns regular_start(Ns not_before) const {
    Ns start = oper_.base_time;
    while (start < not_before) start += oper_cycle_time_;
    return start;
  }
  /// SetCycleStartTime for a start at or after `not_before`.
  void set_cycle_start_time(Ns not_before) {
    if (config_pending_ && config_change_time_ <= now_ + oper_cycle_time_ + oper_.extension)
      cycle_start_time_ = config_change_time_;
    else
      cycle_start_time_ = regular_start(not_before);
  }
  void cycle_timer() {
    if (!running()) return;
    if (cycle_start_time_ <= now_) {  // START_CYCLE
      cycle_start_ = true;
      set_cycle_start_time(now_ + 1);
    }
  }

  void execute() {
    executed_ = list_pointer_++;
    exit_timer_ = oper_.list[executed_].interval_ns == 0 ? 1 : oper_.list[executed_].interval_ns;
    executed_at_ = now_;
    just_executed_.push_back(oper_.list[executed_]);
  }
  void list_execute() {
    if (!running()) return;
    if (exit_timer_ > 0) --exit_timer_;
    if (cycle_start_) {  // NEW_CYCLE
      cycle_start_ = false;
      list_pointer_ = 0;
      execute();
    } else if (exit_timer_ == 0 && list_pointer_ < oper_.list.size()) {
      execute();
    }
  }

  Ns now_ = 0;
  Config admin_, oper_;
  Ns oper_cycle_time_ = 0;
  Ns config_change_time_ = 0, cycle_start_time_ = 0;
  bool config_pending_ = false, cycle_start_ = false;
  std::size_t list_pointer_ = 0, executed_ = 0;
  Ns exit_timer_ = 0, executed_at_ = 0;
  std::vector<Entry> just_executed_;
};

}  // namespace takt::models::test
