// SPDX-License-Identifier: Apache-2.0
// Where the time of each frame went, row by row.
#include "output/hop_series.hpp"

#include "recording.hpp"

namespace takt::output {
namespace {

using namespace test;

struct Recorded {
  explicit Recorded(NetworkRun& run, const Selection& selection, const std::string& path)
      : series(*run.network, selection, path), recorder(*run.network, series) {
    run.simulation.set_trace(&recorder);
    run.network->trace_paths();
  }
  HopSeries series;
  explain::WayRecorder recorder;
};

/// The number in that column of the row.
std::int64_t column(const std::string& line, std::size_t number) {
  std::istringstream fields(line);
  std::string field;
  for (std::size_t i = 0; i <= number; ++i) std::getline(fields, field, ',');
  return field.empty() ? -1 : std::stoll(field);
}

// Two frames of 64 octets of priority 0, class 1 of eight, at once at 1 Gb/s over a cable of 100 ns: the first has come
// after (8 + 64) * 8 + 100 ns = 676 ns, the second waits for (8 + 64 + 12) * 8 ns = 672 ns before.
TEST(HopSeries, AFrameThatWaitsForAnother) {
  const Folder folder;
  PlanBuilder builder;
  const models::NodeIndex a = builder.host("a");
  const models::NodeIndex b = builder.host("b");
  builder.link(a, b, 1_Gbps, 100_ns);
  const models::StreamIndex stream = builder.stream(a, {b});
  builder.plan.streams[stream.value].name = "s";
  builder.send_at(stream, 8_B, {0_ns, 0_ns});
  NetworkRun run(builder.plan);
  const Selection all;
  const std::string path = folder / "hops.csv";
  Recorded recorded(run, all, path);
  run.until(10_us);
  recorded.recorder.finish(run.simulation.now());
  ASSERT_EQ(recorded.series.close(), "");
  std::istringstream lines(content_of(path));
  std::string head, first, second, more;
  std::getline(lines, head);
  std::getline(lines, first);
  std::getline(lines, second);
  EXPECT_FALSE(std::getline(lines, more));
  EXPECT_EQ(head,
            "stream,sequence,node,port,to,class,produced_ps,came_ps,started_ps,octets,cuts,os_transmit_ps,processor_ps,"
            "launch_time_ps,ats_ps,higher_class_ps,precedence_ps,own_class_ps,lower_class_ps,gate_closed_ps,"
            "guard_ps,credit_ps,hold_ps,preemption_ps,transmission_ps,cable_ps,forwarding_ps,jitter_ps,os_receive_ps");
  EXPECT_EQ(first, "s,0,a,0,b,1,0,0,0,64,0,0,0,0,0,0,0,0,0,0,0,0,0,0,576000,100000,0,0,0");
  EXPECT_EQ(second, "s,1,a,0,b,1,0,0,672000,64,0,0,0,0,0,0,0,672000,0,0,0,0,0,0,576000,100000,0,0,0");
}

TEST(HopSeries, OnlyWhatIsSelected) {
  const Folder folder;
  const Plant plant;
  NetworkRun run(plant.plan);
  plant.install_axes(*run.network);
  Selection selection;
  selection.from = sim::TrueTime() + 100_us;
  selection.to = sim::TrueTime() + 400_us;
  selection.streams.resize(plant.camera.value + 1);
  selection.streams[plant.camera.value] = true;
  const std::string path = folder / "hops.csv";
  Recorded recorded(run, selection, path);
  run.until(600_us);
  recorded.recorder.finish(run.simulation.now());
  ASSERT_EQ(recorded.series.close(), "");
  std::istringstream lines(content_of(path));
  std::string line;
  std::getline(lines, line);
  std::size_t rows = 0;
  while (std::getline(lines, line)) {
    ++rows;
    EXPECT_TRUE(line.starts_with(run.stream(plant.camera).name + ","));
    EXPECT_LE(column(line, 6), 400'000'000);
  }
  EXPECT_GT(rows, 0u);
}

}  // namespace
}  // namespace takt::output
