// SPDX-License-Identifier: Apache-2.0
// Criteria 1 and 2 as measured on a real operating system, to stand beside the published and the simulated ones.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "papers/coexistence/published.hpp"

namespace takt::papers::coexistence {

/// The receiving nodes of Fig. 4.
struct Receiver {
  std::string_view protocol;
  std::string_view node;
};
inline constexpr std::array<Receiver, 4> receivers = {
    {{"DDS", "control"}, {"DDS", "diagnose"}, {"OPC UA", "control"}, {"OPC UA", "diagnose"}}};

/// In per cent, by column of the tables; nothing where it was not measured.
using MeasuredRow = std::array<std::optional<double>, 4>;
struct MeasuredCriteria {
  std::string machine;                                      ///< what it was measured on
  std::array<MeasuredRow, tables.size()> success = {};      ///< criterion 1, by table
  std::array<MeasuredRow, receivers.size()> buffered = {};  ///< criterion 2, by receiving node
};

struct Reproduction;
/// Puts them beside what was published and simulated. Nothing is judged by them: this machine is not the paper's.
void add_measured(const MeasuredCriteria& measured, Reproduction& made);

}  // namespace takt::papers::coexistence
