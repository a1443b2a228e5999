// SPDX-License-Identifier: Apache-2.0
// A square wave has its edges where its times say.
#include "chart/square_wave.hpp"

#include <gtest/gtest.h>

namespace takt::chart {
namespace {

// Ten divisions of 1 ms over 800 pixels from 90 on: 80 pixels each. Low lies 85 below the top of the screen at 40, high
// 60 above that.
TEST(SquareWaves, EdgesStandAtTheirTimes) {
  SquareWaves waves;
  waves.division = 1;
  waves.traces = {{"out", {{-5, true}, {-1, false}, {2, true}, {4.5, false}, {12, true}}}};
  const std::string drawn = draw(waves);
  EXPECT_NE(drawn.find("points=\"90,125 250,125 250,65 450,65 450,125 890,125 \""), std::string::npos) << drawn;
}

TEST(SquareWaves, WhatDoesNotChangeIsNoEdge) {
  SquareWaves waves;
  waves.traces = {{"out", {{2, true}, {3, true}}}};
  EXPECT_NE(draw(waves).find("points=\"90,125 250,125 250,65 890,65 \""), std::string::npos);
}

TEST(SquareWaves, ATraceWithoutEdgesIsLow) {
  SquareWaves waves;
  waves.traces = {{"out", {}}};
  EXPECT_NE(draw(waves).find("points=\"90,125 890,125 \""), std::string::npos);
}

}  // namespace
}  // namespace takt::chart
