// Captures, read back octet by octet and by tshark.
#include "output/pcap_recorder.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdio>
#include <cstring>
#include <map>
#include <vector>

#include "tests/output/recording.hpp"

namespace takt::output {
namespace {

using namespace test;

struct Captured {
  std::uint32_t seconds = 0, nanoseconds = 0, captured = 0, length = 0;
  std::vector<std::byte> octets;
};

/// A pcap file as its format says, in the byte order of this machine.
std::vector<Captured> read_pcap(const std::string& path) {
  const std::string text = content_of(path);
  const auto word = [&](std::size_t at) {
    std::uint32_t value = 0;
    std::memcpy(&value, text.data() + at, sizeof value);
    return value;
  };
  EXPECT_GE(text.size(), 24u);
  EXPECT_EQ(word(0), 0xA1B2'3C4Du);  // nanoseconds
  EXPECT_EQ(word(20), 1u);           // Ethernet
  std::vector<Captured> frames;
  for (std::size_t at = 24; at < text.size();) {
    Captured frame{word(at), word(at + 4), word(at + 8), word(at + 12), {}};
    const auto* const begin = reinterpret_cast<const std::byte*>(text.data() + at + 16);
    frame.octets.assign(begin, begin + frame.captured);
    at += 16 + frame.captured;
    frames.push_back(std::move(frame));
  }
  return frames;
}

struct CommandResult {
  int status = -1;
  std::vector<std::vector<std::string>> rows;  // cells between tabs
};
CommandResult run_command(const std::string& command) {
  CommandResult result;
  std::FILE* const pipe = ::popen(command.c_str(), "r");
  if (pipe == nullptr) return result;
  std::vector<std::string> row(1);
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) {
    if (c == '\t') {
      row.emplace_back();
    } else if (c == '\n') {
      result.rows.push_back(std::exchange(row, std::vector<std::string>(1)));
    } else {
      row.back() += static_cast<char>(c);
    }
  }
  const int status = ::pclose(pipe);
  result.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return result;
}

// The first frame of `camera` leaves b at 0; 1046 octets last 84.32 us and 8 + 12 more, so the next ones 85.28 us later each. Its fourth
// comes at 1 ms.
TEST(PcapRecorder, TimesAndLengthsOfOnePort) {
  Folder folder;
  Plant plant;
  NetworkRun run(plant.plan);
  PcapRecorder recorder(*run.network);
  ASSERT_EQ(recorder.add(folder / "b.pcap", {{plant.b, 0}}), "");
  run.simulation.set_trace(&recorder);
  run.until(2_ms);
  ASSERT_EQ(recorder.close(), "");
  const std::vector<Captured> frames = read_pcap(folder / "b.pcap");
  ASSERT_EQ(frames.size(), 4u);
  EXPECT_EQ(recorder.frames(), 4u);
  const std::uint32_t times[] = {0, 85'280, 170'560, 1'000'000};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(frames[i].seconds, 0u);
    EXPECT_EQ(frames[i].nanoseconds, times[i]);
    EXPECT_EQ(frames[i].length, 1042u);  // 14 + 28 + 1000
    EXPECT_EQ(frames[i].captured, 1042u);
  }
}

TEST(PcapRecorder, AllPortsAndSeveralFiles) {
  Folder folder;
  Plant plant;
  NetworkRun run(plant.plan);
  plant.install_axes(*run.network);
  TraceLog log;
  run.simulation.set_trace(&log);
  run.until(2_ms);

  NetworkRun again(plant.plan);
  plant.install_axes(*again.network);
  PcapRecorder recorder(*again.network);
  ASSERT_EQ(recorder.add(folder / "all.pcap", {}), "");
  ASSERT_EQ(recorder.add(folder / "sw.pcap", {{plant.sw, 2}, {plant.sw, 3}}), "");
  again.simulation.set_trace(&recorder);
  again.until(2_ms);
  ASSERT_EQ(recorder.close(), "");
  EXPECT_EQ(again.digest(), run.digest());
  EXPECT_EQ(again.simulation.event_count(), run.simulation.event_count());

  std::map<sim::ComponentId, std::size_t> started;
  for (const sim::TraceRecord& record : log.of(Occurrence::started)) ++started[record.where];
  EXPECT_EQ(read_pcap(folder / "all.pcap").size(), log.of(Occurrence::started).size());
  EXPECT_EQ(read_pcap(folder / "sw.pcap").size(), started[run.port(plant.sw, 2).id()] + started[run.port(plant.sw, 3).id()]);
}

TEST(PcapRecorder, SecondsAndNanosecondsBelowTheMicrosecond) {
  Folder folder;
  PlanBuilder builder;
  const models::NodeIndex a = builder.host("a"), b = builder.host("b");
  builder.link(a, b, 1_Gbps);
  const models::StreamIndex stream = builder.stream(a, {b});
  builder.send_at(stream, 10_B, {3_s + 123'456'789'987_ps});
  NetworkRun run(builder.plan);
  PcapRecorder recorder(*run.network);
  ASSERT_EQ(recorder.add(folder / "a.pcap", {}), "");
  run.simulation.set_trace(&recorder);
  run.until(4_s);
  ASSERT_EQ(recorder.close(), "");
  const std::vector<Captured> frames = read_pcap(folder / "a.pcap");
  ASSERT_EQ(frames.size(), 1u);
  EXPECT_EQ(frames[0].seconds, 3u);
  EXPECT_EQ(frames[0].nanoseconds, 123'456'789u);
}

TEST(PcapRecorder, WithoutCloseNothingStays) {
  Folder folder;
  Plant plant;
  NetworkRun run(plant.plan);
  {
    PcapRecorder recorder(*run.network);
    ASSERT_EQ(recorder.add(folder / "all.pcap", {}), "");
    EXPECT_FALSE(folder.empty());
    run.simulation.set_trace(&recorder);
    run.until(1_ms);
  }
  EXPECT_TRUE(folder.empty());
}

TEST(PcapRecorder, SaysWhatItCannotWrite) {
  Folder folder;
  Plant plant;
  NetworkRun run(plant.plan);
  PcapRecorder recorder(*run.network);
  EXPECT_NE(recorder.add(folder / "no/such/folder.pcap", {}).find("folder.pcap"), std::string::npos);
  EXPECT_EQ(recorder.close(), "");  // the others are whole
}

// A full disk shows at close, not as a broken file.
TEST(PcapRecorder, AFullDiskIsAnError) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  Folder folder;
  Plant plant;
  NetworkRun run(plant.plan);
  std::filesystem::create_symlink("/dev/full", folder / "all.pcap.part");
  PcapRecorder recorder(*run.network);
  std::string problem = recorder.add(folder / "all.pcap", {});
  run.simulation.set_trace(&recorder);
  run.until(2_ms);
  if (problem.empty()) problem = recorder.close();
  EXPECT_NE(problem, "");
  EXPECT_FALSE(std::filesystem::exists(folder / "all.pcap"));
}

// tshark sees no malformed frame, no expert warning, good checksums, the lengths and addresses that the plan gives.
TEST(PcapRecorder, TsharkReadsIt) {
  ASSERT_EQ(run_command("command -v tshark").status, 0) << "this test needs tshark";
  Folder folder;
  Plant plant;
  NetworkRun run(plant.plan);
  plant.install_axes(*run.network);
  PcapRecorder recorder(*run.network);
  ASSERT_EQ(recorder.add(folder / "all.pcap", {}), "");
  run.simulation.set_trace(&recorder);
  run.until(2_ms);
  ASSERT_EQ(recorder.close(), "");

  const CommandResult result = run_command(
      "tshark -n -r '" + (folder / "all.pcap") +
      "' -o ip.check_checksum:TRUE -o udp.check_checksum:TRUE -T fields -e frame.len -e eth.dst -e eth.src -e vlan.id -e vlan.priority"
      " -e ip.dst -e ip.src -e udp.dstport -e udp.length -e ip.checksum.status -e udp.checksum.status -e _ws.malformed -e _ws.expert"
      " 2>/dev/null");
  ASSERT_EQ(result.status, 0);
  ASSERT_EQ(result.rows.size(), recorder.frames());
  std::map<std::string, int> kinds;
  for (const std::vector<std::string>& row : result.rows) {
    ASSERT_EQ(row.size(), 13u);
    EXPECT_EQ(row[11], "");
    EXPECT_EQ(row[12], "");
    std::string kind;
    for (std::size_t i = 0; i < 11; ++i) kind += row[i] + "|";
    ++kinds[kind];
  }
  // Nodes a 0, b 1, sw 2, c 3, d 4; the group is number 1000000 = 0x0F4240.
  std::map<models::StreamIndex, int> sent = Plant::sent_by_ports(plant);
  EXPECT_EQ(sent[plant.axes], 6);  // three frames, two hops
  EXPECT_EQ(sent[plant.raw], 4);
  const std::map<std::string, int> expected = {
      {"60|02:00:5e:00:00:03|02:00:5e:00:00:00|5|4|10.0.0.4|10.0.0.1|49152|22|1|1|", sent[plant.axes]},
      {"1042|03:00:5e:0f:42:40|02:00:5e:00:00:01|||239.15.66.64|10.0.0.2|49153|1008|1|1|", sent[plant.camera]},
      {"1518|02:00:5e:00:00:00|02:00:5e:00:00:04|0|6|||||||", sent[plant.raw]},
      {"1014|02:00:5e:00:00:04|02:00:5e:00:00:03|||||||||", sent[plant.noise]},
  };
  EXPECT_EQ(kinds, expected);
}

}  // namespace
}  // namespace takt::output
