// SPDX-License-Identifier: Apache-2.0
// The printed table, line by line: what the user reads is what the code does.
#include "program/documentation.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace takt::program::documentation_test {
namespace {

TEST(Documentation, TheTable) {
  EXPECT_EQ(table_text(), R"(States (OPC 10000-10, 5.2.3)
  No.  State       NodeId
  11   Halted      i=2406
  15     .Init     (substate, distributed Programs)
  12   Ready       i=2400
  13   Running     i=2402
  14   Suspended   i=2404

Transitions (OPC 10000-10, 5.2.4)
  No.  Transition          From       To         Caused by          NodeId
  1    HaltedToReady       Halted     Ready      Reset, internal    i=2408
  2    ReadyToRunning      Ready      Running    Start              i=2410
  3    RunningToHalted     Running    Halted     Halt, internal     i=2412
  4    RunningToReady      Running    Ready      internal           i=2414
  5    RunningToSuspended  Running    Suspended  Suspend            i=2416
  6    SuspendedToRunning  Suspended  Running    Resume             i=2418
  7    SuspendedToHalted   Suspended  Halted     Halt               i=2420
  8    SuspendedToReady    Suspended  Ready      Reset, internal    i=2422
  9    ReadyToHalted       Ready      Halted     Halt               i=2424

Methods (OPC 10000-10, 5.2.7): the transition in each state, - where Executable is false
  Method    Halted     Ready      Running    Suspended  NodeId
  Start     -          2          -          -          i=2426
  Suspend   -          -          5          -          i=2427
  Resume    -          -          -          6          i=2428
  Halt      -          9          3          7          i=2429
  Reset     1          -          -          8          i=2430
)");
}

TEST(Documentation, TheGraph) {
  const std::string dot = table_dot();
  EXPECT_TRUE(dot.starts_with("digraph Program {\n"));
  EXPECT_NE(dot.find("Halted [label=\"Halted\\n11\\n(Init 15)\"];"), std::string::npos);
  EXPECT_NE(dot.find("Ready -> Running [label=\"2: Start\"];"), std::string::npos);
  EXPECT_NE(dot.find("Running -> Ready [label=\"4: internal\", style=dashed];"), std::string::npos);
  EXPECT_EQ(std::count(dot.begin(), dot.end(), '>'), 9) << "an edge for each transition";
  EXPECT_TRUE(dot.ends_with("}\n"));
}

}  // namespace
}  // namespace takt::program::documentation_test
