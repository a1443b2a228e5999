// SPDX-License-Identifier: Apache-2.0
// A published figure beside takt's, and whether takt meets it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "papers/validation/measure.hpp"

namespace takt::papers::validation {

enum class Agreement {
  met,
  calibrated,     ///< met, but the scenario was fitted to it
  differs,        ///< not met, as the table says, with a reason
  met_after_all,  ///< the table says that it differs, but it is met
  missed,
};
std::string_view name_of(Agreement verdict);

struct Judged {
  std::size_t source = 0;
  std::string what;
  std::string row;
  std::string kind;
  std::string unit;
  std::string published;   ///< as it is published
  std::string takt;        ///< by the source's conventions; or why there is none
  std::string rule;        ///< "equal", "within 1 %", "at least", ...
  std::string difference;  ///< takt's less the published figure
  std::optional<double> published_value;
  std::optional<double> takt_value;
  Agreement verdict = Agreement::missed;
  std::string why;
};

std::vector<Judged> judge(const Entries& entries, const std::vector<Measured>& measured);

}  // namespace takt::papers::validation
