// SPDX-License-Identifier: Apache-2.0
#include "scenario/resolve/device_delays.hpp"

#include <algorithm>

namespace takt::scenario {
namespace {

constexpr std::int64_t shortest_frame = 64;

/// An entry without a medium holds for all of its rate, and a link without one may have any of its rate.
bool holds_for(const DevicePort& port, const std::optional<DataRate>& rate, const std::optional<Medium>& medium) {
  if (medium) return rate_of(*medium) == port.rate && (!port.medium || *port.medium == *medium);
  return !rate || *rate == port.rate;
}

}  // namespace

std::string to_text(const DevicePort& port) {
  return port.medium ? std::string(spelling(*port.medium)) : json::to_text(port.rate);
}

std::optional<DelayInterval> delays_between(const Device& device, const std::vector<DevicePort>& ports,
                                            Octets longest_frame, std::optional<MissingDelay>& missing) {
  std::optional<DelayInterval> all;
  for (const DevicePort& from : ports)
    for (const DevicePort& to : ports) {
      bool is_said = false;
      for (const DeviceDelay& delay : device.delays) {
        if (!holds_for(from, delay.from, delay.from_medium) || !holds_for(to, delay.to, delay.to_medium)) continue;
        is_said = true;
        const DelayInterval interval{
            delay.least + delay.least_per_octet * shortest_frame,
            delay.greatest + delay.greatest_per_octet * static_cast<std::int64_t>(longest_frame.count)};
        if (!all) all = interval;
        all->least = std::min(all->least, interval.least);
        all->greatest = std::max(all->greatest, interval.greatest);
      }
      if (is_said) continue;
      missing = MissingDelay{from, to};
      return std::nullopt;
    }
  return all;
}

void set_delays(const DelayInterval& interval, const json::Source& where, Duration& forwarding_delay,
                std::optional<Latency>& forwarding_jitter) {
  forwarding_delay = interval.least;
  forwarding_jitter.reset();
  if (interval.greatest == interval.least) return;
  forwarding_jitter.emplace();
  forwarding_jitter->where = where;
  forwarding_jitter->uniform = Latency::Uniform{Duration(), interval.greatest - interval.least};
}

}  // namespace takt::scenario
