// SPDX-License-Identifier: Apache-2.0
// In which order the points of a study run.
#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>

namespace takt::study {

/// Points in an order in which every beginning is spread over all of them, so that what an interrupted study has is a
/// sample: steps of the golden section, which meet each point once.
class SpreadOrder {
 public:
  /// At least one point, at most 10 million (most_points).
  explicit SpreadOrder(std::uint64_t points) : points_(points), step_(std::max<std::uint64_t>(1, points * 618 / 1000)) {
    while (std::gcd(step_, points_) > 1) ++step_;
  }
  std::uint64_t operator[](std::uint64_t position) const { return position * step_ % points_; }

 private:
  std::uint64_t points_;
  std::uint64_t step_;
};

}  // namespace takt::study
