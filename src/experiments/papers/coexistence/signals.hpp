// SPDX-License-Identifier: Apache-2.0
// Case study 2: the digital signal behind the gateway, Fig. 5 to 9.
#pragma once

#include "papers/coexistence/coexistence.hpp"

namespace takt::papers::coexistence {

/// False if a scenario cannot be read.
bool reproduce_signals(const Options& options, Reproduction& made, json::Diagnostics& diagnostics);

}  // namespace takt::papers::coexistence
