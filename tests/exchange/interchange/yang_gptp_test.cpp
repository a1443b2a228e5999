// SPDX-License-Identifier: Apache-2.0
// gPTP as instance data: what the data sets say comes back, and what takt does not have is refused at its place.
#include <gtest/gtest.h>

#include <limits>

#include "interchange/yang/gptp.hpp"
#include "round_trip.hpp"

namespace takt::interchange::test {
namespace {

using sim::Duration;

TEST(YangGptp, OfABridgeMeansThis) {
  const Reading reading = read("yang", {input(data() / "instances/own/gptp-of-a-bridge.xml")});
  ASSERT_TRUE(reading.imported.scenario) << reading.remarks();
  const scenario::Clocks& clocks = reading.imported.scenario->clocks;
  ASSERT_TRUE(clocks.gptp);
  EXPECT_EQ(clocks.gptp->log_sync_interval, -3);
  EXPECT_EQ(clocks.gptp->log_announce_interval, 0);
  EXPECT_EQ(clocks.gptp->sync_receipt_timeout, 3);
  EXPECT_EQ(clocks.gptp->link_delay_threshold, Duration::from_ps(800'000));  // 52428800 * 2^-16 ns
  ASSERT_EQ(clocks.gptp->nodes.size(), 1u);
  const scenario::GptpNode& node = clocks.gptp->nodes.front().second;
  EXPECT_EQ(node.priority1, 100);
  EXPECT_EQ(node.priority2, 248);
  EXPECT_EQ(node.clock_class, 248);
  EXPECT_EQ(node.clock_accuracy, 0x21);
  EXPECT_FALSE(node.roles);
  ASSERT_EQ(clocks.nodes.size(), 1u);
  EXPECT_EQ(clocks.nodes.front().second.tx_correction, Duration::from_ps(250'000));  // 16384000 * 2^-16 ns
  EXPECT_EQ(clocks.nodes.front().second.rx_correction, Duration::from_ps(400'000));
}

TEST(YangGptp, WholePicosecondsComeBack) {
  for (const std::int64_t ps : {0LL, 1LL, -1LL, 7LL, 999LL, 1001LL, 800'000LL, -123'456'789LL, 1'000'000'000'001LL})
    EXPECT_EQ(yang::duration_of_time_interval(yang::time_interval(Duration::from_ps(ps))), Duration::from_ps(ps)) << ps;
  EXPECT_FALSE(yang::duration_of_time_interval(std::numeric_limits<std::int64_t>::max()));
  EXPECT_FALSE(yang::duration_of_time_interval(std::numeric_limits<std::int64_t>::min()));
}

constexpr const char* plant = R"({
  "name": "two domains", "duration": "2s",
  "network": {"nodes": {"a": {"kind": "host"}, "s": {"kind": "switch"}, "b": {"kind": "host"}}, "links": [{"ends": ["a", "s"]}, {"ends": ["s", "b"]}]},
  "clocks": {"model": "free-running", "all": {"tx_correction": "13ps", "rx_correction": "29ns"}, "gptp": GPTP}
})";
std::string with_gptp(const std::string& gptp) {
  std::string text = plant;
  return text.replace(text.find("GPTP"), 4, gptp);
}

constexpr const char* everything = R"({
  "log_sync_interval": -4, "log_announce_interval": 1, "log_pdelay_interval": -1, "log_gptp_capable_interval": 2, "sync_receipt_timeout": 5, "announce_receipt_timeout": 4, "one_step": true, "drift_tracking": true,
  "link_delay_threshold": "777777ps",
  "nodes": {"a": {"priority1": 10, "priority2": 20, "clock_class": 6, "clock_accuracy": 33, "time": {"utc_offset": 36, "utc_offset_valid": true, "leap": "61", "time_traceable": true, "source": 32}, "roles": [{"to": "s", "role": "time-transmitter"}]},
            "s": {"roles": [{"to": "a", "role": "time-receiver"}, {"to": "b", "role": "time-transmitter"}]},
            "b": {"roles": [{"to": "s", "role": "time-receiver"}]}},
  "domains": [{"domain": 7, "nodes": {"b": {"priority1": 1}}}]
})";

TEST(YangGptp, GoesOutAndInAgainWithAllThatItSays) {
  for (const char* const encoding : {"json", "xml"}) {
    const auto resolved = load(with_gptp(everything), "whole.json");
    ASSERT_TRUE(resolved);
    const ExportFormat* const format = find_export_format("yang");
    std::string mistake;
    const Exported exported = format->write(
        {*resolved,
         {},
         *Settings::read(std::vector<std::string>{std::string("encoding=") + encoding}, format->settings, mistake)});
    for (const Loss& loss : exported.losses) ADD_FAILURE() << loss.where << ": " << loss.what;
    std::vector<InputFile> files;
    for (const OutputFile& file : exported.files)
      files.push_back({file.name, file.name.substr(0, file.name.find('.')), file.content});
    const auto bare = load(with_gptp("{}"), "bare.json");
    scenario::Scenario base = bare->scenario;
    base.clocks.all.reset();
    const Reading reading = read("yang", files, &base);
    ASSERT_TRUE(reading.imported.scenario) << reading.remarks();
    const scenario::Gptp &found = *reading.imported.scenario->clocks.gptp, &expected = *resolved->scenario.clocks.gptp;
    EXPECT_EQ(found.log_gptp_capable_interval, 2);
    EXPECT_TRUE(found.drift_tracking);
    EXPECT_EQ(found.link_delay_threshold, expected.link_delay_threshold);
    ASSERT_EQ(found.nodes.size(), 3u);
    ASSERT_EQ(found.domains.size(), 1u);
    EXPECT_EQ(found.domains.front().domain, 7);
    EXPECT_EQ(found.domains.front().nodes.size(), 3u);
    EXPECT_EQ(found.nodes.front().second.time->utc_offset, 36);
    EXPECT_EQ(found.nodes.front().second.time->source, 0x20);
    const auto again = load(sparse_text(*reading.imported.scenario), "again.json");
    ASSERT_TRUE(again);
    EXPECT_EQ(digest_of(*again, Duration::from_ps(2'000'000'000'000)),
              digest_of(*resolved, Duration::from_ps(2'000'000'000'000)))
        << encoding;
    EXPECT_NE(digest_of(*bare, Duration::from_ps(2'000'000'000'000)),
              digest_of(*resolved, Duration::from_ps(2'000'000'000'000)));
  }
}

TEST(YangGptp, ScaledNsHas96Bits) {
  EXPECT_EQ(yang::scaled_ns(Duration::from_ps(1'000'000)), "00-00-00-00-00-00-00-00-03-E8-00-00");  // 1000 ns * 2^16
  EXPECT_EQ(yang::scaled_ns(Duration::from_ps(-1'000)), "FF-FF-FF-FF-FF-FF-FF-FF-FF-FF-00-00");     // -1 ns
  for (const std::int64_t ps : {0LL, 1LL, -1LL, 999LL, -123'456'789LL, 1'000'000'000'001LL})
    EXPECT_EQ(yang::duration_of_scaled_ns(yang::scaled_ns(Duration::from_ps(ps))), Duration::from_ps(ps)) << ps;
  for (const char* const text : {"", "00-00-00-00-00-00-00-00-03-E8-00", "00-00-00-00-00-00-00-00-03-e8-00-00",
                                 "00-00-00-01-00-00-00-00-03-E8-00-00", "FF-FF-FF-FF-00-00-00-00-03-E8-00-00",
                                 "00-00-00-00-00-00-00-00-03-E8-00+00", "00-00-00-00-7F-FF-FF-FF-FF-FF-FF-FF",
                                 "00-00-00-00-80-00-00-00-00-00-00-00"})
    EXPECT_FALSE(yang::duration_of_scaled_ns(text)) << text;
}

TEST(YangGptp, LogarithmsOfSeconds) {
  EXPECT_EQ(yang::log_of_seconds(Duration()), -128);
  EXPECT_EQ(yang::log_of_seconds(Duration::from_ps(4'000'000'000'000)), 2);
  EXPECT_EQ(yang::log_of_seconds(Duration::from_ps(125'000'000'000)), -3);
  EXPECT_FALSE(yang::log_of_seconds(Duration::from_ps(3'000'000'000'000)));
  for (const int exponent : {-128, -12, -1, 0, 11})
    EXPECT_EQ(yang::log_of_seconds(*yang::duration_of_log(exponent)), exponent);
  for (const int exponent : {-127, -13, 12, 127}) EXPECT_FALSE(yang::duration_of_log(exponent)) << exponent;
}

constexpr const char* standby = R"({
  "hot_standby": true, "standby_thresholds": {"offset_max": "1500ns", "offset_met": 5, "offset_exceeded": 3, "rx_sync_count": 6, "primary_secondary_offset": "2500001ps", "waiting_time": "500ms"},
  "nodes": {"a": {"priority1": 100}}, "domains": [{"domain": 4, "nodes": {"b": {"priority1": 100}}}]
})";

std::vector<InputFile> standby_files(const std::string& encoding) {
  const auto resolved = load(with_gptp(standby), "standby.json");
  const ExportFormat* const format = find_export_format("yang");
  std::string mistake;
  const Exported exported = format->write(
      {*resolved, {}, *Settings::read(std::vector<std::string>{"encoding=" + encoding}, format->settings, mistake)});
  for (const Loss& loss : exported.losses) ADD_FAILURE() << loss.where << ": " << loss.what;
  std::vector<InputFile> files;
  for (const OutputFile& file : exported.files)
    files.push_back({file.name, file.name.substr(0, file.name.find('.')), file.content});
  return files;
}

TEST(YangGptp, AHotStandbyComesBack) {
  const auto resolved = load(with_gptp(standby), "standby.json");
  const auto bare = load(with_gptp("{}"), "bare.json");
  scenario::Scenario base = bare->scenario;
  base.clocks.all.reset();
  for (const char* const encoding : {"json", "xml"}) {
    const Reading reading = read("yang", standby_files(encoding), &base);
    ASSERT_TRUE(reading.imported.scenario) << reading.remarks();
    const scenario::Gptp &found = *reading.imported.scenario->clocks.gptp, &expected = *resolved->scenario.clocks.gptp;
    EXPECT_TRUE(found.hot_standby);
    EXPECT_TRUE(found.standby_thresholds == expected.standby_thresholds);
    const auto again = load(sparse_text(*reading.imported.scenario), "again.json");
    ASSERT_TRUE(again);
    EXPECT_EQ(digest_of(*again, Duration::from_ps(2'000'000'000'000)),
              digest_of(*resolved, Duration::from_ps(2'000'000'000'000)))
        << encoding;
  }
}

TEST(YangGptp, AHotStandbyThatTaktDoesNotHaveIsRefused) {
  const auto bare = load(with_gptp("{}"), "bare.json");
  struct Case {
    const char* from;
    const char* to;
    const char* message;
  };
  for (const Case& each :
       {Case{"<primary-ptp-instance-index>0<", "<primary-ptp-instance-index>1<", "a primary that is not domain 0"},
        Case{"<secondary-ptp-instance-index>1<", "<secondary-ptp-instance-index>0<",
             "a secondary that is not the first"},
        Case{"<secondary-ptp-instance-index>1<", "<secondary-ptp-instance-index>9<", "an instance that is not there"},
        Case{"split-functionality>false<", "split-functionality>true<", "a function that takt does not have"},
        Case{">-1</hot-standby-system-log", ">-13</hot-standby-system-log", "a waiting time that takt does not have"},
        Case{">00-00-", ">7F-00-", "a threshold that takt does not have"},
        Case{"<offset-max-met-count-thresh>5<", "<offset-max-met-count-thresh>70000<",
             "a count that takt does not have"},
        Case{"<offset-max-met-count-thresh>5<", "<offset-max-met-count-thresh>6<", "synced by different thresholds"},
        Case{"system-enable>true<", "system-enable>false<", "gPTP that is set differently at two devices"}}) {
    std::vector<InputFile> files = standby_files("xml");
    InputFile& file = *std::ranges::find(files, "b", &InputFile::device);
    ASSERT_NE(file.text.find(each.from), std::string::npos) << each.from;
    file.text.replace(file.text.find(each.from), std::string(each.from).size(), each.to);
    const Reading reading = read("yang", files, &bare->scenario);
    EXPECT_FALSE(reading.imported.scenario) << each.to;
    EXPECT_NE(reading.diagnostics.to_text().find(each.message), std::string::npos) << each.to << "\n"
                                                                                   << reading.diagnostics.to_text();
  }
}

TEST(YangGptp, TellsWhatTheModulesCannotSay) {
  const auto losses_of = [](const std::string& gptp, std::vector<std::string> settings) {
    const auto resolved = load(with_gptp(gptp), "lossy.json");
    const ExportFormat* const format = find_export_format("yang");
    std::string mistake, text;
    for (const Loss& loss : format->write({*resolved, {}, *Settings::read(settings, format->settings, mistake)}).losses)
      text += loss.where + ": " + loss.what + "\n";
    return text;
  };
  EXPECT_EQ(losses_of("{}", {}), "");
  EXPECT_NE(losses_of("{}", {"dialect=2018"}).find("no module of 2018"), std::string::npos);
  EXPECT_NE(losses_of(R"({"boundary": true})", {}).find("boundary clocks"), std::string::npos);
  EXPECT_NE(losses_of(R"({"sync_locked": false})", {}).find("sync-locked"), std::string::npos);
  EXPECT_NE(
      losses_of(
          R"({"hot_standby": true, "standby_thresholds": {"waiting_time": "3s"}, "nodes": {"a": {"priority1": 1}}, "domains": [{"domain": 1, "nodes": {"b": {"priority1": 1}}}]})",
          {})
          .find("no power of two"),
      std::string::npos);
  EXPECT_NE(losses_of(R"({"nodes": {"a": {"clock_class": 100}}})", {}).find("clockClass 100"), std::string::npos);
  EXPECT_NE(losses_of(R"({"nodes": {"a": {"clock_accuracy": 1}}})", {}).find("clockAccuracy 1"), std::string::npos);
}

TEST(YangGptp, WhatTaktDoesNotHaveIsRefused) {
  const std::string good = text_of(data() / "instances/own/gptp-of-a-bridge.xml");
  struct Case {
    const char* from;
    const char* to;
    const char* message;
  };
  for (const Case& each :
       {Case{"<log-sync-interval>-3<", "<log-sync-interval>9<", "an interval that takt does not have"},
        Case{"<port-ds>", "<port-ds><colour>red</colour>", "not in the module"},
        Case{">3</announce-receipt-timeout>", ">1</announce-receipt-timeout>", "a timeout that takt does not have"},
        Case{"<delay-mechanism>p2p<", "<delay-mechanism>e2e<", "a way to measure delays"},
        Case{"<domain-number>0<", "<domain-number>128<", "a domain that gPTP does not have"},
        Case{"<domain-number>0<", "<domain-number>5<", "no domain 0"},
        Case{"<underlying-interface>swp0<", "<underlying-interface>swp7<", "a port of no interface"},
        Case{"<log-sync-interval>-3<", "<log-sync-interval>-2<", "gPTP that is set differently at two ports"},
        Case{"<port-enable>true<", "<port-enable>false<", "a single port without gPTP"},
        Case{">52428800<", ">-65536<", "a threshold that takt does not have"},
        Case{"<egress-latency>16384000<", "<egress-latency>9223372036854775807<", "a latency beyond all reason"},
        Case{"cc-default", "cc-dfault", "not an identity"},
        Case{"<port-index>2<", "<port-index>1<", "two entries with one key"},
        Case{"</default-ds>", "<time-receiver-only>true</time-receiver-only></default-ds>", "to be no grandmaster"}}) {
    std::string text = good;
    ASSERT_NE(text.find(each.from), std::string::npos) << each.from;
    text.replace(text.find(each.from), std::string(each.from).size(), each.to);
    const Reading reading = read("yang", {{"sw1.xml", "sw1", text}});
    EXPECT_FALSE(reading.imported.scenario) << each.to;
    EXPECT_NE(reading.diagnostics.to_text().find(each.message), std::string::npos) << each.to << "\n"
                                                                                   << reading.diagnostics.to_text();
  }
}

}  // namespace
}  // namespace takt::interchange::test
