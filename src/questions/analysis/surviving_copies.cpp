// SPDX-License-Identifier: Apache-2.0
#include "analysis/surviving_copies.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace takt::analysis {
namespace {

constexpr std::size_t most_ways = 64;

/// The hops of one copy, the last first.
using Way = std::vector<std::uint32_t>;

/// All ways that end with this hop; false if they are too many to look at.
bool find_ways(const FlowGraph& graph, Way& way, std::vector<Way>& found) {
  const std::vector<std::uint32_t>& parents = graph.hops[way.back()].parents;
  if (parents.empty()) {
    found.push_back(way);
    return found.size() <= most_ways;
  }
  for (const std::uint32_t parent : parents) {
    way.push_back(parent);
    const bool is_fine = find_ways(graph, way, found);
    way.pop_back();
    if (!is_fine) return false;
  }
  return true;
}

/// What a way suffers: something that may always lose frames, or times in which it is cut.
struct Trouble {
  std::string always;
  std::vector<Outage> times;
  std::string example;  ///< of the times
};

class Copies {
 public:
  Copies(const scenario::Resolved& resolved, const FlowGraph& graph, const scenario::ResolvedRedundancy& redundancy,
         const Outages& outages, const LossAtHop& loss_at)
      : r_(resolved), graph_(graph), outages_(outages), loss_at_(loss_at), deaf_(deafness_of(redundancy)) {}

  /// By whichever ways it comes; `longest`: that a copy is under way.
  std::string why_lost(const Flow& flow, const std::vector<std::uint32_t>& last_hops, sim::Duration longest) const {
    std::vector<Way> ways;
    for (const std::uint32_t last : last_hops) {
      if (flow.beyond.contains(last)) continue;
      Way way{last};
      if (!find_ways(graph_, way, ways)) return "its copies take too many ways";
    }
    // A way over a relay is there only while a station is down.
    std::erase_if(ways, [&](const Way& way) {
      return std::ranges::any_of(way, [&](std::uint32_t h) { return graph_.hops[h].beyond > 0; });
    });
    if (ways.empty()) return "it comes over the relays of stations that are down alone";
    std::vector<Trouble> troubles;
    for (const Way& way : ways) troubles.push_back(trouble_of(way));
    // All ways are cut together at some instant only if they are where one of the times begins.
    std::vector<sim::TrueTime> instants{sim::TrueTime()};
    for (const Trouble& trouble : troubles)
      for (const Outage& outage : trouble.times) instants.push_back(begin_of(outage, longest));
    for (const sim::TrueTime instant : instants) {
      const auto is_lost = [&](const Trouble& trouble) {
        return !trouble.always.empty() || std::ranges::any_of(trouble.times, [&](const Outage& outage) {
          return begin_of(outage, longest) <= instant && instant <= outage.up;
        });
      };
      if (std::ranges::all_of(troubles, is_lost)) return reason(troubles);
    }
    return {};
  }

 private:
  /// A frame that is produced then may still be under way when the outage begins.
  static sim::TrueTime begin_of(const Outage& outage, sim::Duration longest) {
    return outage.down.since_start() > longest ? outage.down - longest : sim::TrueTime();
  }

  /// A relay of a ladder to which nothing has come for a while takes the numbers that come then for wrong, if they are
  /// further ahead than its history, until its reset timer expires (IEEE 802.1CB 7.4.3.4): for so long what leads to it
  /// is no way. Where nodes have clocks of their own it is not said how long that is.
  sim::Duration deafness_of(const scenario::ResolvedRedundancy& redundancy) const {
    const auto has_clock = [&](const scenario::ResolvedRedundancy::Relay& relay) {
      return r_.plan.nodes[relay.node].clock.has_value();
    };
    if (!redundancy.is_ladder()) return {};
    return std::ranges::any_of(redundancy.relays, has_clock) ? sim::Duration::max()
                                                             : redundancy.description->reset_timeout;
  }

  Trouble trouble_of(const Way& way) const {
    Trouble trouble;
    for (const std::uint32_t h : way) {
      const Hop& hop = graph_.hops[h];
      if (trouble.always.empty()) trouble.always = loss_at_(hop);
      const GraphPort& port = graph_.ports[hop.port];
      for (const Outage& outage : outages_.of_link(port.link)) {
        trouble.times.push_back({outage.down, outage.up.plus_saturated(deaf_)});
        if (trouble.example.empty())
          trouble.example =
              "the link of " + r_.plan.nodes[port.node.value].name + ":" + std::to_string(port.number) + " goes down";
      }
    }
    return trouble;
  }

  static std::string reason(const std::vector<Trouble>& troubles) {
    for (const Trouble& trouble : troubles)
      if (!trouble.always.empty()) return "on every way: " + trouble.always;
    return "on every way at a time: " + troubles.front().example;
  }

  const scenario::Resolved& r_;
  const FlowGraph& graph_;
  const Outages& outages_;
  const LossAtHop& loss_at_;
  sim::Duration deaf_;
};

/// Whether the copies of one way are taken for what comes next where those of another end, and the other way round.
bool fits_history(const Flow& flow, const scenario::Redundancy& description, sim::Duration lead) {
  if (description.algorithm == scenario::Recovery::match) return true;  // it discards equal numbers only
  return flow.source.is_limited() && flow.source.count(lead.ps()) < static_cast<std::int64_t>(description.history);
}

}  // namespace

std::string why_copies_may_be_lost(const scenario::Resolved& resolved, const FlowGraph& graph, const Flow& flow,
                                   const scenario::ResolvedRedundancy& redundancy, const StreamBound& bound,
                                   const Outages& outages, const LossAtHop& loss_at) {
  const Copies copies(resolved, graph, redundancy, outages, loss_at);
  for (std::size_t l = 0; l < flow.last.size(); ++l) {
    if (!bound.by_listener[l]) return bound.reason.empty() ? "its latency has no bound" : bound.reason;
    if (std::string why = copies.why_lost(flow, flow.last[l], *bound.by_listener[l]); !why.empty()) return why;
    if (!outages.any()) continue;
    if (redundancy.description->individual)
      return "individual recovery takes what comes after an outage for out of order";
    if (!fits_history(flow, *redundancy.description, *bound.by_listener[l] - bound.least))
      return "copies of one way may be further ahead of those of another than the recovery's history";
  }
  return {};
}

}  // namespace takt::analysis
