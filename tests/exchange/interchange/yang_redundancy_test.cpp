// SPDX-License-Identifier: Apache-2.0
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
  EXPECT_EQ(
      part_of(ring.exported, "sw1.json", "ieee802-dot1cb-frer:frer"),
      R"({"sequence-generation":[{"index":1,"stream":[1],"direction-out-facing":true}],)"
      R"("stream-split":[{"port":"swp2","direction-out-facing":false,"input-id":[1],"output-id":[1000000,1000001]}],)"
      R"("sequence-identification":[{"port":"swp0","direction-out-facing":true,"stream":[1000000],"active":true,"encapsulation":{"r-tag":{}}},)"
      R"({"port":"swp1","direction-out-facing":true,"stream":[1000001],"active":true,"encapsulation":{"r-tag":{}}}]})");
  EXPECT_EQ(
      part_of(ring.exported, "sw3.json", "ieee802-dot1cb-frer:frer"),
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
  const std::string identities =
      part_of(hosts.exported, "talker.json", "ieee802-dot1cb-stream-identification:stream-identity");
  EXPECT_TRUE(identities.starts_with(
      R"([{"index":1,"handle":1,"in-facing":{"input-port":["eth0"]},"null-stream-identification":)"))
      << identities;
  EXPECT_NE(part_of(hosts.exported, "listener.json", "ieee802-dot1cb-frer:frer").find(R"("individual-recovery":true)"),
            std::string::npos);
}

TEST(YangRedundancy, WhatTheTablesCannotSayIsTold) {
  const auto says = [](const Exported& exported, const std::string& what) {
    return std::ranges::any_of(exported.losses,
                               [&](const Loss& loss) { return loss.what.find(what) != std::string::npos; });
  };
  EXPECT_TRUE(says(written("tsn/frer-ladder.json").exported, "a ladder"));
  EXPECT_TRUE(says(written("redundant-ring.json").exported, "a recovery across several interfaces"));
  EXPECT_TRUE(says(written("redundant-ring.json").exported, "a split across several interfaces"));
  EXPECT_TRUE(says(written("tsn/frer-ring.json", {"dialect=2018"}).exported, "no module of 2018"));
}

/// The scenario without what the tables say of redundancy: without all of it, or with nothing but the ways of the
/// copies.
scenario::Scenario without_redundancy(const scenario::Scenario& whole) {
  scenario::Scenario bare = whole;
  for (scenario::Stream& stream : bare.streams) {
    if (!stream.redundancy) continue;
    const auto paths = stream.redundancy->paths;
    stream.redundancy.reset();
    if (paths) stream.redundancy.emplace().paths = paths;
  }
  return bare;
}

/// A copy in which one thing is otherwise than by default, so that it must come back.
struct Varied {
  const char* name;
  const char* scenario;
  void (*change)(scenario::Redundancy& redundancy);
};

TEST(YangRedundancy, ComesBackToStreamsThatHaveNone) {
  using scenario::Redundancy;
  const Varied all[] = {
      {"a ring", "tsn/frer-ring.json", [](Redundancy&) {}},
      {"hosts, by VLANs of their own", "tsn/frer-hosts.json", [](Redundancy&) {}},
      {"a published validation", "validation/frer.json", [](Redundancy&) {}},
      {"matching", "tsn/frer-ring.json", [](Redundancy& r) { r.algorithm = scenario::Recovery::match; }},
      {"other times", "tsn/frer-ring.json",
       [](Redundancy& r) {
         r.reset_timeout = sim::Duration::from_ps(7'000'000'000);
         r.latent_errors->difference = 9;
         r.latent_errors->reset_period = sim::Duration::from_ps(3'000'000'000);
       }},
      {"each copy by itself", "tsn/frer-ring.json", [](Redundancy& r) { r.individual = true; }},
      {"frames without a number", "tsn/frer-ring.json",
       [](Redundancy& r) {
         r.take_untagged = true;
         r.latent_errors.reset();
       }},
      {"the tag stays", "tsn/frer-ring.json", [](Redundancy& r) { r.keep_tag = true; }},
      {"numbered by the talker", "tsn/frer-ring.json", [](Redundancy& r) { r.number = "h1"; }},
  };
  for (const Varied& each : all) {
    for (const char* const encoding : {"encoding=json", "encoding=xml"}) {
      SCOPED_TRACE(std::string(each.name) + ", " + encoding);
      json::Diagnostics diagnostics;
      scenario::Scenario said =
          scenario::load_file(std::filesystem::path(TAKT_SOURCE_DIR) / "scenarios" / each.scenario, {}, diagnostics)
              ->scenario;
      each.change(*said.streams.front().redundancy);
      const auto resolved = load(sparse_text(said), each.scenario);
      ASSERT_TRUE(resolved);
      const ExportFormat* const yang = find_export_format("yang");
      std::string mistake;
      const Exported exported =
          yang->write({*resolved, {}, *Settings::read(std::vector<std::string>{encoding}, yang->settings, mistake)});
      ASSERT_TRUE(exported.losses.empty()) << exported.losses.front().what;
      const scenario::Scenario bare = without_redundancy(said);
      const Reading reading = read("yang", inputs(exported), &bare);
      ASSERT_TRUE(reading.imported.scenario) << reading.remarks();
      EXPECT_FALSE(reading.lost()) << reading.remarks();
      const auto again = load(sparse_text(*reading.imported.scenario), each.scenario);
      ASSERT_TRUE(again);
      const sim::Duration duration = sim::Duration::from_ps(100'000'000'000);
      EXPECT_EQ(digest_of(*again, duration), digest_of(*resolved, duration));
      scenario::Redundancy found = *reading.imported.scenario->streams.front().redundancy,
                           wanted = *said.streams.front().redundancy;
      EXPECT_EQ(found.individual, wanted.individual);
      EXPECT_EQ(found.keep_tag, wanted.keep_tag);
      EXPECT_EQ(found.take_untagged, wanted.take_untagged);
      EXPECT_EQ(found.algorithm, wanted.algorithm);
      EXPECT_EQ(found.history, wanted.history);
      EXPECT_EQ(found.reset_timeout, wanted.reset_timeout);
      EXPECT_EQ(found.vlans, wanted.vlans);
      ASSERT_EQ(found.latent_errors.has_value(), wanted.latent_errors.has_value());
      if (found.latent_errors) {
        EXPECT_EQ(found.latent_errors->difference, wanted.latent_errors->difference);
      }
    }
  }
}

TEST(YangRedundancy, ThatIsNotWholeIsRefusedAtItsPlace) {
  const Written ring = written("tsn/frer-ring.json");
  const std::vector<InputFile> files = inputs(ring.exported);
  const scenario::Scenario bare = without_redundancy(ring.resolved->scenario);
  const auto said = [&](std::vector<InputFile> some, const scenario::Scenario* base) {
    const Reading reading = read("yang", std::move(some), base);
    EXPECT_FALSE(reading.imported.scenario);
    return reading.diagnostics.to_text();
  };
  const auto but = [&](const std::string& name) {
    std::vector<InputFile> some = files;
    std::erase_if(some, [&](const InputFile& each) { return each.name == name; });
    return some;
  };
  const auto with = [&](const std::string& name, const std::string& text, const std::string& other) {
    std::vector<InputFile> some = files;
    InputFile& file = *std::ranges::find(some, name, &InputFile::name);
    const std::size_t at = file.text.find(text);
    EXPECT_NE(at, std::string::npos) << text;
    file.text.replace(at, text.size(), other);
    return some;
  };
  EXPECT_NE(said(files, nullptr).find("redundancy (802.1CB) of a device without its streams"), std::string::npos);
  EXPECT_NE(said(but("sw3.json"), &bare).find("redundancy that is recovered nowhere: stream \"control\""),
            std::string::npos);
  EXPECT_NE(said(but("sw1.json"), &bare).find("redundancy that is split nowhere: stream \"control\""),
            std::string::npos);
  EXPECT_NE(said(but("takt.names.json"), &bare).find("an address of no stream"), std::string::npos);
  EXPECT_NE(said(with("sw3.json", "1000001", "1000007"), &bare).find("handle 1000007"), std::string::npos);
  scenario::Scenario another = bare;
  std::erase_if(another.streams, [](const scenario::Stream& each) { return each.name == "control"; });
  another.require.clear();
  EXPECT_NE(said(files, &another).find("redundancy of a stream that the base has not"), std::string::npos);
  scenario::Scenario three = ring.resolved->scenario;
  three.streams.front().redundancy->count.reset();
  three.streams.front().redundancy->paths = std::vector<std::vector<std::string>>(3);
  EXPECT_NE(said(files, &three).find("another number of copies than the base has ways"), std::string::npos);
}

}  // namespace
}  // namespace takt::interchange::test
