// SPDX-License-Identifier: Apache-2.0
#include "output/timeline_recorder.hpp"

#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "explain/way_recorder.hpp"
#include "tests/presentation/output/recording.hpp"

namespace takt::output {
namespace {

using namespace test;
using nlohmann::json;

TEST(TimelineRecorder, FramesAreSlicesThatDoNotOverlap) {
  Folder folder;
  Plant plant;
  NetworkRun run(plant.plan);
  plant.install_axes(*run.network);
  TimelineRecorder recorder(*run.network, folder / "timeline.json");
  run.simulation.set_trace(&recorder);
  run.until(2_ms);
  ASSERT_EQ(recorder.close(at(2_ms)), "");

  const json timeline = json::parse(content_of(folder / "timeline.json"));
  EXPECT_EQ(timeline.at("displayTimeUnit"), "ns");
  std::map<std::pair<int, int>, double> free_from;
  std::map<std::string, int> names;
  std::set<std::string> labels;
  for (const json& event : timeline.at("traceEvents")) {
    if (event.at("ph") == "M" && event.at("name") != "process_sort_index") labels.insert(event.at("args").at("name"));
    if (event.at("ph") == "i") ++names["drop " + event.at("args").at("reason").get<std::string>()];
    if (event.at("ph") != "X") continue;
    double& free = free_from[{event.at("pid"), event.at("tid")}];
    EXPECT_GE(event.at("ts").get<double>(), free);
    free = event.at("ts").get<double>() + event.at("dur").get<double>();
    ++names[event.at("name")];
  }
  std::map<models::StreamIndex, int> sent = Plant::sent_by_ports(plant);
  for (const models::StreamIndex stream : {plant.axes, plant.camera, plant.raw, plant.noise})
    EXPECT_EQ(names[run.stream(stream).name], sent[stream]);
  const std::uint64_t dropped = run.stream(plant.camera).dropped_in_all() + run.stream(plant.noise).dropped_in_all();
  EXPECT_GT(dropped, 0u);
  EXPECT_EQ(dropped, static_cast<std::uint64_t>(names["drop queue_frames"]));
  for (const char* const label : {"cell \"A\"", "b", "sw", "port 0 to sw", "port 0 to cell \"A\"", "port 3 to d"})
    EXPECT_TRUE(labels.contains(label)) << label;
}

// 64 octets and the preamble last 5.76 us at 100 Mb/s; the raw frame of 1522 octets 122.4 us.
TEST(TimelineRecorder, TimesAreExact) {
  Folder folder;
  Plant plant;
  NetworkRun run(plant.plan);
  TimelineRecorder recorder(*run.network, folder / "timeline.json");
  run.simulation.set_trace(&recorder);
  run.until(2_ms);
  ASSERT_EQ(recorder.close(at(2_ms)), "");
  const std::string text = content_of(folder / "timeline.json");
  EXPECT_NE(text.find(R"({"ph":"X","pid":5,"tid":1,"ts":10.000000,"dur":122.400000,"name":"stream2",)"
                      R"("args":{"sequence":0,"octets":1522,"priority":6}})"),
            std::string::npos);
}

TEST(TimelineRecorder, StatesAreSlicesOnTracks) {
  Folder folder;
  Plant plant;
  NetworkRun run(plant.plan);
  TimelineRecorder recorder(*run.network, folder / "timeline.json");
  const auto master = recorder.add_state_track("trajectory", "generator\\1\n");
  const auto slave = recorder.add_state_track("trajectory", "robot");
  const auto other = recorder.add_state_track("conveyor", "belt");
  recorder.change_state(master, at(0_us), "Halted");
  recorder.change_state(slave, at(1_ps), "Halted");
  recorder.change_state(master, at(5_us), "Ready");
  recorder.change_state(slave, at(7_us), "");
  EXPECT_THROW(recorder.change_state(slave, at(6_us), "Ready"), sim::InvariantBroken);
  ASSERT_EQ(recorder.close(at(9_us)), "");
  static_cast<void>(other);

  const json timeline = json::parse(content_of(folder / "timeline.json"));
  std::vector<std::string> slices;
  std::set<std::string> labels;
  for (const json& event : timeline.at("traceEvents")) {
    if (event.at("ph") == "X")
      slices.push_back(event.at("name").get<std::string>() + " " + event.at("pid").dump() + "/" +
                       event.at("tid").dump() + " " + event.at("ts").dump() + " " + event.at("dur").dump());
    if (event.at("name") == "thread_name") labels.insert(event.at("args").at("name"));
  }
  EXPECT_EQ(slices, (std::vector<std::string>{"Halted 6/1 0.0 5.0", "Halted 6/2 1e-06 6.999999", "Ready 6/1 5.0 4.0"}));
  EXPECT_TRUE(labels.contains("generator\\1\n"));
}

// a's two frames of 64 octets at 1 Gb/s: the second waits 672 ns for the first (see hop_series_test.cpp), then both
// pass the bridge: an arrow each from a's port to that of sw.
TEST(TimelineRecorder, ArrowsLeadFromHopToHopAndWaitsHaveACause) {
  struct Ways final : explain::WaySink {
    bool wants(models::StreamIndex) const override { return true; }
    void ended(const explain::Way& way) override { timeline->add_way(way); }
    TimelineRecorder* timeline = nullptr;
  } ways;
  Folder folder;
  PlanBuilder builder;
  const models::NodeIndex a = builder.host("a");
  const models::NodeIndex sw = builder.bridge("sw", 1_us);
  const models::NodeIndex b = builder.host("b");
  builder.link(a, sw, 1_Gbps, 100_ns);
  builder.link(sw, b, 1_Gbps, 100_ns);
  const models::StreamIndex stream = builder.stream(a, {b});
  builder.send_at(stream, 8_B, {0_ns, 0_ns});
  NetworkRun run(builder.plan);
  TimelineRecorder timeline(*run.network, folder / "timeline.json");
  ways.timeline = &timeline;
  explain::WayRecorder recorder(*run.network, ways);
  run.simulation.set_trace(&recorder);
  run.network->trace_paths();
  run.until(10_us);
  ASSERT_EQ(timeline.close(at(10_us)), "");
  std::vector<std::string> arrows, waits;
  const json written = json::parse(content_of(folder / "timeline.json"));
  for (const json& event : written.at("traceEvents")) {
    const std::string kind = event.at("ph");
    const auto place = [&] {
      return kind + " " + event.at("pid").dump() + "/" + event.at("tid").dump() + " " + event.at("ts").dump();
    };
    if (kind == "s" || kind == "t" || kind == "f") arrows.push_back(place());
    if (kind == "b" || kind == "e") waits.push_back(place() + " " + event.at("name").get<std::string>());
  }
  EXPECT_EQ(arrows, (std::vector<std::string>{"s 1/1 0.0", "f 2/2 1.676", "s 1/1 0.672", "f 2/2 2.348"}));
  EXPECT_EQ(waits, (std::vector<std::string>{"b 1/1 0.0 behind its own class", "e 1/1 0.672 behind its own class"}));
}

TEST(TimelineRecorder, ChangesNoRun) {
  Folder folder;
  Plant plant;
  NetworkRun plain(plant.plan);
  plain.until(2_ms);
  NetworkRun recorded(plant.plan);
  TimelineRecorder recorder(*recorded.network, folder / "timeline.json");
  recorded.simulation.set_trace(&recorder);
  recorded.until(2_ms);
  EXPECT_EQ(recorded.digest(), plain.digest());
}

}  // namespace
}  // namespace takt::output
