// SPDX-License-Identifier: Apache-2.0
#include "schedule/problem.hpp"

#include <numeric>

namespace takt::schedule {

std::optional<Ps> hyperperiod(const Problem& problem) {
  Ps common = 1;
  for (const Stream& stream : problem.streams) {
    const Ps factor = stream.period / std::gcd(common, stream.period);
    if (factor > longest_time / common) return std::nullopt;
    common *= factor;
  }
  return common;
}

}  // namespace takt::schedule
