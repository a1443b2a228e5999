// SPDX-License-Identifier: Apache-2.0
// The paper's next steps: what real-time Linux and TSN change.
#pragma once

#include "papers/coexistence/coexistence.hpp"

namespace takt::papers::coexistence {

/// False if a scenario cannot be read.
bool improve(const Options& options, Reproduction& made, json::Diagnostics& diagnostics);

}  // namespace takt::papers::coexistence
