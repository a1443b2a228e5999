// SPDX-License-Identifier: Apache-2.0
// Configuration that cannot act in its scenario: what a user has written for nothing is told, with the reason.
// Warnings, since nothing is wrong with it but that it is in vain.
#pragma once

#include "scenario/resolved/resolved.hpp"

namespace takt::scenario {

/// To be called with a sound scenario: what follows from mistakes is not told.
void report_ineffective(const Resolved& resolved, json::Diagnostics& diagnostics);

}  // namespace takt::scenario
