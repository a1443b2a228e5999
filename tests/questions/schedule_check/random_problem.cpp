// SPDX-License-Identifier: Apache-2.0
#include "random_problem.hpp"

#include <map>
#include <utility>
#include <vector>

#include "scenario/gates/layout.hpp"
#include "sim/random.hpp"

namespace takt::schedule_check {
namespace {

using scenario::GateProblem;
using scenario::ScheduledHop;
using scenario::ScheduledStream;
using sim::Duration;

class Maker {
 public:
  explicit Maker(std::uint64_t seed) : chance_(seed, "problem", "test") {}

  GateProblem make() {
    const std::uint64_t switches = 1 + chance_.below(5);
    // Nodes 0 .. switches-1, then two hosts at each; the parent of a host is its switch.
    parent_.push_back(0);
    for (std::uint64_t i = 1; i < switches; ++i) parent_.push_back(chance_.below(i));
    for (std::uint64_t i = 0; i < 2 * switches; ++i) parent_.push_back(i / 2);
    const std::int64_t octets[] = {80'000, 8'000, 800};  // ps: 100 Mb/s, 1 Gb/s, 10 Gb/s
    for (std::size_t i = 0; i < parent_.size(); ++i) octet_.push_back(octets[chance_.below(3)]);
    const std::int64_t margins[] = {0, 50'000, 333, 1'000'000};
    problem_.margin = Duration::from_ps(margins[chance_.below(4)]);
    const std::uint64_t streams = 1 + chance_.below(10);
    for (std::uint64_t i = 0; i < streams; ++i) add_stream(switches);
    return std::move(problem_);
  }

 private:
  std::vector<std::size_t> up(std::size_t node) const {
    std::vector<std::size_t> way = {node};
    while (node != 0) way.push_back(node = parent_[node]);
    return way;
  }
  std::vector<std::size_t> path(std::size_t from, std::size_t to) const {
    std::vector<std::size_t> a = up(from);
    std::vector<std::size_t> b = up(to);
    while (a.size() > 1 && b.size() > 1 && a[a.size() - 2] == b[b.size() - 2]) a.pop_back(), b.pop_back();
    b.pop_back();
    a.insert(a.end(), b.rbegin(), b.rend());
    return a;
  }

  std::uint32_t port(std::size_t from, std::size_t to, std::int64_t octet) {
    const auto [found, is_new] = ports_.emplace(std::pair(from, to), static_cast<std::uint32_t>(problem_.ports.size()));
    if (is_new) {
      const Duration gap = Duration::from_ps(12 * octet);
      const bool is_long = chance_.below(3) == 0;
      problem_.ports.push_back({models::NodeIndex{static_cast<std::uint32_t>(from)}, static_cast<std::uint16_t>(to),
                                std::to_string(from) + " to " + std::to_string(to), gap,
                                is_long ? Duration::from_ps(1542 * octet) : gap});
    }
    return found->second;
  }

  void add_stream(std::size_t switches) {
    const std::int64_t periods[] = {100, 200, 250, 400, 500, 1'000};  // us
    const std::size_t hosts = 2 * switches;
    ScheduledStream stream;
    stream.name = "s" + std::to_string(problem_.streams.size());
    std::size_t talker = switches + chance_.below(hosts);
    stream.period = Duration::from_ps(periods[chance_.below(6)] * 1'000'000);
    stream.release = Duration::from_ps(static_cast<std::int64_t>(chance_.below(2'000'000'000)));
    if (chance_.below(4) == 0) stream.early = Duration::from_ps(static_cast<std::int64_t>(chance_.below(5'000'000)));
    stream.train = static_cast<std::uint32_t>(problem_.streams.size());
    if (!problem_.streams.empty() && chance_.below(3) == 0) {
      const ScheduledStream& former = problem_.streams.back();
      talker = talker_;
      stream.period = former.period;
      stream.release = former.release;
      stream.early = former.early;
      stream.train = former.train;
    }
    talker_ = talker;
    const std::int64_t frame = 72 + static_cast<std::int64_t>(chance_.below(1'458));
    const auto q = static_cast<models::TrafficClass>(5 + chance_.below(2));
    std::map<std::pair<std::size_t, std::size_t>, std::uint32_t> known;
    for (std::uint64_t listeners = 1 + chance_.below(3); listeners > 0; --listeners) {
      std::size_t to = switches + chance_.below(hosts);
      if (to == talker) to = to + 1 < switches + hosts ? to + 1 : switches;
      const std::vector<std::size_t> way = path(talker, to);
      for (std::size_t i = 0; i + 1 < way.size(); ++i) {
        if (!known.emplace(std::pair(way[i], way[i + 1]), static_cast<std::uint32_t>(stream.hops.size())).second)
          continue;
        const std::int64_t octet = octet_[parent_[way[i]] == way[i + 1] && way[i] != 0 ? way[i] : way[i + 1]];
        ScheduledHop hop;
        hop.port = port(way[i], way[i + 1], octet);
        if (i > 0) hop.previous = known.at({way[i - 1], way[i]});
        hop.traffic_class = q;
        hop.transmission = Duration::from_ps(frame * octet);
        hop.behind = Duration::from_ps(static_cast<std::int64_t>(50'000 + (way[i + 1] < switches ? 1'000'001 : 0)));
        stream.hops.push_back(hop);
      }
    }
    problem_.streams.push_back(std::move(stream));
  }

  sim::RandomStream chance_;
  std::vector<std::size_t> parent_;
  std::vector<std::int64_t> octet_;  // of the link from a node to its parent
  std::map<std::pair<std::size_t, std::size_t>, std::uint32_t> ports_;
  std::size_t talker_ = 0;
  GateProblem problem_;
};

}  // namespace

GateProblem random_problem(std::uint64_t seed) { return Maker(seed).make(); }

GateProblem random_problem_that_fits(std::uint64_t seed) {
  const GateProblem whole = random_problem(seed);
  GateProblem fits{whole.margin, whole.ports, {}};
  for (const ScheduledStream& stream : whole.streams) {
    fits.streams.push_back(stream);
    if (!scenario::lay_out_gates(fits).conflicts.empty()) fits.streams.pop_back();
  }
  // One alone fits unless it is longer than its period.
  return fits.streams.empty() ? random_problem_that_fits(seed + 1) : fits;
}

}  // namespace takt::schedule_check
