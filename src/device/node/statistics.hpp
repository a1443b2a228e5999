// SPDX-License-Identifier: Apache-2.0
// What a node measures of itself and of its peers. Nanoseconds; nothing allocates after set-up.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "handshake/word.hpp"
#include "json/type.hpp"
#include "sim/time.hpp"

namespace takt::node {

/// Count, extremes and mean exactly; percentiles to 1/8 of their value.
class Distribution {
 public:
  void add(std::int64_t ns);
  std::uint64_t count() const { return count_; }
  std::int64_t least() const { return count_ == 0 ? 0 : least_; }
  std::int64_t greatest() const { return count_ == 0 ? 0 : greatest_; }
  std::int64_t mean() const { return count_ == 0 ? 0 : sum_ / static_cast<std::int64_t>(count_); }
  /// At least `percent` of the values are at most this.
  std::int64_t percentile(double percent) const;

 private:
  static constexpr std::size_t steps = 8;  // in each power of two
  static std::size_t bucket_of(std::int64_t ns);
  static std::int64_t upper_end_of(std::size_t bucket);

  std::uint64_t count_ = 0;
  std::int64_t sum_ = 0;
  std::int64_t least_ = 0;
  std::int64_t greatest_ = 0;
  std::array<std::uint32_t, 64 * steps> buckets_{};
};

const json::Record& describe(json::Type<Distribution>);

/// How the cycle was kept. A cycle is missed if nothing was published in it. Of those missed at once as many are the
/// code's fault as the thread has used whole cycles of CPU time since it published last; in the others the operating
/// system did not let it run. (A hypervisor that takes the CPU away and does not say so makes the thread look busy.)
struct CycleStatistics {
  Distribution late;  ///< waking up for a cycle, against its instant (earlier by the launch lead, if there is one)
  Distribution cpu;   ///< CPU time of the thread from publishing to publishing
  std::uint64_t missed_by_code = 0;
  std::uint64_t missed_by_system = 0;
};

/// What is known of one peer.
///
/// *Answer*: from a publishing of the own state to the first message of the peer behind it. It is there every cycle and
/// contains the phase between the two. *Round trip*: from publishing a word with a new intent, of which the peer had
/// not spoken, to its first word that holds it or a greater one. It contains the peer's wait for its own cycle. `paper`
/// has no intents and no round trips.
struct PeerStatistics {
  std::optional<handshake::PublishedState> state;  ///< nothing: not heard yet
  std::uint32_t incarnation = 0;
  sim::LocalTime last_heard;
  Distribution answer;
  Distribution round_trip;
};

/// Measures answers and round trips.
class PeerWatch {
 public:
  explicit PeerWatch(std::size_t peers) : peers_(peers), marks_(peers) {}

  /// The own word has been published.
  void published(const handshake::Word& word, sim::LocalTime now);
  void heard(std::size_t peer, const handshake::Word& word, sim::LocalTime now);
  /// Another one is this peer from now on, and has not been heard. What was measured stays.
  void forget(std::size_t peer);

  const std::vector<PeerStatistics>& peers() const { return peers_; }

 private:
  struct Marks {
    std::optional<sim::LocalTime> published;  ///< not answered yet
    std::optional<sim::LocalTime> intended;   ///< when `intent_` was published; not known to the peer yet
    handshake::Intent known;                  ///< the greatest that the peer has spoken of
  };
  std::vector<PeerStatistics> peers_;
  std::vector<Marks> marks_;
  handshake::Intent intent_;
};

}  // namespace takt::node
