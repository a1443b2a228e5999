// SPDX-License-Identifier: Apache-2.0
#include "papers/coexistence/calibration.hpp"

#include <algorithm>
#include <cmath>

namespace takt::papers::coexistence {

FittedLaw calibrate(Law law, const PublishedTable& table) {
  return fit(law, 1, table.success[at_1_ms] / 100, 5, std::min(table.success[at_5_ms], nearly_all) / 100);
}

double LawErrors::least() const { return *std::min_element(at_10_ms.begin(), at_10_ms.end()); }

std::vector<LawErrors> compare_laws() {
  std::vector<LawErrors> all;
  for (const Law law : laws) {
    LawErrors made;
    made.law = law;
    double squares_2 = 0;
    double squares_10 = 0;
    for (std::size_t i = 0; i < tables.size(); ++i) {
      made.fitted[i] = calibrate(law, tables[i]);
      made.at_2_ms[i] = 100 * made.fitted[i].done_within(2) - tables[i].success[at_2_ms];
      made.at_10_ms[i] = 100 * made.fitted[i].done_within(10);
      made.worst_at_2_ms = std::max(made.worst_at_2_ms, std::abs(made.at_2_ms[i]));
      squares_2 += made.at_2_ms[i] * made.at_2_ms[i];
      squares_10 += std::pow(100 - made.at_10_ms[i], 2);
    }
    made.rms_at_2_ms = std::sqrt(squares_2 / static_cast<double>(tables.size()));
    made.rms_at_10_ms = std::sqrt(squares_10 / static_cast<double>(tables.size()));
    all.push_back(made);
  }
  return all;
}

}  // namespace takt::papers::coexistence
