// SPDX-License-Identifier: Apache-2.0
// A value for each port of a topology: found by node and number at once, where maps of a large plant would take most of
// the time.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "scenario/topology/topology.hpp"
#include "sim/check.hpp"

namespace takt::scenario {

template <class T>
class PortTable {
 public:
  explicit PortTable(const Topology& topology) {
    first_.reserve(topology.neighbours.size() + 1);
    std::size_t count = 0;
    for (const std::vector<Neighbour>& neighbours : topology.neighbours) {
      first_.push_back(count);
      std::uint16_t end = 0;
      for (const Neighbour& neighbour : neighbours) end = std::max(end, static_cast<std::uint16_t>(neighbour.port + 1));
      count += end;
    }
    first_.push_back(count);
    values_.resize(count);
  }

  /// Of a port that a link ends at.
  T& at(std::uint32_t node, std::uint16_t port) { return values_[place(node, port)]; }
  const T& at(std::uint32_t node, std::uint16_t port) const { return values_[place(node, port)]; }

  /// By node and number; also those between that have no link, which hold what T() is.
  const std::vector<T>& values() const { return values_; }

 private:
  std::size_t place(std::uint32_t node, std::uint16_t port) const {
    const std::size_t place = first_[node] + port;
    TAKT_CHECK(place < first_[node + std::size_t{1}], "a link ends at the port");
    return place;
  }

  std::vector<std::size_t> first_;  // of each node, and the end
  std::vector<T> values_;
};

}  // namespace takt::scenario
