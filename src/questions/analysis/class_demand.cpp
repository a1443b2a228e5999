// SPDX-License-Identifier: Apache-2.0
#include "analysis/class_demand.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>

#include "models/ethernet/sizes.hpp"

namespace takt::analysis {

ClassDemand::ClassDemand(const PortTraffic& traffic, models::ClassSet classes, Ps octet_time, models::ClassSet of_turns)
    : octet_time_(octet_time) {
  std::map<std::size_t, Group> by_link;
  for (const PortFlow& flow : traffic.flows) {
    bool counts = false;
    for (models::TrafficClass q = flow.lowest_class; q <= flow.highest_class; ++q)
      counts = counts || (models::contains(classes, q) && (!flow.uses_cqf || models::contains(of_turns, q)));
    if (!counts) continue;
    Group& group = by_link[flow.link];
    const Ps work = octet_time * models::wire_length(flow.frame).count;
    const Ps least = octet_time * models::wire_length(flow.shortest.value_or(flow.frame)).count;
    group.flows.push_back({&flow.arrivals, work, least});
    group.is_limited = group.is_limited && flow.arrivals.is_limited();
    group.at_once = std::max(group.at_once, work);
    longest_ = std::max(longest_, work);
    shortest_ = shortest_ == 0 ? least : std::min(shortest_, least);
  }
  for (auto& [link, group] : by_link) {
    const IncomingLink& incoming = traffic.links[link];
    group.link_octet = incoming.octet_time.value_or(0);
    if (incoming.is_mixed) group.at_once *= 2;
    double rate = std::numeric_limits<double>::infinity();
    double burst = 0;
    if (group.is_limited) {
      rate = 0;
      for (const Flow& flow : group.flows) {
        const ArrivalPattern& calm = flow.arrivals->calmest();
        rate += static_cast<double>(flow.work) * calm.rate();
        burst += static_cast<double>(flow.work) * calm.burst();
      }
    }
    if (group.link_octet > 0) {
      const double link_rate = static_cast<double>(octet_time) / static_cast<double>(group.link_octet);
      if (link_rate <= rate) {
        rate = link_rate;
        burst = static_cast<double>(group.at_once);
      }
    }
    rate_ += rate;
    burst_ += burst;
    groups_.push_back(std::move(group));
  }
}

Ps ClassDemand::flows_work(const Group& group, Ps length) const {
  if (!group.is_limited) return unbounded_ps;
  Ps work = 0;
  for (const Flow& flow : group.flows) work = sum(work, product(flow.work, flow.arrivals->count(length)));
  return work;
}

/// Frames arrive with their last bits, so the first of an interval costs the link no time within it.
Ps ClassDemand::link_work(const Group& group, Ps length) const {
  return group.link_octet == 0 ? unbounded_ps : sum(group.at_once, scaled_up(length, octet_time_, group.link_octet));
}

Ps ClassDemand::work(Ps length) const {
  if (!is_bounded(length)) return groups_.empty() ? 0 : unbounded_ps;
  Ps work = 0;
  for (const Group& group : groups_) work = sum(work, std::min(flows_work(group, length), link_work(group, length)));
  return work;
}

std::int64_t ClassDemand::frames(Ps length) const {
  std::int64_t frames = 0;
  for (const Group& group : groups_) {
    std::int64_t count = 0;
    Ps least = unbounded_ps;
    for (const Flow& flow : group.flows) {
      if (group.is_limited) count += flow.arrivals->count(length);
      least = std::min(least, flow.least);
    }
    const Ps by_link = link_work(group, length);
    if (is_bounded(by_link)) count = group.is_limited ? std::min(count, by_link / least) : by_link / least;
    frames += count;
  }
  return frames;
}

Ps ClassDemand::work_in_each(Ps length) const {
  Ps work = 0;
  for (const Group& group : groups_)
    for (const Flow& flow : group.flows) {
      const ArrivalPattern& pattern = flow.arrivals->calmest();
      work = sum(work, product(flow.work, length / pattern.period * pattern.frames));
    }
  return work;
}

Ps ClassDemand::settled_after() const {
  Ps settled = 0;
  for (const Group& group : groups_) {
    if (group.link_octet == 0) continue;
    double rate = 0, burst = 0;
    for (const Flow& flow : group.flows) {
      rate += static_cast<double>(flow.work) * flow.arrivals->calmest().rate();
      burst += static_cast<double>(flow.work) * flow.arrivals->calmest().burst();
    }
    const double spare = static_cast<double>(octet_time_) / static_cast<double>(group.link_octet) - rate;
    if (spare <= 0) return unbounded_ps;
    settled = std::max(settled, rounded_up(std::max(0.0, (burst - static_cast<double>(group.at_once)) / spare)));
  }
  return settled;
}

std::optional<Ps> ClassDemand::common_period(Ps period, Ps most) const {
  sim::int128 all = period;
  for (const Group& group : groups_)
    for (const Flow& flow : group.flows) {
      if (flow.arrivals->patterns().size() != 1) return std::nullopt;
      const Ps its = flow.arrivals->calmest().period;
      if (!is_bounded(its)) return std::nullopt;  // it happens once, and until then nothing repeats
      all = all / std::gcd(static_cast<Ps>(all), its) * its;
      if (all > most) return std::nullopt;
    }
  return static_cast<Ps>(all);
}

std::vector<Ps> ClassDemand::bends(Ps end, std::size_t most) const {
  std::vector<Ps> lengths{0};
  for (const Group& group : groups_) {
    std::vector<Ps> jumps{0};
    for (const Flow& flow : group.flows) {
      if (!flow.arrivals->is_limited()) continue;
      for (Ps t = flow.arrivals->next_jump(0); t <= end; t = flow.arrivals->next_jump(t)) {
        jumps.push_back(t);
        if (jumps.size() > most) return {};
      }
    }
    if (group.link_octet > 0 && group.is_limited) {
      // Where the link has brought what the flows have to send.
      std::sort(jumps.begin(), jumps.end());
      jumps.erase(std::unique(jumps.begin(), jumps.end()), jumps.end());
      for (std::size_t i = 0, n = jumps.size(); i < n; ++i)
        if (const Ps level = flows_work(group, jumps[i]); level > group.at_once)
          if (const Ps bend = scaled_up(level - group.at_once, group.link_octet, octet_time_); bend <= end)
            jumps.push_back(bend);
    }
    lengths.insert(lengths.end(), jumps.begin(), jumps.end());
    if (lengths.size() > most) return {};
  }
  std::sort(lengths.begin(), lengths.end());
  lengths.erase(std::unique(lengths.begin(), lengths.end()), lengths.end());
  return lengths;
}

double ClassDemand::slope_after(Ps length) const {
  double slope = 0;
  for (const Group& group : groups_)
    if (group.link_octet > 0 && link_work(group, length) < flows_work(group, length))
      slope += static_cast<double>(octet_time_) / static_cast<double>(group.link_octet);
  return slope;
}

}  // namespace takt::analysis
