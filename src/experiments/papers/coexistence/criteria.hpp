// SPDX-License-Identifier: Apache-2.0
// Case study 1: Tables 1 to 8 and Fig. 4.
#pragma once

#include "papers/coexistence/coexistence.hpp"

namespace takt::papers::coexistence {

/// False if a scenario cannot be read.
bool reproduce_criteria(const Options& options, Reproduction& made, json::Diagnostics& diagnostics);

/// The thread that a table is about: "dds-control", "subscribe".
const ThreadFigures& thread_of(const RunFigures& run, const PublishedTable& table);
/// The subscribing thread of a receiving node.
const ThreadFigures& thread_of(const RunFigures& run, const Receiver& receiver);

}  // namespace takt::papers::coexistence
