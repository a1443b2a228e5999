// SPDX-License-Identifier: Apache-2.0
// Topologies in: LLDP of real machines, GraphML, networks of INET, tables of streams; and out again.
#include <gtest/gtest.h>

#include <set>

#include "round_trip.hpp"

namespace takt::interchange::test {
namespace {

using Links = std::set<std::set<std::string>>;

/// Node and number of the port, whatever the interface is called ("sw1:swp2", "sw1:2").
std::string end_of(const std::string& text) {
  const std::size_t colon = text.find(':');
  return text.substr(0, colon) + ":" + text.substr(text.find_last_not_of("0123456789") + 1);
}

Reading lldp_of(const std::string& folder, const std::string& neighbours) {
  std::vector<InputFile> files;
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(data() / "lldp" / folder)) paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  for (const auto& path : paths)
    if (path.filename().string().ends_with(".chassis.json") || path.filename().string().ends_with(neighbours))
      files.push_back(input(path));
  return read("lldp", files);
}

class Lldp : public testing::TestWithParam<std::string> {};

TEST_P(Lldp, GivesTheTopologiesOfTheTable) {
  json::Diagnostics diagnostics;
  const auto expected = json::parse(text_of(data() / "lldp/expected.json"), "expected.json", diagnostics);
  for (const json::Member& folder : expected->root().members) {
    const Reading reading = lldp_of(folder.key, GetParam());
    ASSERT_TRUE(reading.imported.scenario) << folder.key << reading.remarks();
    const scenario::NetworkSection& network = reading.imported.scenario->network;
    Links wanted, found;
    for (const json::Node& link : folder.value.find("links")->items)
      wanted.insert({end_of(link.items[0].text), end_of(link.items[1].text)});
    for (const scenario::Link& link : network.links) found.insert({link.ends[0], link.ends[1]});
    EXPECT_EQ(found, wanted) << folder.key << "\n" << reading.remarks();
    EXPECT_EQ(network.nodes.size(), folder.value.find("nodes")->members.size()) << folder.key;
    for (const auto& [name, node] : network.nodes)
      EXPECT_EQ(std::holds_alternative<scenario::HostNode>(node) ? "host" : "switch",
                folder.value.find("nodes")->find(name)->text)
          << folder.key << " " << name;
    const bool has_doubts = std::ranges::any_of(reading.imported.remarks,
                                                [](const Remark& each) { return each.kind != RemarkKind::changed; });
    EXPECT_EQ(has_doubts, !folder.value.find("doubts")->items.empty()) << folder.key << "\n" << reading.remarks();
  }
}
INSTANTIATE_TEST_SUITE_P(BothForms, Lldp, testing::Values(".neighbors.json", ".neighbors.json0"));

TEST(LldpFiles, WhatIsNoneIsRefusedAtItsPlace) {
  const Reading reading = read(
      "lldp", {{"a.json", "a", "{\"interfaces\": []}"}, {"b.json", "b", "{\"lldp\": {\"interface\": {\"eth0\": 7}}}"}});
  EXPECT_EQ(reading.diagnostics.errors(), 2u) << reading.diagnostics.to_text();
  EXPECT_FALSE(reading.imported.scenario);
}

std::vector<InputFile> exported(const std::string& format, const scenario::Resolved& resolved,
                                std::vector<Loss>* losses = nullptr) {
  const ExportFormat* const written = find_export_format(format);
  std::string mistake;
  const Exported made = written->write({resolved, {}, *Settings::read({}, written->settings, mistake)});
  if (losses != nullptr) *losses = made.losses;
  std::vector<InputFile> files;
  for (const OutputFile& file : made.files)
    files.push_back({file.name, file.name.substr(0, file.name.find('.')), file.content});
  return files;
}

TEST(GraphMl, BringsEveryTopologyBack) {
  for (const std::filesystem::path& path : shipped()) {
    json::Diagnostics diagnostics;
    const auto resolved = scenario::load_file(path, {}, diagnostics);
    const Reading reading = read("graphml", exported("graphml", *resolved));
    ASSERT_TRUE(reading.imported.scenario) << path << reading.remarks();
    const scenario::Topology again = scenario::build_topology(reading.imported.scenario->network, diagnostics);
    ASSERT_EQ(again.nodes.size(), resolved->topology.nodes.size()) << path;
    ASSERT_EQ(again.links.size(), resolved->topology.links.size()) << path;
    for (std::size_t n = 0; n < again.nodes.size(); ++n) {
      EXPECT_EQ(again.nodes[n].name, resolved->topology.nodes[n].name);
      EXPECT_EQ(again.nodes[n].description.get().index(), resolved->topology.nodes[n].description.get().index());
    }
    for (std::size_t l = 0; l < again.links.size(); ++l) {
      const models::LinkPlan &a = again.links[l], &b = resolved->topology.links[l];
      EXPECT_EQ(std::tuple(a.a.node, a.a.port, a.b.node, a.b.port, a.rate, a.delay),
                std::tuple(b.a.node, b.a.port, b.b.node, b.b.port, b.rate, b.delay))
          << path;
    }
  }
}

TEST(GraphMl, TellsAllMistakesWithTheirPlaces) {
  const Reading reading =
      read("graphml", {{"g.graphml", "g",
                        "<graphml>\n<key id=\"k\" for=\"node\" attr.name=\"kind\"/>\n<graph>\n<node id=\"a\"><data "
                        "key=\"k\">host</data></node>\n<node id=\"b\"><data key=\"k\">toaster</data></node>\n"
                        "<edge source=\"a\" target=\"c\"/>\n</graph>\n</graphml>"}});
  const auto told = reading.diagnostics.sorted();
  ASSERT_EQ(told.size(), 2u) << reading.diagnostics.to_text();
  EXPECT_EQ(told[0].place.line, 5u);
  EXPECT_EQ(told[1].place.line, 6u);
}

TEST(CsvStreams, AreThoseOfTheTable) {
  const Reading reading = read(
      "csv",
      {{"s.csv", "s",
        "# of the line\nname,from,to,payload,every,offset,pcp,latency\nset,plc,drive,60,500us,10us,6,200us\n\"all, of "
        "them\",plc,drive;panel,100B,1ms,,,\n"}});
  ASSERT_TRUE(reading.imported.scenario) << reading.remarks();
  const scenario::Scenario& s = *reading.imported.scenario;
  ASSERT_EQ(s.streams.size(), 2u);
  EXPECT_EQ(s.streams[0].payload.count, 60u);
  EXPECT_EQ(s.streams[0].every, sim::Duration::from_ps(500'000'000));
  EXPECT_EQ(s.streams[0].offset->value, sim::Duration::from_ps(10'000'000));
  EXPECT_EQ(s.streams[0].pcp, 6);
  EXPECT_EQ(s.streams[1].name, "all, of them");
  EXPECT_EQ(s.streams[1].to.names, (std::vector<std::string>{"drive", "panel"}));
  EXPECT_FALSE(s.streams[1].offset);
  ASSERT_EQ(s.require.size(), 1u);
  EXPECT_EQ(s.require[0].latency->greatest(), sim::Duration::from_ps(200'000'000));
  load(sparse_text(s), "s.json");
}

TEST(CsvStreams, TellAllMistakesWithTheirPlaces) {
  const Reading reading = read("csv", {{"s.csv", "s", "name,from,to,payload,every,pcp\na,x,y,60,500,9\nb,x,y,,1ms\n"}});
  std::vector<std::pair<std::uint32_t, std::uint32_t>> places;
  for (const json::Diagnostic& each : reading.diagnostics.sorted())
    places.emplace_back(each.place.line, each.place.column);
  EXPECT_EQ(places, (std::vector<std::pair<std::uint32_t, std::uint32_t>>{{2, 10}, {2, 14}, {3, 1}}))
      << reading.diagnostics.to_text();  // a unit, a priority; cells of the third row
}

/// Both networks ran in INET 4.6 and agree with these scenarios to the nanosecond, but for the first cable of the ring.
TEST(Inet, NetworksBecomeTheseScenarios) {
  for (const char* const name : {"press", "ring"}) {
    std::vector<InputFile> files;
    for (const auto& entry : std::filesystem::directory_iterator(data() / "inet" / name))
      if (entry.path().extension() == ".ini" ||
          (entry.path().extension() == ".ned" && entry.path().filename() != "package.ned"))
        files.push_back(input(entry.path()));
    std::sort(files.begin(), files.end(), [](const InputFile& a, const InputFile& b) { return a.name < b.name; });
    const Reading reading = read("inet", files);
    ASSERT_TRUE(reading.imported.scenario) << name << "\n" << reading.remarks();
    const auto found = load(sparse_text(*reading.imported.scenario), name);
    const auto expected = load(text_of(data() / "inet" / name / "scenario.json"), std::string(name) + "/scenario.json");
    ASSERT_TRUE(found && expected);
    EXPECT_EQ(digest_of(*found, sim::Duration::from_ps(20'000'000'000)),
              digest_of(*expected, sim::Duration::from_ps(20'000'000'000)))
        << name << "\n"
        << sparse_text(*reading.imported.scenario);
    EXPECT_EQ(reading.lost(), std::string(name) == "ring") << reading.remarks();  // the R-TAG of the first cable
  }
}

TEST(Inet, WhatIsNotUnderstoodIsRefusedByLine) {
  InputFile ned = input(data() / "inet/press/Press.ned"), ini = input(data() / "inet/press/omnetpp.ini");
  ini.text += "*.west.eth[2].macLayer.queue.transmissionGate[6].colour = \"red\"\n*.nobody.numApps = 1\n";
  const auto lines = static_cast<std::uint32_t>(std::count(ini.text.begin(), ini.text.end(), '\n'));
  const Reading reading = read("inet", {ned, ini});
  const auto told = reading.diagnostics.sorted();
  ASSERT_EQ(told.size(), 2u) << reading.diagnostics.to_text();
  EXPECT_EQ(told[0].place.line, lines - 1);
  EXPECT_EQ(told[1].place.line, lines);
}

TEST(Inet, BringsBackWhatItCanSay) {
  std::size_t went_round = 0;
  for (const std::filesystem::path& path : shipped()) {
    json::Diagnostics diagnostics;
    const auto resolved = scenario::load_file(path, {}, diagnostics);
    std::vector<Loss> losses;
    const std::vector<InputFile> files = exported("inet", *resolved, &losses);
    if (!losses.empty()) continue;
    const Reading reading = read("inet", files);
    ASSERT_TRUE(reading.imported.scenario) << path << "\n" << reading.remarks();
    const auto again = scenario::load_text(sparse_text(*reading.imported.scenario), path, {}, diagnostics);
    ASSERT_TRUE(again) << path << diagnostics.to_text();
    const sim::Duration duration = std::min(resolved->scenario.duration, sim::Duration::from_ps(20'000'000'000));
    EXPECT_EQ(digest_of(*again, duration), digest_of(*resolved, duration)) << path;
    ++went_round;
  }
  EXPECT_GE(went_round, 3u);
}

/// A capture of two talkers: 100 octets of UDP every millisecond, from 0 to 1 us late, and an EtherType without a
/// period.
std::string capture() {
  std::string text;
  const auto put = [&](std::uint64_t value, int octets, bool little) {
    for (int i = 0; i < octets; ++i) text += static_cast<char>(value >> (little ? 8 * i : 8 * (octets - 1 - i)) & 0xFF);
  };
  for (const auto& [value, octets] :
       {std::pair(0xA1B23C4Du, 4), {2u, 2}, {4u, 2}, {0u, 4}, {0u, 4}, {65535u, 4}, {1u, 4}})
    put(value, octets, true);
  const auto frame = [&](std::uint64_t ns, std::uint64_t source, bool has_udp) {
    const std::uint32_t length = has_udp ? 14 + 4 + 28 + 100 : 14 + 50;
    put(ns / 1'000'000'000, 4, true);
    put(ns % 1'000'000'000, 4, true);
    put(length, 4, true);
    put(length, 4, true);
    const std::size_t begin = text.size();
    put(0x02005E000009, 6, false);
    put(source, 6, false);
    if (has_udp) {
      put(0x8100, 2, false);
      put(6 << 13 | 10, 2, false);
      put(0x0800, 2, false);
      put(0x45, 1, false);
      text.append(8, '\0');
      put(17, 1, false);
      text.append(10, '\0');
      put(4000, 2, false);
      put(5000, 2, false);
      put(108, 2, false);
      put(0, 2, false);
    } else {
      put(0x88B5, 2, false);
    }
    text.append(length - (text.size() - begin), '\0');
  };
  for (std::uint64_t k = 0; k < 10; ++k) frame(5'000'000'000 + k * 1'000'000 + (k % 2) * 1'000, 0x02005E000001, true);
  for (const std::uint64_t ns : {5'000'100'000u, 5'000'101'000u, 5'000'102'000u, 5'010'000'000u})
    frame(ns, 0x02005E000002, false);
  return text;
}

TEST(Captures, GiveTalkersWithPeriodJitterAndSize) {
  const Reading reading = read("pcap", {{"plant.pcap", "plant", capture()}});
  ASSERT_TRUE(reading.imported.scenario) << reading.remarks();
  const auto& streams = reading.imported.scenario->streams;
  ASSERT_EQ(streams.size(), 2u) << reading.remarks();
  EXPECT_EQ(streams[0].payload.count, 100u);
  EXPECT_EQ(
      streams[0].every,
      sim::Duration::from_ps(1'000'000'000));  // the mean of nine gaps is 1.000111 ms, since the last frame is late
  EXPECT_EQ(streams[0].jitter, sim::Duration::from_ps(1'000'000));  // every other frame is 1 us late
  EXPECT_EQ(streams[0].offset->value, sim::Duration());
  EXPECT_EQ(streams[0].pcp, 6);
  EXPECT_EQ(streams[0].vlan, 10);
  EXPECT_EQ(streams[1].encapsulation, scenario::Encapsulation::ethernet);
  EXPECT_EQ(streams[1].payload.count, 50u);
  ASSERT_TRUE(streams[1].exponential);
  EXPECT_EQ(streams[1].exponential->mean, sim::Duration::from_ps(3'300'000'000));  // 9.9 ms in three gaps
  EXPECT_TRUE(load(sparse_text(*reading.imported.scenario), "plant.json"));
  EXPECT_FALSE(read("pcap", {{"plant.pcap", "plant", capture().substr(0, 60)}}).imported.scenario);
}

/// A frame of a pcapng file in the order of bytes that is not this machine's, seen by interface 0 or 1.
class BigEndianPcapng {
 public:
  BigEndianPcapng() {
    block(0x0A0D'0D0A, numbers({{0x1A2B'3C4D, 4}, {1, 2}, {0, 2}, {0xFFFF'FFFF, 4}, {0xFFFF'FFFF, 4}}));
    block(1, numbers({{1, 2}, {0, 2}, {0, 4}, {9, 2}, {1, 2}, {0x8A00'0000, 4}, {0, 4}}));  // Ethernet, 2^-10 s
    block(1, numbers({{1, 2}, {0, 2}, {0, 4}}));                                            // Ethernet, microseconds
    block(0x0BAD'0000, "what nobody knows   ");
  }
  void frame(std::uint32_t interface, std::uint32_t time) {
    std::string octets = numbers({{0x02005E, 3}, {9, 3}, {0x02005E, 3}, {1, 3}, {0x88B5, 2}}) + std::string(50, '\0');
    block(6, numbers({{interface, 4}, {0, 4}, {time, 4}, {64, 4}, {64, 4}}) + octets);
  }
  std::string text;

 private:
  static std::string numbers(std::initializer_list<std::pair<std::uint32_t, int>> all) {
    std::string octets;
    for (const auto& [value, size] : all)
      for (int shift = 8 * size - 8; shift >= 0; shift -= 8) octets += static_cast<char>(value >> shift & 0xFF);
    return octets;
  }
  void block(std::uint32_t type, const std::string& body) {
    const auto length = static_cast<std::uint32_t>(12 + body.size());
    text += numbers({{type, 4}, {length, 4}}) + body + numbers({{length, 4}});
  }
};

// Every 2^-10 s = 976562.5 ns at interface 0; interface 1 sees each 100 us later, and is not where the talker is.
TEST(Captures, OfSeveralInterfacesCountWhereAStreamIsSeenFirst) {
  BigEndianPcapng capture;
  for (std::uint32_t k = 1; k <= 5; ++k) {
    capture.frame(1, k * 1'000'000 / 1024 + 100);
    capture.frame(0, k);
  }
  const Reading reading = read("pcap", {{"plant.pcapng", "plant", capture.text}});
  ASSERT_TRUE(reading.imported.scenario) << reading.remarks();
  const auto& streams = reading.imported.scenario->streams;
  ASSERT_EQ(streams.size(), 1u) << reading.remarks();
  EXPECT_EQ(streams[0].every,
            sim::Duration::from_ps(976'563'000));  // the mean of four gaps, (4882812 - 976562) / 4 ns, rounded
  EXPECT_EQ(streams[0].payload.count, 50u);
  EXPECT_NE(reading.remarks().find("5 frames that further interfaces saw"), std::string::npos) << reading.remarks();
}

TEST(Captures, ThatAreBrokenSayWhere) {
  BigEndianPcapng capture;
  for (std::uint32_t k = 1; k <= 3; ++k) capture.frame(0, k);
  const auto said = [](const std::string& text) { return read("pcap", {{"plant.pcapng", "plant", text}}).remarks(); };
  EXPECT_NE(said(capture.text.substr(0, capture.text.size() - 10)).find("within what follows frame 2"),
            std::string::npos);
  capture.frame(2, 4);
  EXPECT_NE(said(capture.text).find("a frame of interface 2, which the file does not describe, after frame 3"),
            std::string::npos);
  EXPECT_NE(said("GIF89a, say").find("neither the beginning of pcap nor of pcapng"), std::string::npos);
  for (std::size_t size = 0; size < capture.text.size(); ++size)
    EXPECT_FALSE(said(capture.text.substr(0, size)).empty());
}

TEST(Requests, SayWhatStreamsAsk) {
  json::Diagnostics diagnostics;
  const auto resolved =
      scenario::load_file(std::string(TAKT_SOURCE_DIR) + "/scenarios/validation/gate-scheduling.json", {}, diagnostics);
  std::vector<Loss> losses;
  const std::vector<InputFile> files = exported("qcc", *resolved, &losses);
  EXPECT_TRUE(losses.empty());
  const auto document = json::parse(files.front().text, "requests.json", diagnostics);
  ASSERT_TRUE(document);
  const json::Node& first = document->root()
                                .find("ieee802-dot1q-cnc-config:cnc-config")
                                ->find("domain")
                                ->items[0]
                                .find("cuc")
                                ->items[0]
                                .find("stream")
                                ->items[0];
  EXPECT_EQ(first.find("stream-id")->text, "02-00-5e-00-00-00:00-01");
  const json::Node& traffic = *first.find("talker")->find("traffic-specification");
  EXPECT_EQ(traffic.find("interval")->find("denominator")->text, "2000");  // 500 us
  EXPECT_EQ(traffic.find("max-frame-size")->text, "1028");                 // 1000 octets and UDP over IP
  // 254.07 us less the last transmission of 1058 octets at 100 Mb/s, 84.64 us.
  EXPECT_EQ(first.find("talker")->find("user-to-network-requirements")->find("max-latency")->text, "169430");
}

TEST(Requests, AreAnsweredByHowTalkersAreSet) {
  // 100 us is asked for; of "auto" any time in the interval, and the answer is what takt has chosen.
  for (const bool is_auto : {false, true}) {
    json::Diagnostics diagnostics;
    const std::string text =
        R"({"name": "two", "duration": "10ms", "network": {"nodes": {"a": {"kind": "host"}, "b": {"kind": "host"}}, "links": [{"ends": ["a", "b"]}]},
        "streams": [{"name": "x", "from": "a", "to": "b", "payload": "100B", "every": "500us", "pcp": 5, "vlan": 7, "offset": )" +
        std::string(is_auto ? "\"auto\"" : "\"100us\"") + "}]}";
    const auto resolved = scenario::load_text(text, "two.json", {}, diagnostics);
    ASSERT_TRUE(resolved) << diagnostics.to_text();
    std::vector<Loss> losses;
    const std::vector<InputFile> files = exported("qcc", *resolved, &losses);
    ASSERT_EQ(files[1].name, "configurations.json");
    std::vector<json::Document> documents;
    const auto stream_in = [&](const InputFile& file) {
      documents.push_back(*json::parse(file.text, file.name, diagnostics));
      return documents.back()
          .root()
          .find("ieee802-dot1q-cnc-config:cnc-config")
          ->find("domain")
          ->items[0]
          .find("cuc")
          ->items[0]
          .find("stream")
          ->items[0];
    };
    const json::Node request = stream_in(files[0]), answer = stream_in(files[1]);
    EXPECT_EQ(answer.find("stream-id")->text, request.find("stream-id")->text);
    const json::Node& asked = *request.find("talker")->find("traffic-specification")->find("time-aware");
    EXPECT_EQ(asked.find("earliest-transmit-offset")->text, is_auto ? "0" : "100000");
    EXPECT_EQ(asked.find("latest-transmit-offset")->text, is_auto ? "499999" : "100000");
    const json::Node& values =
        *answer.find("talker")->find("interface-configuration")->find("interface-list")->items[0].find("config-list");
    EXPECT_EQ(values.items[0].find("time-aware-offset")->text,
              std::to_string(resolved->scenario.streams[0].offset->value.ps() / 1000));
    EXPECT_EQ(values.items[1].find("ieee802-vlan-tag")->find("vlan-id")->text, "7");
  }
}

}  // namespace
}  // namespace takt::interchange::test
