// SPDX-License-Identifier: Apache-2.0
#include "papers/coexistence/measured.hpp"

#include <fmt/format.h>

#include "papers/coexistence/coexistence.hpp"

namespace takt::papers::coexistence {

void add_measured(const MeasuredCriteria& measured, Reproduction& made) {
  made.machine = measured.machine;
  for (Comparison& comparison : made.comparisons)
    for (std::size_t t = 0; t < tables.size(); ++t)
      for (std::size_t column = 0; column < intervals.size(); ++column)
        if (measured.success[t][column] && comparison.what == cell_name(tables[t], column))
          comparison.measured = fmt::format("{:.1f} %", *measured.success[t][column]);
  for (std::size_t r = 0; r < made.buffering.size() && r < receivers.size(); ++r)
    made.buffering[r].measured = measured.buffered[r];
}

}  // namespace takt::papers::coexistence
