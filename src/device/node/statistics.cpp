// SPDX-License-Identifier: Apache-2.0
#include "node/statistics.hpp"

#include <algorithm>
#include <bit>

#include "json/record.hpp"

namespace takt::node {
namespace {
std::int64_t ns_between(sim::LocalTime from, sim::LocalTime to) { return (to - from).ps() / 1000; }

/// Whoever knows `known` has followed this intent, or a later one.
bool has_reached(const handshake::Intent& known, const handshake::Intent& intent) {
  const handshake::Standing standing = handshake::standing_of(known, intent);
  return standing == handshake::Standing::same || standing == handshake::Standing::later;
}

std::int64_t p99(const Distribution& distribution) { return distribution.percentile(99); }

}  // namespace

/// Values below `steps` have buckets of their own; above, each power of two is cut into `steps`.
std::size_t Distribution::bucket_of(std::int64_t ns) {
  const auto value = static_cast<std::uint64_t>(std::max<std::int64_t>(ns, 0));
  if (value < steps) return value;
  const auto power = static_cast<std::size_t>(std::bit_width(value) - 1);
  return (power - 2) * steps + ((value >> (power - 3)) & (steps - 1));
}

std::int64_t Distribution::upper_end_of(std::size_t bucket) {
  if (bucket < steps) return static_cast<std::int64_t>(bucket);
  const std::size_t power = bucket / steps + 2;
  const std::uint64_t lower = (steps + bucket % steps) << (power - 3);
  return static_cast<std::int64_t>(lower + (std::uint64_t{1} << (power - 3)) - 1);
}

void Distribution::add(std::int64_t ns) {
  least_ = count_ == 0 ? ns : std::min(least_, ns);
  greatest_ = count_ == 0 ? ns : std::max(greatest_, ns);
  ++count_;
  sum_ += ns;
  ++buckets_[bucket_of(ns)];
}

std::int64_t Distribution::percentile(double percent) const {
  const double wanted = static_cast<double>(count_) * percent / 100;
  double below = 0;
  for (std::size_t bucket = 0; bucket < buckets_.size(); ++bucket) {
    below += buckets_[bucket];
    if (below >= wanted && below > 0) return std::clamp(upper_end_of(bucket), least(), greatest());
  }
  return greatest();
}

const json::Record& describe(json::Type<Distribution>) {
  static constexpr json::Output outputs[] = {
      json::output<&Distribution::count>("count", "How many."),
      json::output<&Distribution::least>("min_ns", "The least; 0 of none.", {.unit = "ns"}),
      json::output<&Distribution::mean>("mean_ns", "The mean; 0 of none.", {.unit = "ns"}),
      json::output<&p99>("p99_ns", "The 99th percentile, to an eighth of its value.", {.unit = "ns"}),
      json::output<&Distribution::greatest>("max_ns", "The greatest; 0 of none.", {.unit = "ns"}),
  };
  static constexpr json::Record record{"distribution", "Times that were measured.", outputs};
  return record;
}

void PeerWatch::published(const handshake::Word& word, sim::LocalTime now) {
  const bool is_new = word.intent != intent_;
  if (is_new) intent_ = word.intent;
  for (Marks& marks : marks_) {
    if (!marks.published) marks.published = now;
    if (is_new && !has_reached(marks.known, intent_)) marks.intended = now;
  }
}

void PeerWatch::heard(std::size_t peer, const handshake::Word& word, sim::LocalTime now) {
  PeerStatistics& statistics = peers_[peer];
  Marks& marks = marks_[peer];
  statistics.state = word.state;
  statistics.incarnation = word.incarnation;
  statistics.last_heard = now;
  marks.known = word.intent;
  if (marks.published) statistics.answer.add(ns_between(*marks.published, now));
  marks.published.reset();
  if (!marks.intended || !has_reached(word.intent, intent_)) return;
  statistics.round_trip.add(ns_between(*marks.intended, now));
  marks.intended.reset();
}

void PeerWatch::forget(std::size_t peer) {
  peers_[peer].state.reset();
  peers_[peer].incarnation = 0;
  marks_[peer] = {};
}

}  // namespace takt::node
