// SPDX-License-Identifier: Apache-2.0
// What cannot be, or cannot be meant, of a set of commands. Ten of these the kernel takes without a word.
#include <algorithm>
#include <array>
#include <numeric>

#include "interchange/linux/device.hpp"
#include "json/node.hpp"
#include "json/quantity.hpp"

namespace takt::interchange::linux_tc {
namespace {

std::string rate_text(std::int64_t bits) {
  return bits > 0 ? json::to_text(sim::DataRate{static_cast<std::uint64_t>(bits)}) : std::to_string(bits) + " bit/s";
}

class Checker {
 public:
  Checker(const CheckOptions& options, json::Diagnostics& diagnostics) : options_(options), diagnostics_(diagnostics) {}

  void run(const Interface& interface) {
    const std::uint64_t rate = rate_of(interface);
    if (interface.classes) {
      check_classes(*interface.classes);
      if (interface.classes->kind == ClassKind::taprio) check_gates(*interface.classes, rate);
    }
    check_shapers(interface);
    for (const LaunchTimes& launch : interface.launches) check_launch(interface, launch);
    if (interface.merge) check_merge(*interface.merge);
    check_filters(interface);
  }

 private:
  void error(const json::Place& place, std::string message, std::string found, std::string expected) {
    diagnostics_.error(place, std::move(message), {std::move(found), std::move(expected)});
  }

  std::uint64_t rate_of(const Interface& interface) const {
    for (const CreditShaper& shaper : interface.shapers)
      if (const auto rate = port_rate_of(shaper)) return *rate;
    return interface.rate.value_or(options_.port_rate);
  }

  void check_classes(const Classes& classes) {
    const std::int64_t count = classes.num_tc.value;
    if (count < 1) {
      error(classes.place, "no number of classes", "no num_tc", "num_tc N");
      return;
    }
    for (std::size_t i = 0; i < classes.map.size(); ++i)
      if (classes.map[i].value < 0 || classes.map[i].value >= count)
        error(classes.map[i].place, "a class that is not there",
              "class " + std::to_string(classes.map[i].value) + " for priority " + std::to_string(i),
              "a class from 0 to " + std::to_string(count - 1));
    if (classes.map.empty())
      error(classes.place, "no map", "no class for any priority", "map with the class of each priority");
    if (!classes.queues.empty() && classes.queues.size() != static_cast<std::size_t>(count))
      error(classes.queues.front().place, "queues that do not fit the classes",
            std::to_string(classes.queues.size()) + " ranges for " + std::to_string(count) + " classes",
            "one for each class");
    const bool may_share = (classes.flags.value & 1) != 0;
    for (std::size_t i = 0; i < classes.queues.size(); ++i) {
      const QueueRange& range = classes.queues[i].value;
      if (range.count == 0)
        error(classes.queues[i].place, "a class without a queue", "no queue", "at least one");
      else if (range.offset + range.count > options_.transmit_queues)
        error(classes.queues[i].place, "queues that the device does not have",
              "queues " + std::to_string(range.offset) + " to " + std::to_string(range.offset + range.count - 1),
              "queues 0 to " + std::to_string(options_.transmit_queues - 1));
      for (std::size_t k = 0; k < i && !may_share; ++k) {
        const QueueRange& other = classes.queues[k].value;
        if (range.offset < other.offset + other.count && other.offset < range.offset + range.count)
          error(classes.queues[i].place, "a queue of two classes",
                "queues of class " + std::to_string(i) + " that are of class " + std::to_string(k) + ", too",
                "queues of its own for each class");
      }
    }
    if (!classes.preemptable.empty()) {
      if (classes.kind == ClassKind::taprio && (classes.flags.value & 2) == 0)
        error(classes.preemptable.front().place, "preemption of a schedule in software", "fp without flags 0x2",
              "flags 0x2");
      if (classes.preemptable.size() > static_cast<std::size_t>(count))
        error(classes.preemptable.back().place, "a class that is not there",
              std::to_string(classes.preemptable.size()) + " statuses",
              "one for each of " + std::to_string(count) + " classes");
      else if (classes.preemptable.size() == static_cast<std::size_t>(count) &&
               std::ranges::all_of(classes.preemptable, [](const At<bool>& each) { return each.value; }))
        error(classes.preemptable.front().place, "every class preemptable",
              "no express class, so that nothing is ever sooner for it", "at least one E");
    }
    if (classes.max_sdu.size() > static_cast<std::size_t>(count))
      error(classes.max_sdu.back().place, "a class that is not there",
            std::to_string(classes.max_sdu.size()) + " sizes", "one for each of " + std::to_string(count) + " classes");
  }

  void check_gates(const Classes& classes, std::uint64_t rate) {
    const std::uint64_t flags = classes.flags.value;
    if ((flags & 3) == 3)
      error(classes.flags.place, "two ways at once", "flags 0x3",
            "0x1 (launch times work the gates) or 0x2 (gates in hardware)");
    else if (flags > 3)
      error(classes.flags.place, "flags that taprio does not have", std::to_string(flags), "0x1 or 0x2");
    if ((flags & 2) != 0 && classes.clock)
      error(classes.clock->place, "a clock for gates in hardware", json::quote(classes.clock->value),
            "no clockid: the clock of the interface counts");
    if ((flags & 2) == 0 && !classes.clock && !classes.is_dumped)
      error(classes.place, "no clock", "no clockid for gates in software", "clockid CLOCK_TAI");
    if (classes.base_time.value < 0)
      error(classes.base_time.place, "a base time before the epoch", std::to_string(classes.base_time.value) + " ns",
            "at least 0");
    if (classes.entries.empty()) {
      error(classes.place, "no gate list", "taprio without sched-entry", "at least one");
      return;
    }
    const std::int64_t count = std::clamp<std::int64_t>(classes.num_tc.value, 1, 16);
    const std::uint64_t present = (std::uint64_t{1} << count) - 1;
    const auto least = static_cast<std::int64_t>(60 * 8 * sim::int128{1'000'000'000} / static_cast<sim::int128>(rate));
    sim::int128 sum = 0;
    std::uint64_t opened = 0;
    bool masks_are_sound = true;
    for (const GateLine& line : classes.entries) {
      const bool is_every_class = (line.mask & (line.mask + 1)) == 0 && line.mask >= present;  // "ff" of three classes
      if ((line.mask & ~present) != 0 && !is_every_class) {
        masks_are_sound = false;
        error(line.place, "a gate of a class that is not there", "mask " + hexadecimal(line.mask),
              "a mask up to " + hexadecimal(present) + "; masks are hexadecimal without 0x");
      }
      if (line.interval < std::max<std::int64_t>(least, 1))
        error(line.place, "an interval that is too short", std::to_string(line.interval) + " ns",
              "ns, at least " + std::to_string(std::max<std::int64_t>(least, 1)) + ", the time of 60 octets at " +
                  rate_text(static_cast<std::int64_t>(rate)));
      sum += line.interval;
      opened |= line.mask;
    }
    if (classes.cycle_time && classes.cycle_time->value < sum)
      error(classes.cycle_time->place, "a cycle that cuts its list off",
            std::to_string(classes.cycle_time->value) + " ns for entries of " + json::to_text(sum) + " ns",
            "a cycle that holds all entries");
    std::uint64_t used = 0;
    for (std::size_t i = 0; i < std::min<std::size_t>(classes.map.size(), 8); ++i)
      if (classes.map[i].value >= 0 && classes.map[i].value < 16) used |= std::uint64_t{1} << classes.map[i].value;
    if (const std::uint64_t never = used & ~opened;
        never != 0 && masks_are_sound && !options_.classes_may_stay_closed) {
      std::string names;
      for (int q = 0; q < 16; ++q)
        if ((never >> q & 1) != 0) names += " " + std::to_string(q);
      error(classes.entries.front().place, "a gate that never opens", "no entry with class" + names,
            "an entry that opens each class that has a priority");
    }
  }

  static std::string hexadecimal(std::uint64_t value) {
    std::string text;
    do text.insert(text.begin(), "0123456789abcdef"[value & 15]);
    while ((value >>= 4) != 0);
    return text;
  }

  void check_shapers(const Interface& interface) {
    std::optional<std::uint64_t> rate;
    std::int64_t sum = 0;
    for (const CreditShaper& shaper : interface.shapers) {
      if (shaper.idleslope.value <= 0) {
        error(shaper.place, "no idle slope", std::to_string(shaper.idleslope.value), "idleslope KBIT, positive");
        continue;
      }
      const auto own = port_rate_of(shaper);
      if (!own) {
        error(shaper.sendslope.place.line != 0 ? shaper.sendslope.place : shaper.place,
              "slopes that belong to no rate of Ethernet",
              std::to_string(shaper.idleslope.value) + " - (" + std::to_string(shaper.sendslope.value) +
                  ") kbit/s = " + rate_text((shaper.idleslope.value - shaper.sendslope.value) * 1000),
              "sendslope = idleslope - rate of the port, both in kbit/s");
        continue;
      }
      if (rate && *rate != *own)
        error(shaper.sendslope.place, "two rates of one port", rate_text(static_cast<std::int64_t>(*own)),
              rate_text(static_cast<std::int64_t>(*rate)) + ", as the shaper before");
      rate = own;
      sum += shaper.idleslope.value;
      if (sum * 1000 > static_cast<std::int64_t>(*own))
        error(shaper.idleslope.place, "shapers that ask for more than the link", rate_text(sum * 1000) + " in all",
              "at most " + rate_text(static_cast<std::int64_t>(*own)));
      if (shaper.hicredit.value < 0)
        error(shaper.hicredit.place, "a highest credit below zero", std::to_string(shaper.hicredit.value),
              "at least 0");
      if (shaper.locredit.value > 0)
        error(shaper.locredit.place, "a lowest credit above zero", std::to_string(shaper.locredit.value), "at most 0");
      if (interface.classes && !class_of_parent(*interface.classes, shaper.parent))
        error(shaper.place, "a shaper below no class", "parent " + json::quote(shaper.parent),
              "HANDLE:N, the first queue of a class being N - 1");
    }
  }

  void check_launch(const Interface& interface, const LaunchTimes& launch) {
    if (!launch.clock || (launch.clock->value != "CLOCK_TAI" && launch.clock->value != "TAI"))
      error(launch.clock ? launch.clock->place : launch.place, "a clock by which etf does not count",
            launch.clock ? json::quote(launch.clock->value) : "none", "clockid CLOCK_TAI");
    if (launch.delta.value < 0)
      error(launch.delta.place, "a negative delta", std::to_string(launch.delta.value), "at least 0 ns");
    if (interface.classes && (interface.classes->flags.value & 1) != 0 && interface.classes->txtime_delay &&
        interface.classes->txtime_delay->value <= launch.delta.value)
      error(launch.delta.place, "launch times that come too late",
            "a txtime-delay of " + std::to_string(interface.classes->txtime_delay->value) + " ns above a delta of " +
                std::to_string(launch.delta.value) + " ns",
            "a txtime-delay greater than the delta");
  }

  void check_merge(const MacMerge& merge) {
    const bool pmac = merge.pmac && merge.pmac->value;
    const bool tx = merge.tx && merge.tx->value;
    if (tx && merge.pmac && !pmac)
      error(merge.tx->place, "fragments sent by who takes none", "tx-enabled on, pmac-enabled off", "pmac-enabled on");
    if (merge.verify && merge.verify->value && merge.tx && !tx)
      error(merge.verify->place, "verification without sending", "verify-enabled on, tx-enabled off", "tx-enabled on");
    if (merge.verify_time && (merge.verify_time->value < 1 || merge.verify_time->value > 128))
      error(merge.verify_time->place, "not a verify time", std::to_string(merge.verify_time->value), "1 to 128 ms");
    constexpr std::array<std::int64_t, 4> sizes = {60, 124, 188, 252};
    if (merge.fragment && std::ranges::find(sizes, merge.fragment->value) == sizes.end())
      error(merge.fragment->place, "not a fragment size", std::to_string(merge.fragment->value),
            "60, 124, 188 or 252, the octets before the check sequence");
  }

  void check_filters(const Interface& interface) {
    for (const IngressFilter& filter : interface.filters) {
      if (!interface.has_clsact)
        error(filter.place, "a filter of an interface without ingress", "no \"tc qdisc add dev IF clsact\"",
              "clsact before it");
      if (!filter.gate) continue;
      std::int64_t sum = 0;
      for (const StreamGateLine& line : filter.gate->entries) sum += line.interval;
      if (filter.gate->cycle_time && filter.gate->cycle_time->value < sum)
        error(filter.gate->cycle_time->place, "a cycle that cuts its list off",
              std::to_string(filter.gate->cycle_time->value) + " ns for entries of " + std::to_string(sum) + " ns",
              "a cycle that holds all entries");
    }
  }

  const CheckOptions& options_;
  json::Diagnostics& diagnostics_;
};

}  // namespace

void check(const Machine& machine, const CheckOptions& options, json::Diagnostics& diagnostics) {
  for (const auto& [name, interface] : machine.interfaces) Checker(options, diagnostics).run(interface);
}

std::optional<std::uint64_t> port_rate_of(const CreditShaper& shaper) {
  constexpr std::array<std::int64_t, 13> ethernet_mbps = {10,     100,    1'000,   2'500,   5'000,   10'000, 25'000,
                                                          40'000, 50'000, 100'000, 200'000, 400'000, 800'000};
  const std::int64_t kbps = shaper.idleslope.value - shaper.sendslope.value;
  if (shaper.idleslope.value <= 0 || kbps % 1000 != 0 ||
      std::ranges::find(ethernet_mbps, kbps / 1000) == ethernet_mbps.end())
    return std::nullopt;
  return static_cast<std::uint64_t>(kbps) * 1000;
}

std::optional<std::size_t> class_of_parent(const Classes& classes, const std::string& parent) {
  const std::size_t colon = parent.find(':');
  if (colon == std::string::npos || parent.substr(0, colon) != classes.handle) return std::nullopt;
  std::uint64_t queue = 0;
  for (const char c : parent.substr(colon + 1)) {
    const std::size_t digit = std::string_view("0123456789abcdef").find(c);  // minor numbers of qdiscs are hexadecimal
    if (digit == std::string_view::npos || queue > 0xFFF) return std::nullopt;
    queue = queue * 16 + digit;
  }
  if (queue == 0) return std::nullopt;
  for (std::size_t q = 0; q < classes.queues.size(); ++q) {
    const QueueRange& range = classes.queues[q].value;
    if (queue - 1 >= range.offset && queue - 1 < range.offset + range.count) return q;
  }
  return std::nullopt;
}

}  // namespace takt::interchange::linux_tc
