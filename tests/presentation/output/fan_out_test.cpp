// SPDX-License-Identifier: Apache-2.0
#include "output/fan_out.hpp"

#include <gtest/gtest.h>

#include "output/pcap_recorder.hpp"
#include "output/timeline_recorder.hpp"
#include "output/vcd_recorder.hpp"
#include "tests/presentation/output/recording.hpp"

namespace takt::output {
namespace {

using namespace test;

TEST(FanOut, EachSinkSeesEachRecord) {
  Plant plant;
  NetworkRun run(plant.plan);
  FanOut fan_out;
  EXPECT_TRUE(fan_out.empty());
  TraceLog one, two;
  fan_out.add(one);
  fan_out.add(two);
  run.simulation.set_trace(&fan_out);
  run.until(2_ms);
  ASSERT_GT(one.records.size(), 10u);
  ASSERT_EQ(one.records.size(), two.records.size());
  for (std::size_t i = 0; i < one.records.size(); ++i) EXPECT_EQ(one.records[i].what, two.records[i].what);
}

// All recorders at once, and the run is the one without any.
TEST(FanOut, AllRecordersChangeNothing) {
  Folder folder;
  Plant plant;
  NetworkRun plain(plant.plan);
  plant.install_axes(*plain.network);
  plain.until(2_ms);

  NetworkRun run(plant.plan);
  plant.install_axes(*run.network);
  PcapRecorder pcap(*run.network);
  ASSERT_EQ(pcap.add(folder / "all.pcapng", {}), "");
  TimelineRecorder timeline(*run.network, folder / "timeline.json");
  VcdRecorder waves(*run.network, folder / "waves.vcd");
  FanOut fan_out;
  for (sim::TraceSink* const sink : std::initializer_list<sim::TraceSink*>{&pcap, &timeline, &waves})
    fan_out.add(*sink);
  run.simulation.set_trace(&fan_out);
  run.until(2_ms);
  EXPECT_EQ(pcap.close(), "");
  EXPECT_EQ(timeline.close(at(2_ms)), "");
  EXPECT_EQ(waves.close(at(2_ms)), "");
  EXPECT_EQ(run.digest(), plain.digest());
  EXPECT_EQ(run.simulation.event_count(), plain.simulation.event_count());
  EXPECT_EQ(run.network->traffic().live_frames(), plain.network->traffic().live_frames());
}

}  // namespace
}  // namespace takt::output
