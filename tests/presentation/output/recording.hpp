// SPDX-License-Identifier: Apache-2.0
// What the tests of recorders share: a small busy network, and a folder for what they write.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>

#include "models/ethernet/sizes.hpp"
#include "models/port_directory.hpp"
#include "tests/models/network_fixture.hpp"

namespace takt::output::test {

using namespace models::test;
using models::Occurrence;

/// A folder that goes away with the test.
class Folder {
 public:
  Folder() {
    const testing::TestInfo& test = *testing::UnitTest::GetInstance()->current_test_info();
    path_ = std::filesystem::temp_directory_path() /
            ("takt-" + std::to_string(::getpid()) + "-" + test.test_suite_name() + "-" + test.name());
    std::filesystem::create_directories(path_);
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::string operator/(const std::string& name) const { return (path_ / name).string(); }
  bool empty() const { return std::filesystem::is_empty(path_); }

 private:
  std::filesystem::path path_;
};

inline std::string content_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// a, b - sw - c, d at 100 Mb/s: a tagged UDP stream with octets from a to c, an untagged one without from b to a group
/// {c, d}, raw Ethernet from d to a, and from c to d what makes the queue of the switch towards d overflow.
struct Plant {
  Plant() {
    a = builder.host("cell \"A\"");
    b = builder.host("b");
    sw = builder.bridge("sw", 1_us, builder.port_config(limited()));
    c = builder.host("c");
    d = builder.host("d");
    for (const models::NodeIndex host : {a, b, c, d}) builder.link(host, sw, 100_Mbps, 50_ns);
    axes = builder.stream(a, {c}, {models::Priority{4}, 5, models::ipv4_and_udp_headers});
    camera = builder.stream(b, {c, d}, {std::nullopt, 0, models::ipv4_and_udp_headers});
    raw = builder.stream(d, {a}, {models::Priority{6}, 0, models::Octets{0}});
    noise = builder.stream(c, {d});
    builder.send_at(noise, 1000_B, {0_us, 0_us, 0_us});
    builder.send_at(camera, 1000_B, {0_us, 0_us, 0_us, 1_ms});
    builder.send_at(raw, 1500_B, {10_us, 10_us});
    plan = builder.plan;
  }
  static models::PortConfig limited() {
    models::PortConfig config;
    config.queue_limits[config.traffic_class_of_priority[0]].frames = 1;
    return config;
  }
  /// A run with the sender of `axes` installed: 14 octets at 0, 100 us and 100 us.
  void install_axes(models::Network& network) const {
    const std::vector<Sender::Item> items = {
        {local(0_us), axes, 14}, {local(100_us), axes, 14}, {local(100_us), axes, 14}};
    install<Sender>(network, a, "axes", items);
  }

  /// How many frames of a stream have left ports.
  static std::map<models::StreamIndex, int> sent_by_ports(const Plant& plant) {
    struct Counter final : sim::TraceSink {
      void record(const sim::TraceRecord& record) override {
        if (record.kind == static_cast<std::uint32_t>(Occurrence::started))
          ++frames[network->traffic().frame({static_cast<std::uint32_t>(record.what)}).stream];
      }
      const models::Network* network = nullptr;
      std::map<models::StreamIndex, int> frames;
    } counter;
    NetworkRun run(plant.plan);
    counter.network = &*run.network;
    plant.install_axes(*run.network);
    run.simulation.set_trace(&counter);
    run.until(2_ms);
    return counter.frames;
  }

  PlanBuilder builder;
  models::NodeIndex a, b, sw, c, d;
  models::StreamIndex axes, camera, raw, noise;
  models::NetworkPlan plan;
};

}  // namespace takt::output::test
