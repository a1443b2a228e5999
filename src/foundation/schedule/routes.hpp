// SPDX-License-Identifier: Apache-2.0
// Ways through the network: the prescribed one, the shortest, and others.
#pragma once

#include <optional>
#include <vector>

#include "schedule/way.hpp"
#include "sim/random.hpp"

namespace takt::schedule {

enum class RouteChoice : std::uint8_t { shortest, search };

class Routes {
 public:
  explicit Routes(const Timing& timing);

  /// The prescribed way, or a shortest one; of several as short the one whose links are loaded least by the ways that
  /// were asked for before. Nothing if there is none that keeps the latency.
  std::optional<Way> first(StreamIndex stream);
  /// Up to `most` different ways, the first one first; the others avoid what was taken before, at random. Prescribed
  /// ways stay alone.
  std::vector<Way> several(StreamIndex stream, const Way& first, std::size_t most, sim::RandomStream& random) const;
  /// Takes no way over these links from now on (they have failed); prescribed ways over them are none.
  void close(LinkIndex link);

 private:
  std::optional<std::vector<LinkIndex>> shortest_by_steps(const Stream& stream);
  std::optional<std::vector<LinkIndex>> tree(const Stream& stream, const std::vector<double>& cost,
                                             double latency_share, const std::vector<NodeIndex>& order) const;
  const std::vector<std::uint16_t>& steps_to(NodeIndex node);
  void note_load(const Stream& stream, const std::vector<LinkIndex>& links);
  std::vector<double> cost_of(const Stream& stream) const;

  const Timing* timing_;
  const Problem* problem_;
  bool is_uniform_ = true;                       ///< each link takes as long as any other
  std::vector<std::vector<LinkIndex>> leaving_;  ///< by node
  std::vector<std::vector<LinkIndex>> coming_;
  std::vector<std::uint8_t> is_closed_;               ///< by link
  std::vector<double> load_;                          ///< by link, of ways that were asked for
  std::vector<std::vector<std::uint16_t>> steps_to_;  ///< by node: how many links from each node; empty: not asked yet
};

}  // namespace takt::schedule
