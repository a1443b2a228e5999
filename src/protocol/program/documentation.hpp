// SPDX-License-Identifier: Apache-2.0
// The state machine as text and as a graph, printed from the table that the code runs on.
#pragma once

#include <string>

namespace takt::program {

/// States, transitions and methods as aligned text, with a line end after each line.
std::string table_text();
/// The same as a graph for Graphviz; Init is written into Halted, transitions that no method causes are dashed.
std::string table_dot();

}  // namespace takt::program
