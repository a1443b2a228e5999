// SPDX-License-Identifier: Apache-2.0
// The three state machines of IEEE 802.1Q clause 8.6.9, run literally from event to event: what the gates of a port, or
// a stream gate, do. Knows nothing of models/egress/cyclic_schedule.hpp. A copy runs on into the future.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "models/ingress/ingress_config.hpp"

namespace takt::wire_checker {

/// Picoseconds since the start. Clocks are ideal, so that true and local time are the same.
using Ps = std::int64_t;
inline constexpr Ps never = std::numeric_limits<Ps>::max();
inline constexpr Ps long_ago = std::numeric_limits<Ps>::min();

/// An entry of a gate control list or of a stream gate's list.
struct ListEntry {
  models::GateOperation operation = models::GateOperation::set_gate_states;
  models::GateStates states = models::all_gates_open;
  Ps interval = 0;
  std::optional<models::Priority> ipv = {};
  std::optional<std::uint32_t> octets = {};
};

struct ListConfig {
  std::vector<ListEntry> list;
  Ps base_time = 0;
  Ps cycle_time = 0;
  Ps extension = 0;
};

inline ListConfig list_config_of(const models::GateConfig& gates) {
  ListConfig config{{}, gates.admin_base_time.ps(), gates.admin_cycle_time.ps(), gates.admin_cycle_time_extension.ps()};
  for (const models::GateControlEntry& entry : gates.admin_control_list)
    config.list.push_back({entry.operation, entry.gate_states, entry.interval.ps()});
  return config;
}
inline ListConfig list_config_of(const models::StreamGateConfig& gate) {
  ListConfig config{{}, gate.admin_base_time.ps(), gate.admin_cycle_time.ps(), gate.admin_cycle_time_extension.ps()};
  for (const models::StreamGateEntry& entry : gate.admin_control_list)
    config.list.push_back({{},
                           entry.open ? models::all_gates_open : models::GateStates{0},
                           entry.interval.ps(),
                           entry.ipv,
                           entry.interval_octet_max});
  return config;
}

class ListMachine {
 public:
  /// What holds before the first list runs.
  explicit ListMachine(ListEntry admin = {}) : entry_(admin) {}

  /// All that happens up to and at `now`.
  void run_to(Ps now) {
    while (next_event() <= now) tick(next_event());
    now_ = std::max(now_, now);
  }
  /// ConfigChange at `now`, before anything else of that instant but a list whose time has come. run_to(now) comes
  /// next.
  void request(Ps now, const ListConfig& config) {
    if (now > 0) run_to(now - 1);
    now_ = now;
    update_config();
    admin_ = std::make_shared<const ListConfig>(config);
    config_change_time_ = admin_->base_time;
    if (config_change_time_ < now_) config_change_time_ = start_not_before(*admin_, now_);
    config_pending_ = true;
    update_config();
  }

  /// What a device starts with: set at the start, or, if it is running then, so long ago that it has begun as its base
  /// time says. The last three cycles tell all that there is to know of earlier ones.
  void start_with(ListConfig config, bool is_running) {
    if (!is_running || config.base_time >= 0) return request(0, config);
    if (const Ps over = -config.base_time / config.cycle_time; over > 3)
      config.base_time += (over - 3) * config.cycle_time;
    request(config.base_time, config);
    run_to(0);
  }

  /// When something happens next: a list is exchanged, a cycle or an entry begins.
  Ps next_event() const {
    Ps next = config_pending_ ? config_change_time_ : never;
    if (oper_) next = std::min(next, cycle_start_time_);
    if (oper_ && list_pointer_ < oper_->list.size()) next = std::min(next, exit_time_);
    return next;
  }
  const ListEntry& entry() const { return entry_; }
  /// When the operation in force was executed: names its run.
  Ps executed_at() const { return executed_at_; }
  bool is_open(models::TrafficClass q) const { return (entry_.states >> q & 1) != 0; }
  bool holds() const { return holds_; }
  Ps now() const { return now_; }
  /// The list that runs, or null.
  const ListConfig* oper() const { return oper_.get(); }
  /// Behind it nothing new happens that has not been seen from `now` on.
  Ps horizon() const {
    Ps cycles = 0;
    if (oper_) cycles += 3 * oper_->cycle_time + oper_->extension;
    if (config_pending_) return std::max(now_, config_change_time_) + cycles + 3 * admin_->cycle_time;
    return now_ + cycles;
  }

 private:
  static Ps start_not_before(const ListConfig& list, Ps time) {
    if (list.base_time >= time) return list.base_time;
    const Ps cycles = (time - list.base_time + list.cycle_time - 1) / list.cycle_time;
    return list.base_time + cycles * list.cycle_time;
  }

  void tick(Ps now) {
    now_ = now;
    update_config();
    if (!oper_) return;
    bool cycle_start = false;
    if (cycle_start_time_ <= now_) {  // START_CYCLE
      cycle_start = true;
      set_cycle_start_time(now_ + 1);
    }
    if (cycle_start) {  // NEW_CYCLE
      list_pointer_ = 0;
      execute();
    } else if (list_pointer_ < oper_->list.size() && exit_time_ <= now_) {
      execute();
    }
  }
  void update_config() {
    if (!config_pending_ || config_change_time_ > now_) return;
    oper_ = admin_;
    config_pending_ = false;
    list_pointer_ = oper_->list.size();
    set_cycle_start_time(now_);
  }
  void set_cycle_start_time(Ps not_before) {
    if (config_pending_ && config_change_time_ <= now_ + oper_->cycle_time + oper_->extension)
      cycle_start_time_ = config_change_time_;
    else
      cycle_start_time_ = start_not_before(*oper_, not_before);
  }
  void execute() {
    entry_ = oper_->list[list_pointer_++];
    exit_time_ = now_ + (entry_.interval == 0 ? 1'000 : entry_.interval);
    executed_at_ = now_;
    if (entry_.operation != models::GateOperation::set_gate_states)
      holds_ = entry_.operation == models::GateOperation::set_and_hold_mac;
  }

  Ps now_ = 0;
  std::shared_ptr<const ListConfig> admin_, oper_;
  ListEntry entry_;
  Ps config_change_time_ = 0;
  Ps cycle_start_time_ = 0;
  Ps exit_time_ = 0;
  Ps executed_at_ = long_ago;
  std::size_t list_pointer_ = 0;
  bool config_pending_ = false;
  bool holds_ = false;
};

/// The time for which gate q is open in a regular cycle.
inline Ps open_time_of(const ListConfig& config, models::TrafficClass q) {
  Ps open = 0, start = 0;
  for (std::size_t i = 0; i < config.list.size() && start < config.cycle_time; ++i) {
    const Ps interval = config.list[i].interval == 0 ? 1'000 : config.list[i].interval;
    const bool is_last = i + 1 == config.list.size();
    const Ps end = is_last ? config.cycle_time : std::min(config.cycle_time, start + interval);
    if ((config.list[i].states >> q & 1) != 0) open += end - start;
    start = start + interval;
  }
  return open;
}

}  // namespace takt::wire_checker
