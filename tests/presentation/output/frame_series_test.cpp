// SPDX-License-Identifier: Apache-2.0
// What became of each frame, row by row.
#include "output/frame_series.hpp"

#include "recording.hpp"

namespace takt::output {
namespace {

using namespace test;

// Three frames of 64 octets at once at 1 Gb/s, room for one: the first has come after 576 ns, the second starts 672 ns
// after it and is under way at 1 us, the third finds no room.
TEST(FrameSeries, DeliveredDroppedAndUnderWay) {
  const Folder folder;
  PlanBuilder builder;
  models::PortConfig config;
  config.queue_limits.fill({1, UINT32_MAX});
  const models::NodeIndex a = builder.host("a, \"left\"");
  const models::NodeIndex b = builder.host("b");
  builder.plan.nodes[a.value].port_config = builder.port_config(config);
  builder.link(a, b, 1_Gbps, 0_ns);
  const models::StreamIndex stream = builder.stream(a, {b});
  builder.plan.streams[stream.value].name = "s";
  builder.send_at(stream, 8_B, {0_ns, 0_ns, 0_ns});
  const std::string path = folder / "frames.csv";
  NetworkRun run(builder.plan);
  FrameSeries series(*run.network, path);
  run.simulation.set_trace(&series);
  run.until(1_us);
  run.simulation.set_trace(nullptr);
  EXPECT_EQ(series.close(), "");
  EXPECT_EQ(content_of(path),
            "stream,sequence,event,node,port,produced_ps,at_ps,latency_ps,reason\n"
            "s,2,dropped,\"a, \"\"left\"\"\",0,0,0,,queue_frames\n"
            "s,0,delivered,b,,0,576000,576000,\n"
            "s,1,under way,,,0,,,\n");
}

// Everything that is counted has a row: of each stream as many deliveries and drops as its account says.
TEST(FrameSeries, AgreesWithTheAccounts) {
  const Folder folder;
  const Plant plant;
  const std::string path = folder / "frames.csv";
  NetworkRun run(plant.plan);
  plant.install_axes(*run.network);
  FrameSeries series(*run.network, path);
  run.simulation.set_trace(&series);
  run.until(600_us);
  run.simulation.set_trace(nullptr);
  ASSERT_EQ(series.close(), "");
  std::map<std::string, std::map<std::string, std::uint64_t>> rows;
  std::istringstream lines(content_of(path));
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line)) {
    std::istringstream fields(line);
    std::string name, sequence, event;
    std::getline(std::getline(std::getline(fields, name, ','), sequence, ','), event, ',');
    ++rows[name][event];
  }
  std::uint64_t dropped = 0;
  for (const models::Stream& stream : run.network->traffic().streams()) {
    EXPECT_EQ(rows[stream.name]["delivered"], stream.delivered) << stream.name;
    EXPECT_EQ(rows[stream.name]["dropped"], stream.dropped_in_all()) << stream.name;
    EXPECT_EQ(rows[stream.name]["under way"], stream.in_flight()) << stream.name;
    dropped += stream.dropped_in_all();
  }
  EXPECT_GT(dropped, 0u);
}

TEST(FrameSeries, AFileThatCannotBeWritten) {
  const Plant plant;
  NetworkRun run(plant.plan);
  FrameSeries series(*run.network, "/nowhere/frames.csv");
  EXPECT_NE(series.close(), "");
}

}  // namespace
}  // namespace takt::output
