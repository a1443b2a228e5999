// SPDX-License-Identifier: Apache-2.0
// Out and in again: what a format says of a scenario comes back, and the same run with it. What it cannot say is told,
// so that nothing is compared that would differ for a known reason.
#include "round_trip.hpp"

namespace takt::interchange::test {
namespace {

/// Without what devices are set to: gates, shapers and the like of ports, policing, gates of the network.
scenario::Scenario stripped(const scenario::Scenario& whole) {
  scenario::Scenario bare = whole;
  for (auto& [name, node] : bare.network.nodes) {
    for (scenario::Egress& egress : scenario::ports_of(node).egress) {
      scenario::Egress kept;
      kept.to = egress.to;
      egress = kept;
    }
    scenario::ports_of(node).traffic_classes = scenario::TrafficClasses::standard;
    if (scenario::Relay* const relay = scenario::relay_of(node)) relay->ingress.reset();
  }
  for (scenario::Generator& generator : bare.network.generate) {
    generator.egress.clear();
    generator.ingress.reset();
    generator.traffic_classes = scenario::TrafficClasses::standard;
  }
  bare.gates.reset();
  return bare;
}

/// Without what the data sets of gPTP say, too. Linux's files say less of it (roles, announced times), and keep the
/// base's.
void strip_gptp(scenario::Scenario& bare) {
  if (!bare.clocks.gptp) return;
  scenario::Gptp kept = *bare.clocks.gptp;
  const scenario::Gptp usual;
  kept.log_sync_interval = usual.log_sync_interval;
  kept.log_announce_interval = usual.log_announce_interval;
  kept.log_pdelay_interval = usual.log_pdelay_interval;
  kept.log_gptp_capable_interval.reset();
  kept.sync_receipt_timeout = usual.sync_receipt_timeout;
  kept.announce_receipt_timeout = usual.announce_receipt_timeout;
  kept.one_step = kept.drift_tracking = false;
  kept.link_delay_threshold = usual.link_delay_threshold;
  kept.nodes.clear();
  kept.domains.clear();
  kept.hot_standby = false;
  kept.standby_thresholds.reset();
  bare.clocks.gptp = std::move(kept);
}

/// Exports, imports into the stripped scenario, and compares the runs. False: the format cannot say all of it.
bool goes_round(const std::string& format, const std::vector<std::string>& settings,
                const std::vector<std::string>& import_settings, const std::filesystem::path& path) {
  const std::string name = path.filename().string();
  json::Diagnostics diagnostics;
  const auto resolved = scenario::load_file(path, {}, diagnostics);
  EXPECT_TRUE(resolved) << diagnostics.to_text();
  const ExportFormat* const written = find_export_format(format);
  std::string mistake;
  const Exported exported = written->write({*resolved, {}, *Settings::read(settings, written->settings, mistake)});
  EXPECT_EQ(exported.mistake, "");
  if (!exported.losses.empty()) return false;
  std::vector<InputFile> files;
  for (const OutputFile& file : exported.files)
    files.push_back({file.name, file.name.substr(0, file.name.find('.')), file.content});
  scenario::Scenario bare = stripped(resolved->scenario);
  if (format == "yang") strip_gptp(bare);
  const Reading reading = read(format, files, &bare, import_settings);
  EXPECT_TRUE(reading.imported.scenario) << name << "\n" << reading.diagnostics.to_text();
  if (!reading.imported.scenario) return true;
  const auto again = scenario::load_text(sparse_text(*reading.imported.scenario), path, {}, diagnostics);
  EXPECT_TRUE(again) << name << "\n" << diagnostics.to_text();
  if (!again) return true;
  const sim::Duration duration = std::min(resolved->scenario.duration, sim::Duration::from_ps(20'000'000'000));
  EXPECT_EQ(digest_of(*again, duration), digest_of(*resolved, duration)) << name << " by " << format;
  return true;
}

struct Counted {
  std::size_t went_round = 0, cannot = 0;
};
Counted all_go_round(const std::string& format, const std::vector<std::string>& settings = {},
                     const std::vector<std::string>& import_settings = {}) {
  Counted counted;
  for (const std::filesystem::path& path : shipped())
    ++(goes_round(format, settings, import_settings, path) ? counted.went_round : counted.cannot);
  return counted;
}

TEST(RoundTrip, ByScriptsOfLinux) {
  const Counted counted = all_go_round("linux", {}, {"never-open=accept"});
  EXPECT_GE(counted.went_round, 30u);
  EXPECT_GE(counted.cannot, 5u);  // ATS, FRER, cut-through ...
}

TEST(RoundTrip, ByYangOfThePublishedModules) {
  const Counted counted = all_go_round("yang");
  EXPECT_GE(counted.went_round, 30u);
  EXPECT_GE(counted.cannot, 5u);
}
TEST(RoundTrip, ByYangInXml) { EXPECT_GE(all_go_round("yang", {"encoding=xml"}).went_round, 30u); }
TEST(RoundTrip, ByYangOf2018) { EXPECT_GE(all_go_round("yang", {"dialect=2018"}).went_round, 25u); }
TEST(RoundTrip, ByYangOf2018InXml) {
  EXPECT_GE(all_go_round("yang", {"dialect=2018", "encoding=xml"}).went_round, 25u);
}

}  // namespace
}  // namespace takt::interchange::test
