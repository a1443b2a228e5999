// SPDX-License-Identifier: Apache-2.0
// From figures to the pictures of the paper.
#pragma once

#include <string>

#include "papers/coexistence/coexistence.hpp"

namespace takt::papers::coexistence {

/// Criterion 1: bars are simulated, lines across them published.
std::string success_chart(const Reproduction& made);
/// Fig. 4: bars are criterion 2, lines across them criterion 1.
std::string buffering_chart(const Reproduction& made);
/// Fig. 5 to 9: twenty periods on an oscilloscope, the ideal signal below.
std::string signal_chart(const RunFigures& run, const SignalRow& row, int figure);

}  // namespace takt::papers::coexistence
