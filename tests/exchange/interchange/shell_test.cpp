// SPDX-License-Identifier: Apache-2.0
// Scripts as they are written, and what they come to: tests/findings/import has such files, too.
#include <gtest/gtest.h>

#include "interchange/device_import.hpp"
#include "round_trip.hpp"

namespace takt::interchange::test::shell_test {
namespace {

std::filesystem::path findings() { return std::filesystem::path(TAKT_SOURCE_DIR) / "tests/findings/import"; }

Reading script(const std::string& text, std::vector<std::string> settings = {}) {
  return read("linux", {{"sw1.sh", "sw1", text}}, nullptr, std::move(settings));
}

const scenario::NodePorts* ports_of_first(const Reading& reading) {
  if (!reading.imported.scenario) {
    ADD_FAILURE() << reading.remarks();
    return nullptr;
  }
  return &scenario::ports_of(reading.imported.scenario->network.nodes.front().second);
}

/// The intervals of the gate list of the first port, in ns, each with its classes.
std::string gates_of(const Reading& reading) {
  const scenario::NodePorts* const ports = ports_of_first(reading);
  if (ports == nullptr || ports->egress.empty() || !ports->egress.front().gates) return "none\n" + reading.remarks();
  std::string text;
  for (const scenario::GateEntry& entry : ports->egress.front().gates->entries) {
    for (const std::uint8_t q : entry.open) text += std::to_string(q);
    text += ":" + std::to_string(entry.interval.ps() / 1000) + " ";
  }
  return text;
}

bool is_told(const Reading& reading, const std::string& text) {
  return reading.remarks().find(text) != std::string::npos;
}

const std::string taprio = "taprio num_tc 8 map 0 1 2 3 4 5 6 7 queues 1@0 1@1 1@2 1@3 1@4 1@5 1@6 1@7 base-time 0 ";

TEST(Shell, VariablesAndQuotesAreWorkedOut) {
  EXPECT_EQ(gates_of(script("DEV=eth0\nT=\"300000\"\nsudo tc qdisc replace dev $DEV parent root handle 100 " + taprio +
                            "sched-entry S 80 ${T} sched-entry S '7f' $((1000000 - T)) flags 0x2\n")),
            "7:300000 0123456:700000 ");
}

TEST(Shell, LoopsOverListsAndFunctionsAreGivenOut) {
  const Reading reading = script(
      "setup() {\n  local dev=$1\n  tc qdisc del dev \"$dev\" root 2>/dev/null || true\n  tc qdisc add dev \"$dev\" "
      "root handle 100 " +
      taprio +
      "sched-entry S ff $2 flags 0x2\n}\n"
      "for i in 0 1 2; do setup swp$i 500000; done\nfor i in {3..4}; do setup swp$i 500000; done\nfor i in $(seq 5 6); "
      "do\n  setup \"swp${i}\" 500000\ndone\n");
  ASSERT_TRUE(reading.imported.scenario) << reading.remarks();
  EXPECT_EQ(reading.imported.scenario->network.links.size(), 7U) << reading.remarks();
}

TEST(Shell, ATraceIsTheCommandsThatWereGiven) {
  EXPECT_EQ(
      gates_of(script(
          "+ DEV=eth0\n+ tc qdisc replace dev eth0 parent root handle 100 " + taprio +
          "sched-entry S 80 300000 sched-entry S 7f 700000 flags 0x2\nRTNETLINK answers: Operation not supported\n")),
      "7:300000 0123456:700000 ");
}

TEST(Shell, ABatchHasNoTc) {
  EXPECT_EQ(gates_of(read("linux", {{"sw1.batch", "sw1",
                                     "qdisc replace dev eth0 parent root handle 100 " + taprio +
                                         "sched-entry S 80 300000 sched-entry S 7f 700000 flags 0x2\n"}})),
            "7:300000 0123456:700000 ");
  EXPECT_EQ(gates_of(script("D=eth0\ntc -batch - <<END\nqdisc replace dev $D parent root handle 100 " + taprio +
                            "sched-entry S 80 300000 sched-entry S 7f 700000 flags 0x2\nEND\n")),
            "7:300000 0123456:700000 ");
}

TEST(Shell, WhatOnlyARunCanSayIsToldAtItsLine) {
  const Reading reading =
      script("tc qdisc add dev $1 clsact\nif [ \"$(uname -r)\" = x ]; then\n  tc qdisc add dev eth1 clsact\nfi\n");
  std::vector<std::uint32_t> lines;
  for (const json::Diagnostic& each : reading.diagnostics.sorted()) lines.push_back(each.place.line);
  EXPECT_EQ(lines, (std::vector<std::uint32_t>{1, 2})) << reading.remarks();
  // A base time is folded into the cycle anyhow.
  const Reading now = script(
      "tc qdisc replace dev eth0 parent root handle 100 taprio num_tc 2 map 0 1 queues 1@0 1@1 base-time $(($(date "
      "+%s%N) + 1000)) sched-entry S 1 500000 sched-entry S 2 500000 flags 0x2\n");
  EXPECT_TRUE(now.imported.scenario) << now.remarks();
  EXPECT_TRUE(is_told(now, "sw1.sh:1:99: lost: the base time")) << now.remarks();
}

TEST(Shell, WhatSetsNothingIsTold) {
  const Reading reading = script(
      "#!/bin/bash\nset -e\necho hello | tee log\nif [ $(id -u) -ne 0 ]; then\n  echo root >&2; exit 1\nfi\nip addr "
      "add 10.0.0.1/24 dev eth0\nethtool -K eth0 tso off\nmyprogram --start &\ntc qdisc add dev eth0 root netem delay "
      "1ms\n");
  ASSERT_TRUE(reading.imported.scenario) << reading.remarks();
  for (const char* const text : {"7:1: ignored: ip addr", "8:1: ignored: ethtool -K",
                                 "9:1: ignored: the command \"myprogram\"", "10:28: lost: the qdisc netem"})
    EXPECT_TRUE(is_told(reading, text)) << text << "\n" << reading.remarks();
}

TEST(Shell, ALostBackslashIsTold) {
  const Reading reading = read("linux", {input(findings() / "openil-114.sh")}, nullptr, {"never-open=accept"});
  EXPECT_EQ(gates_of(reading), "3:5000 2:1000 ") << reading.remarks();
  EXPECT_TRUE(is_told(reading, "the backslash is missing there")) << reading.remarks();
  EXPECT_TRUE(is_told(reading, "the action trap")) << reading.remarks();
}

TEST(LinuxFindings, MasksMayHaveAPrefix) {
  // Class 0 of the script has all priorities but 1, which is class 0 of takt.
  EXPECT_EQ(gates_of(read("linux", {input(findings() / "hex-mask.sh")})), "1234567:500000 0:500000 ");
}
TEST(LinuxFindings, MasksInDecimalAreRefused) {
  EXPECT_TRUE(read("linux", {input(findings() / "tsn-doc-34.sh")}).diagnostics.has_errors());
}

TEST(LinuxFindings, SixteenStatusesOfPreemptionSayNothing) {
  const Reading reading = read("linux", {input(findings() / "fp.qdisc.json")});
  ASSERT_TRUE(reading.imported.scenario) << reading.remarks();
  EXPECT_FALSE(ports_of_first(reading)->egress.front().preemption);
}

TEST(LinuxFindings, WhatComesNextIsWhatIsSet) {
  const std::string lists =
      R"("base_time":0,"cycle_time":1000000,"cycle_time_extension":0,"schedule":[{"index":0,"cmd":"S","gatemask":"0x1","interval":1000000}],"admin":{"base_time":0,"cycle_time":2000000,"cycle_time_extension":0,"schedule":[{"index":0,"cmd":"S","gatemask":"0x2","interval":1500000},{"index":1,"cmd":"S","gatemask":"0x1","interval":500000}]})";
  const Reading reading = read(
      "linux",
      {{"a.qdisc.json", "a",
        R"([{"kind":"taprio","handle":"100:","dev":"eth0","root":true,"options":{"tc":2,"map":[0,1,0,0,0,0,0,0,0,0,0,0,0,0,0,0],"queues":[{"offset":0,"count":1},{"offset":1,"count":1}],"flags":"0x2",)" +
            lists + "}}]"}});
  ASSERT_NE(ports_of_first(reading), nullptr);
  EXPECT_EQ(ports_of_first(reading)->egress.front().gates->entries.front().interval,
            sim::Duration::from_ps(1'500'000'000))
      << reading.remarks();
  EXPECT_TRUE(is_told(reading, "a gate list that is not in force yet")) << reading.remarks();
}

TEST(LinuxFindings, FilesMayBeCalledAfterAddresses) {
  EXPECT_EQ(device_of_file("192.168.0.1.sh"), "192.168.0.1");
  EXPECT_EQ(device_of_file("192.168.0.1.qdisc.json"), "192.168.0.1");
  EXPECT_EQ(device_of_file("sw1.qdisc.json"), "sw1");
  EXPECT_EQ(device_of_file("10.20.sh"), "10");
  std::vector<InputFile> files;
  for (const char* const name : {"192.168.0.1.sh", "192.168.0.2.sh"})
    files.push_back({name, device_of_file(name), text_of(findings() / name)});
  const Reading reading = read("linux", files);
  ASSERT_TRUE(reading.imported.scenario) << reading.remarks();
  EXPECT_EQ(reading.imported.scenario->network.nodes.size(), 4U);  // each with a host at its port
}

TEST(LinuxFindings, NamesOfInterfacesSurvive) {
  const Reading reading = read("linux", {input(findings() / "swp5-and-swp2.sh")});
  ASSERT_TRUE(reading.imported.scenario) << reading.remarks();
  json::Diagnostics diagnostics;
  const auto resolved = scenario::load_text(sparse_text(*reading.imported.scenario), "again", {}, diagnostics);
  ASSERT_TRUE(resolved) << diagnostics.to_text();
  const ExportFormat* const format = find_export_format("linux");
  std::string mistake;
  Names names;
  names.read({"again.names.json", "", interfaces_table(reading.imported.interfaces)}, diagnostics);
  const Exported exported =
      format->write({*resolved, {}, *Settings::read({}, format->settings, mistake), names.interfaces()});
  const auto written =
      std::ranges::find_if(exported.files, [](const OutputFile& file) { return file.name == "swp5-and-swp2.sh"; });
  ASSERT_NE(written, exported.files.end());
  const Reading again = read("linux", {{written->name, "swp5-and-swp2", written->content}});
  for (const auto& [name, port] : {std::pair<std::string, std::uint8_t>("swp5", 7), {"swp2", 6}}) {
    const auto found = written->content.find("dev " + name + " parent root handle 100 taprio");
    ASSERT_NE(found, std::string::npos) << written->content;
    EXPECT_NE(written->content.substr(found, 400).find("sched-entry S " + std::string(port == 7 ? "80" : "40")),
              std::string::npos);
  }
}

TEST(LinuxFindings, ASilentFileOfPtp4lHasItsDefaults) {
  const Reading reading = read("linux", {input(findings() / "a.ptp4l.conf")});
  ASSERT_TRUE(reading.imported.scenario) << reading.remarks();
  const scenario::Gptp& gptp = *reading.imported.scenario->clocks.gptp;
  EXPECT_EQ(gptp.nodes.front().second.priority1, 128);
  EXPECT_EQ(gptp.log_sync_interval, 0);
  EXPECT_EQ(gptp.log_announce_interval, 1);
  EXPECT_EQ(gptp.link_delay_threshold, sim::Duration::from_ps(20'000'000'000));
}

TEST(LinuxFindings, EveryOptionOfPtp4lIsTakenOrTold) {
  const auto conf = [](const std::string& line) {
    return read("linux",
                {{"a.conf", "a",
                  "[global]\ntransportSpecific 1\nnetwork_transport L2\ndelay_mechanism P2P\nsyncReceiptTimeout 3\n" +
                      line + "\n"}});
  };
  EXPECT_EQ(conf("priority2 7").remarks(), "");
  for (const char* const line :
       {"free_running 1", "delayAsymmetry 100", "clock_type P2P_TC", "asCapable true", "inhibit_announce 1",
        "pi_proportional_const 0.5", "time_stamping software", "serverOnly 1", "masterOnly 1", "path_trace_enabled 0"})
    EXPECT_TRUE(conf(line).lost()) << line << conf(line).remarks();
  for (const char* const line : {"logging_level 7", "follow_up_info 1", "tx_timestamp_timeout 10",
                                 "pi_integral_const 0.0", "clientOnly 0", "time_stamping hardware"})
    EXPECT_EQ(conf(line).remarks(), "") << line;
  const Reading fixed = read("linux", {{"a.conf", "a",
                                        "[global]\ntransportSpecific 1\nnetwork_transport L2\ndelay_mechanism "
                                        "P2P\nsyncReceiptTimeout 3\nBMCA noop\n[eth0]\nserverOnly 1\n[eth1]\n"}});
  ASSERT_TRUE(fixed.imported.scenario) << fixed.remarks();
  const auto& roles = fixed.imported.scenario->clocks.gptp->nodes.front().second.roles;
  ASSERT_TRUE(roles && roles->size() == 2) << fixed.remarks();
  EXPECT_EQ((*roles)[0].role, scenario::GptpRole::time_transmitter);
  EXPECT_EQ((*roles)[1].role, scenario::GptpRole::time_receiver);
}

}  // namespace
}  // namespace takt::interchange::test::shell_test
