// SPDX-License-Identifier: Apache-2.0
// What a Linux machine is set to, as its commands say it: the common ground of scripts and of what `tc -j` prints.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "interchange/import.hpp"
#include "json/diagnostics.hpp"

namespace takt::interchange::linux_tc {

/// A value and where it is written.
template <class T>
struct At {
  T value{};
  json::Place place;
};

struct QueueRange {
  std::uint32_t count = 0;
  std::uint32_t offset = 0;
};

struct GateLine {
  char operation = 'S';       ///< S, H, R
  std::uint64_t mask = 0;     ///< bit n: class n
  std::int64_t interval = 0;  ///< ns
  json::Place place;
};

enum class ClassKind : std::uint8_t { taprio, mqprio };

/// The root: taprio or mqprio.
struct Classes {
  ClassKind kind = ClassKind::taprio;
  json::Place place;
  bool at_root = true;
  std::string handle;  ///< without the colon
  At<std::int64_t> num_tc{-1, {}};
  std::vector<At<std::int64_t>> map;
  std::vector<At<QueueRange>> queues;
  std::vector<At<std::int64_t>> max_sdu;
  std::vector<At<bool>> preemptable;  ///< fp: P is true
  At<std::int64_t> base_time;         ///< ns
  std::optional<At<std::int64_t>> cycle_time;
  At<std::int64_t> extension;
  std::vector<GateLine> entries;
  At<std::uint64_t> flags;
  std::optional<At<std::int64_t>> txtime_delay;
  std::optional<At<std::string>> clock;
  bool is_dumped =
      false;  ///< printed by the kernel: max_sdu there is no setting, and there are 16 statuses of preemption
};

struct CreditShaper {
  json::Place place;
  std::string parent;
  At<std::int64_t> idleslope, sendslope, hicredit, locredit;  ///< kbit/s, octets
};

struct LaunchTimes {
  json::Place place;
  std::string parent;
  std::optional<At<std::string>> clock;
  At<std::int64_t> delta;  ///< ns
  bool deadline_mode = false;
};

/// ethtool --set-mm
struct MacMerge {
  json::Place place;
  std::optional<At<bool>> pmac, tx, verify;
  std::optional<At<std::int64_t>> verify_time, fragment;
};

struct StreamGateLine {
  bool open = true;
  std::int64_t interval = 0;
  std::int64_t priority = -1;
  std::int64_t octets = -1;
  json::Place place;
};

struct GateAction {
  json::Place place;
  std::int64_t index = 0;
  At<std::int64_t> base_time;
  std::optional<At<std::int64_t>> cycle_time;
  std::int64_t priority = -1;
  std::vector<StreamGateLine> entries;
};

struct PoliceAction {
  json::Place place;
  std::int64_t index = 0;
  std::uint64_t rate = 0;  ///< bit/s
  std::int64_t burst = 0;  ///< octets
};

/// tc filter ... ingress ... flower
struct IngressFilter {
  json::Place place;
  std::int64_t preference = 0;
  std::optional<std::int64_t> vlan, priority;
  std::optional<std::string> address;  ///< "01:00:5e:7f:00:01", lower case
  std::optional<GateAction> gate;
  std::optional<PoliceAction> police;
};

struct Interface {
  json::Place place;  ///< where it is first named
  std::optional<Classes> classes;
  std::vector<CreditShaper> shapers;
  std::vector<LaunchTimes> launches;
  std::optional<MacMerge> merge;
  bool has_clsact = false;
  std::vector<IngressFilter> filters;
  bool untagged = false;              ///< the VLANs of the port leave it without tag
  std::optional<std::uint64_t> rate;  ///< bit/s, as the machine prints it or ethtool -s sets it
};

struct Machine {
  std::vector<std::pair<std::string, Interface>> interfaces;  ///< in the order of first mention
  bool has_bridge = false;
  std::vector<Remark> remarks;  ///< what was read and sets nothing, or something that takt has not
  Interface& interface(const std::string& name, const json::Place& place) {
    for (auto& [each, value] : interfaces)
      if (each == name) return value;
    interfaces.emplace_back(name, Interface{});
    interfaces.back().second.place = place;
    return interfaces.back().second;
  }
};

/// The checks of what cannot be, also of what the kernel takes: masks of absent classes, lists that are cut off,
/// credits that do not fit a rate of Ethernet ... `port_rate` in bit/s is taken for intervals where no shaper says it.
struct CheckOptions {
  std::uint64_t port_rate = 1'000'000'000;
  std::uint32_t transmit_queues = 8;
  bool classes_may_stay_closed = false;  ///< a class that a priority has and no entry opens
};
void check(const Machine& machine, const CheckOptions& options, json::Diagnostics& diagnostics);

/// The rate of the port that idleslope - sendslope gives, in bit/s; null if that is no rate of Ethernet.
std::optional<std::uint64_t> port_rate_of(const CreditShaper& shaper);

/// The class of "100:6" below handle 100: transmit queue 5; the class that has it.
std::optional<std::size_t> class_of_parent(const Classes& classes, const std::string& parent);

}  // namespace takt::interchange::linux_tc
