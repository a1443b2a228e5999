// SPDX-License-Identifier: Apache-2.0
// Samples of topics from their writers to readers, counted by hand: with Fast DDS's times the next HEARTBEAT is 3 s
// after the write, the ACKNACK 5 ms after that, the repair 5 ms after that, and each takes a way.
#include <gtest/gtest.h>

#include "analysis/bounds.hpp"
#include "models/ethernet/traffic.hpp"
#include "scenario/resolve.hpp"
#include "scenario/run/run.hpp"

namespace takt::analysis::delivery_bound_test {
namespace {

using sim::Duration;
using namespace sim::literals;  // NOLINT

std::shared_ptr<scenario::Resolved> plant(const std::string& qos, const std::string& every,
                                          const std::string& more = {}, const std::string& reader = {}) {
  const std::string text =
      R"({"name": "t", "duration": "12s", "network": {"nodes": {"a": {"kind": "host"}, "b": {"kind": "host"}}, "links": [{"ends": ["a", "b"], "delay": "0s"}]},
   "topics": [{"name": "sample", "protocol": "dds", "pcp": 4, "qos": {)" +
      qos + R"(}, "fields": {"level": "Int32"}}],
   "applications": [{"name": "sensor", "on": "a", "threads": [{"name": "publish", "publish": "sample", "every": ")" +
      every + R"(")" + (every == "10s" ? R"(, "offset": "2s")" : "") + R"(}]},
                    {"name": "actor", "on": "b", "threads": [{"name": "take", "subscribe": "sample", "every": "1ms")" +
      reader + R"(}]}])" + more + "}";
  json::Diagnostics diagnostics;
  auto resolved = scenario::load_text(text, "t.json", {}, diagnostics);
  EXPECT_NE(resolved, nullptr) << diagnostics.to_text();
  return resolved;
}
DeliveryBound delivery(const scenario::Resolved& r) {
  const Bounds bounds = bound(r);
  EXPECT_EQ(bounds.deliveries.size(), 1U);
  return bounds.deliveries.at(0);
}
const StreamBound& stream(const Bounds& bounds, const std::string& name) {
  return *std::ranges::find(bounds.streams, name, &StreamBound::name);
}

TEST(Deliveries, BestEffortIsOneWay) {
  const auto r = plant(R"("reliability": "best-effort")", "10s");
  const DeliveryBound found = delivery(*r);
  EXPECT_EQ(found.one_way, stream(bound(*r), "rtps-0/sensor/actor").latency);
  EXPECT_TRUE(found.reaches_all);
  EXPECT_FALSE(found.repaired);
  EXPECT_NE(found.repair_reason.find("best effort"), std::string::npos);
}

TEST(Deliveries, OneRepairIsTheHeartbeatAndTwoAnswersAndThreeWays) {
  const auto r = plant(R"("reliability": "reliable", "history": "keep-all")", "10s");
  const Bounds bounds = bound(*r);
  const Duration there = *stream(bounds, "rtps-0/sensor/actor").latency,
                 back = *stream(bounds, "rtps-0/actor/sensor").latency;
  EXPECT_EQ(bounds.deliveries.at(0).repaired, 3_s + 5_ms + 5_ms + there + there + back);
}

// A history of one sample has another one by then; of 31 samples 100 ms apart it has all that were written within
// the 3.01 s.
TEST(Deliveries, WhatIsReplacedIsNotSentAgain) {
  EXPECT_NE(delivery(*plant(R"("reliability": "reliable")", "100ms")).repair_reason.find("up to 31 samples"),
            std::string::npos);
  EXPECT_FALSE(delivery(*plant(R"("reliability": "reliable", "depth": 30)", "100ms")).repaired);
  EXPECT_TRUE(delivery(*plant(R"("reliability": "reliable", "depth": 31)", "100ms")).repaired);
  EXPECT_NE(delivery(*plant(R"("reliability": "reliable", "depth": 31, "lifespan": "3s")", "100ms"))
                .repair_reason.find("expire"),
            std::string::npos);
  EXPECT_NE(
      delivery(
          *plant(R"("reliability": "reliable", "history": "keep-all", "resource_limits": {"max_samples": 5})", "10s"))
          .repair_reason.find("resource limits"),
      std::string::npos);
}

TEST(Deliveries, WhatMayBeLostIsSaid) {
  const DeliveryBound found =
      delivery(*plant(R"("reliability": "reliable", "history": "keep-all")", "10s",
                      R"(, "faults": [{"kind": "frame-errors", "link": ["a", "b"], "loss": 0.1}])"));
  EXPECT_FALSE(found.reaches_all);
  EXPECT_NE(found.loss_reason.find("chance"), std::string::npos);
}

TEST(Deliveries, AFilterKeepsSamplesOut) {
  const DeliveryBound found =
      delivery(*plant(R"("reliability": "best-effort")", "10s", {}, R"(, "filter": "level > 5")"));
  EXPECT_TRUE(found.one_way);
  EXPECT_FALSE(found.reaches_all);
  EXPECT_NE(found.loss_reason.find("filter"), std::string::npos);
}

/// The last message with data on the stream, and when the first was made.
class Samples final : public sim::TraceSink {
 public:
  explicit Samples(const scenario::Run& run) : run_(run) {}
  void record(const sim::TraceRecord& record) override {
    const bool is_made = record.kind == static_cast<std::uint32_t>(models::Occurrence::produced);
    if (!is_made && record.kind != static_cast<std::uint32_t>(models::Occurrence::received)) return;
    const models::Frame& frame = run_.network().traffic().frame({static_cast<std::uint32_t>(record.what)});
    if (run_.resolved().plan.streams[frame.stream.value].name != "rtps-0/sensor/actor" ||
        record.time < sim::TrueTime() + 2_s)
      return;
    if (is_made && first_ == sim::TrueTime()) first_ = record.time;
    if (!is_made) last_ = record.time;
  }
  Duration between() const { return last_ - first_; }

 private:
  const scenario::Run& run_;
  sim::TrueTime first_, last_;
};

// The sample of 2 s is lost, and comes at last with its repair.
TEST(Deliveries, ARepairInARunIsNoLater) {
  const auto r = plant(
      R"("reliability": "reliable", "history": "keep-all")", "10s",
      R"(, "faults": [{"kind": "frame-errors", "link": ["a", "b"], "towards": "b", "loss": 1, "at": "1999ms", "for": "2ms"}])");
  const Bounds bounds = bound(*r);
  ASSERT_TRUE(bounds.deliveries.at(0).repaired) << bounds.deliveries.at(0).repair_reason;
  scenario::Run run(*r);
  Samples samples(run);
  run.simulation().set_trace(&samples);
  while (!run.advance(1)) {
    if (run.simulation().now() > sim::TrueTime() + 5_s + 100_ms) break;  // before the next HEARTBEAT
  }
  EXPECT_LE(samples.between(), *bounds.deliveries[0].repaired);
  EXPECT_GE(samples.between(), 3_s + 10_ms);
}

}  // namespace
}  // namespace takt::analysis::delivery_bound_test
