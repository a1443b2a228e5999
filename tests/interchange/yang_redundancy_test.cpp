// Redundancy (802.1CB) as instance data: where streams are numbered, split and recovered.
#include <gtest/gtest.h>

#include "round_trip.hpp"

namespace takt::interchange::test {
namespace {

struct Written {
  std::unique_ptr<scenario::Resolved> resolved;
  Exported exported;
};
Written written(const std::string& scenario, const std::vector<std::string>& settings = {}) {
  json::Diagnostics diagnostics;
  auto resolved = scenario::load_file(std::filesystem::path(TAKT_SOURCE_DIR) / "scenarios" / scenario, {}, diagnostics);
  EXPECT_TRUE(resolved) << diagnostics.to_text();
  const ExportFormat* const format = find_export_format("yang");
  std::string mistake;
  Exported exported = format->write({*resolved, {}, *Settings::read(settings, format->settings, mistake)});
  return {std::move(resolved), std::move(exported)};
}

/// The member `name` of a file's root, without blanks.
std::string part_of(const Exported& exported, const std::string& file, const std::string& name) {
  for (const OutputFile& each : exported.files) {
    if (each.name != file) continue;
    json::Diagnostics diagnostics;
    const auto document = json::parse(each.content, file, diagnostics);
    const json::Node* const found = document ? document->root().find(name) : nullptr;
    std::string text = found == nullptr ? "" : json::compact(*found);
    std::erase(text, ' ');
    return text;
  }
  return "no file " + file;
}

TEST(YangRedundancy, OfARingIsThis) {
  const Written ring = written("tsn/frer-ring.json");
  EXPECT_TRUE(ring.exported.losses.empty());
  // sw1 has the ring at ports 0 and 1 and h1 at port 2, whose stream goes both ways.
  EXPECT_EQ(part_of(ring.exported, "sw1.json", "ieee802-dot1cb-frer:frer"),
            R"({"sequence-generation":[{"index":1,"stream":[1],"direction-out-facing":true}],)"
            R"("stream-split":[{"port":"swp2","direction-out-facing":false,"input-id":[1],"output-id":[1000000,1000001]}],)"
            R"("sequence-identification":[{"port":"swp0","direction-out-facing":true,"stream":[1000000],"active":true,"encapsulation":{"r-tag":{}}},)"
            R"({"port":"swp1","direction-out-facing":true,"stream":[1000001],"active":true,"encapsulation":{"r-tag":{}}}]})");
  EXPECT_EQ(part_of(ring.exported, "sw3.json", "ieee802-dot1cb-frer:frer"),
            R"({"sequence-recovery":[{"index":1,"stream":[1000000,1000001],"port":["swp2"],"direction-out-facing":true,"algorithm":{"vector":{}},"history-length":16,"reset-timeout":10,)"
            R"("take-no-sequence":false,"individual-recovery":false,"latent-error-detection":true,"latent-error-detection-parameters":{"difference":4,"period":50,"paths":2,"reset-period":1000}}],)"
            R"("sequence-identification":[{"port":"swp0","direction-out-facing":true,"stream":[1000000],"active":false,"encapsulation":{"r-tag":{}}},)"
            R"({"port":"swp1","direction-out-facing":true,"stream":[1000001],"active":false,"encapsulation":{"r-tag":{}}}]})");
  EXPECT_EQ(part_of(ring.exported, "sw2.json", "ieee802-dot1cb-frer:frer"), "");
  EXPECT_EQ(part_of(ring.exported, "h1.json", "ieee802-dot1cb-frer:frer"), "");
}

TEST(YangRedundancy, OfHostsBeginsAboveTheirPorts) {
  const Written hosts = written("tsn/frer-hosts.json");
  EXPECT_TRUE(hosts.exported.losses.empty());
  const std::string identities = part_of(hosts.exported, "talker.json", "ieee802-dot1cb-stream-identification:stream-identity");
  EXPECT_TRUE(identities.starts_with(R"([{"index":1,"handle":1,"in-facing":{"input-port":["eth0"]},"null-stream-identification":)")) << identities;
  EXPECT_NE(part_of(hosts.exported, "listener.json", "ieee802-dot1cb-frer:frer").find(R"("individual-recovery":true)"), std::string::npos);
}

TEST(YangRedundancy, WhatTheTablesCannotSayIsTold) {
  const auto says = [](const Exported& exported, const std::string& what) {
    return std::ranges::any_of(exported.losses, [&](const Loss& loss) { return loss.what.find(what) != std::string::npos; });
  };
  EXPECT_TRUE(says(written("tsn/frer-ladder.json").exported, "a ladder"));
  EXPECT_TRUE(says(written("redundant-ring.json").exported, "a recovery across several interfaces"));
  EXPECT_TRUE(says(written("redundant-ring.json").exported, "a split across several interfaces"));
  EXPECT_TRUE(says(written("tsn/frer-ring.json", {"dialect=2018"}).exported, "no module of 2018"));
}

TEST(YangRedundancy, ComesInWithTheStreamsThatHaveIt) {
  const Written ring = written("tsn/frer-ring.json");
  std::vector<InputFile> files;
  for (const OutputFile& file : ring.exported.files) files.push_back({file.name, file.name.substr(0, file.name.find('.')), file.content});
  const Reading with = read("yang", files, &ring.resolved->scenario);
  ASSERT_TRUE(with.imported.scenario) << with.remarks();
  EXPECT_TRUE(with.lost());
  EXPECT_TRUE(with.imported.scenario->streams.front().redundancy);
  const Reading without = read("yang", files);
  EXPECT_FALSE(without.imported.scenario);
  EXPECT_NE(without.diagnostics.to_text().find("redundancy (802.1CB) of a device without its streams"), std::string::npos) << without.diagnostics.to_text();
}

}  // namespace
}  // namespace takt::interchange::test
