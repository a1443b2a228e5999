// SPDX-License-Identifier: Apache-2.0
// Captures, read back octet by octet and by tshark.
#include "output/pcap_recorder.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <map>
#include <set>
#include <vector>

#include "tests/presentation/output/recording.hpp"

namespace takt::output {
namespace {

using namespace test;

struct Captured {
  std::uint32_t interface = 0;
  std::uint64_t nanoseconds = 0;
  std::uint32_t captured = 0, length = 0, flags = 0;
};
struct Capture {
  std::vector<std::string> names;  // of interfaces
  std::vector<std::uint64_t> bits_per_second;
  std::vector<Captured> frames;
};

/// A pcapng file as its format says: blocks of whole words with their length at both ends, in the order of this
/// machine.
Capture read_pcapng(const std::string& path) {
  const std::string text = content_of(path);
  const auto word = [&](std::size_t at) {
    std::uint32_t value = 0;
    if (at + sizeof value <= text.size()) std::memcpy(&value, text.data() + at, sizeof value);
    return value;
  };
  /// Value of an option from `at` on, where `end` is that of the block without its second length.
  const auto option = [&](std::size_t at, std::size_t end, std::uint32_t code) {
    while (at + 4 <= end && (word(at) & 0xFFFF) != 0) {
      const std::uint32_t length = word(at) >> 16;
      if ((word(at) & 0xFFFF) == code) return text.substr(at + 4, length);
      at += 4 + (length + 3) / 4 * 4;
    }
    return std::string();
  };
  EXPECT_EQ(word(0), 0x0A0D'0D0Au);
  EXPECT_EQ(word(8), 0x1A2B'3C4Du);
  EXPECT_EQ(option(24, word(4) - 4, 4).substr(0, 5), "takt ");
  Capture capture;
  for (std::size_t at = 0; at < text.size(); at += word(at + 4)) {
    const std::size_t end = at + word(at + 4) - 4;
    if (word(at + 4) % 4 != 0 || end >= text.size() || word(end) != word(at + 4)) {
      ADD_FAILURE() << path << ": the block at " << at << " is not whole";
      break;
    }
    if (word(at) == 1) {
      EXPECT_EQ(word(at + 8) & 0xFFFF, 1u);  // Ethernet
      capture.names.push_back(option(at + 16, end, 2));
      capture.bits_per_second.push_back(0);
      std::memcpy(&capture.bits_per_second.back(), option(at + 16, end, 8).data(), 8);
      EXPECT_EQ(option(at + 16, end, 9), "\x09");                 // nanoseconds
      EXPECT_EQ(option(at + 16, end, 13), std::string(1, '\0'));  // no FCS
    } else if (word(at) == 6) {
      Captured frame{word(at + 8), std::uint64_t{word(at + 12)} << 32 | word(at + 16), word(at + 20), word(at + 24)};
      std::memcpy(&frame.flags, option(at + 28 + (frame.captured + 3) / 4 * 4, end, 2).data(), 4);
      EXPECT_LT(frame.interface, capture.names.size());
      capture.frames.push_back(frame);
    }
  }
  return capture;
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

// The first frame of `camera` leaves b at 0; 1046 octets last 84.32 us and 8 + 12 more, so the next ones 85.28 us later
// each. Its fourth comes at 1 ms.
TEST(PcapRecorder, TimesAndLengthsOfOnePort) {
  Folder folder;
  Plant plant;
  NetworkRun run(plant.plan);
  PcapRecorder recorder(*run.network);
  ASSERT_EQ(recorder.add(folder / "b.pcapng", {{plant.b, 0}}), "");
  run.simulation.set_trace(&recorder);
  run.until(2_ms);
  ASSERT_EQ(recorder.close(), "");
  const auto [names, speeds, frames] = read_pcapng(folder / "b.pcapng");
  EXPECT_EQ(names, std::vector<std::string>{"b:0 to sw"});
  EXPECT_EQ(speeds, std::vector<std::uint64_t>{100'000'000});
  ASSERT_EQ(frames.size(), 4u);
  EXPECT_EQ(recorder.frames(), 4u);
  const std::uint64_t times[] = {0, 85'280, 170'560, 1'000'000};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(frames[i].interface, 0u);
    EXPECT_EQ(frames[i].flags, 2u);  // outbound
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
  ASSERT_EQ(recorder.add(folder / "all.pcapng", {}), "");
  ASSERT_EQ(recorder.add(folder / "sw.pcapng", {{plant.sw, 2}, {plant.sw, 3}}), "");
  again.simulation.set_trace(&recorder);
  again.until(2_ms);
  ASSERT_EQ(recorder.close(), "");
  EXPECT_EQ(again.digest(), run.digest());
  EXPECT_EQ(again.simulation.event_count(), run.simulation.event_count());

  std::map<sim::ComponentId, std::size_t> started;
  for (const sim::TraceRecord& record : log.of(Occurrence::started)) ++started[record.where];
  const Capture all = read_pcapng(folder / "all.pcapng"), sw = read_pcapng(folder / "sw.pcapng");
  EXPECT_EQ(all.names, (std::vector<std::string>{"cell \"A\":0 to sw", "b:0 to sw", "sw:0 to cell \"A\"", "sw:1 to b",
                                                 "sw:2 to c", "sw:3 to d", "c:0 to sw", "d:0 to sw"}));
  EXPECT_EQ(all.frames.size(), log.of(Occurrence::started).size());
  const std::size_t to_c = started[run.port(plant.sw, 2).id()], to_d = started[run.port(plant.sw, 3).id()];
  EXPECT_EQ(sw.names, (std::vector<std::string>{"sw:2 to c", "sw:3 to d"}));
  EXPECT_EQ(sw.frames.size(), to_c + to_d);
  EXPECT_EQ(std::ranges::count(all.frames, 4u, &Captured::interface), to_c);
  EXPECT_EQ(std::ranges::count(sw.frames, 1u, &Captured::interface), to_d);
  EXPECT_TRUE(std::ranges::is_sorted(all.frames, {}, &Captured::nanoseconds));
}

// The group's frames leave b and, as two copies each, sw; what shares the links with them is not there, nor are ports
// that they do not pass.
TEST(PcapRecorder, OneStreamAtAllItsPorts) {
  Folder folder;
  Plant plant;
  NetworkRun run(plant.plan);
  plant.install_axes(*run.network);
  PcapRecorder recorder(*run.network);
  ASSERT_EQ(recorder.add_stream(folder / "stream.pcapng", plant.camera), "");
  run.simulation.set_trace(&recorder);
  run.until(2_ms);
  ASSERT_EQ(recorder.close(), "");
  const Capture capture = read_pcapng(folder / "stream.pcapng");
  EXPECT_EQ(std::set(capture.names.begin(), capture.names.end()),
            (std::set<std::string>{"b:0 to sw", "sw:2 to c", "sw:3 to d"}));
  EXPECT_EQ(capture.names.size(), 3u);
  EXPECT_EQ(static_cast<int>(capture.frames.size()), Plant::sent_by_ports(plant)[plant.camera]);
  for (const Captured& frame : capture.frames) EXPECT_EQ(frame.length, 1042u);
}

// Beyond 18.4 ms, too, where tshark 4.0 loses count of picoseconds.
TEST(PcapRecorder, SecondsAndNanosecondsBelowTheMicrosecond) {
  Folder folder;
  PlanBuilder builder;
  const models::NodeIndex a = builder.host("a"), b = builder.host("b");
  builder.link(a, b, 1_Gbps);
  const models::StreamIndex stream = builder.stream(a, {b});
  builder.send_at(stream, 10_B, {3_s + 123'456'789'987_ps});
  NetworkRun run(builder.plan);
  PcapRecorder recorder(*run.network);
  ASSERT_EQ(recorder.add(folder / "a.pcapng", {}), "");
  run.simulation.set_trace(&recorder);
  run.until(4_s);
  ASSERT_EQ(recorder.close(), "");
  const auto [names, speeds, frames] = read_pcapng(folder / "a.pcapng");
  EXPECT_EQ(speeds, (std::vector<std::uint64_t>{1'000'000'000, 1'000'000'000}));
  ASSERT_EQ(frames.size(), 1u);
  EXPECT_EQ(frames[0].nanoseconds, 3'123'456'789u);
  const CommandResult shown =
      run_command("tshark -n -r '" + (folder / "a.pcapng") + "' -T fields -e frame.time_epoch 2>/dev/null");
  ASSERT_EQ(shown.status, 0) << "this test needs tshark";
  EXPECT_EQ(shown.rows, (std::vector<std::vector<std::string>>{{"3.123456789"}}));
}

TEST(PcapRecorder, WithoutCloseNothingStays) {
  Folder folder;
  Plant plant;
  NetworkRun run(plant.plan);
  {
    PcapRecorder recorder(*run.network);
    ASSERT_EQ(recorder.add(folder / "all.pcapng", {}), "");
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
  EXPECT_NE(recorder.add(folder / "no/such/folder.pcapng", {}).find("folder.pcapng"), std::string::npos);
  EXPECT_EQ(recorder.close(), "");  // the others are whole
}

/// While it lives no file grows beyond so many octets, as on a disk that is full.
class FullDisk {
 public:
  explicit FullDisk(rlim_t octets) {
    std::signal(SIGXFSZ, SIG_IGN);  // so that a write says EFBIG
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit least{octets, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &least);
  }
  ~FullDisk() { ::setrlimit(RLIMIT_FSIZE, &before_); }

 private:
  rlimit before_{};
};

// A full disk shows at close, not as a broken file.
TEST(PcapRecorder, AFullDiskIsAnError) {
  Folder folder;
  Plant plant;
  NetworkRun run(plant.plan);
  const FullDisk full(100);
  PcapRecorder recorder(*run.network);
  std::string problem = recorder.add(folder / "all.pcapng", {});
  run.simulation.set_trace(&recorder);
  run.until(2_ms);
  if (problem.empty()) problem = recorder.close();
  EXPECT_NE(problem, "");
  EXPECT_FALSE(std::filesystem::exists(folder / "all.pcapng"));
}

// tshark sees no malformed frame, no expert warning, good checksums, the lengths and addresses that the plan gives.
TEST(PcapRecorder, TsharkReadsIt) {
  ASSERT_EQ(run_command("command -v tshark").status, 0) << "this test needs tshark";
  Folder folder;
  Plant plant;
  NetworkRun run(plant.plan);
  plant.install_axes(*run.network);
  PcapRecorder recorder(*run.network);
  ASSERT_EQ(recorder.add(folder / "all.pcapng", {}), "");
  run.simulation.set_trace(&recorder);
  run.until(2_ms);
  ASSERT_EQ(recorder.close(), "");

  const CommandResult result =
      run_command("tshark -n -r '" + (folder / "all.pcapng") +
                  "' -o ip.check_checksum:TRUE -o udp.check_checksum:TRUE -T fields -e frame.len -e eth.dst -e eth.src "
                  "-e vlan.id -e vlan.priority"
                  " -e ip.dst -e ip.src -e udp.dstport -e udp.length -e ip.checksum.status -e udp.checksum.status -e "
                  "_ws.malformed -e _ws.expert"
                  " -e frame.interface_name -e frame.time_epoch -e frame.packet_flags_direction 2>/dev/null");
  ASSERT_EQ(result.status, 0);
  ASSERT_EQ(result.rows.size(), recorder.frames());
  const Capture capture = read_pcapng(folder / "all.pcapng");
  std::map<std::string, int> kinds;
  for (std::size_t at = 0; at < result.rows.size(); ++at) {
    const std::vector<std::string>& row = result.rows[at];
    ASSERT_EQ(row.size(), 16u);
    EXPECT_EQ(row[11], "");
    EXPECT_EQ(row[12], "");
    EXPECT_EQ(row[13], capture.names[capture.frames[at].interface]);
    EXPECT_EQ(row[14], "0." + std::to_string(1'000'000'000 + capture.frames[at].nanoseconds).substr(1));
    EXPECT_EQ(row[15], "0x00000002");
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
