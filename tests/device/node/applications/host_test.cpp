// SPDX-License-Identifier: Apache-2.0
// Threads of applications over a real socket: what one publishes another copies and a third takes.
#include "node/applications/host.hpp"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "support/reservation.hpp"

namespace takt::node {
namespace {

constexpr std::uint16_t report_id = 32;
constexpr int enough = 20;

/// Hears what the host sends, too.
class Listener {
 public:
  explicit Listener(std::uint16_t port) {
    sockaddr_in here = {};
    here.sin_family = AF_INET;
    here.sin_port = htons(port);
    here.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(::bind(socket_, reinterpret_cast<const sockaddr*>(&here), sizeof here), 0);
  }
  ~Listener() { ::close(socket_); }
  /// Whether so many messages of the report were sent; its PublisherId stands behind the two octets of flags.
  bool has_heard_enough() const {
    unsigned char octets[1500];
    while (::recv(socket_, octets, sizeof octets, 0) >= 4)
      if (octets[2] + 256 * octets[3] == report_id) ++heard_;
    return heard_ >= enough;
  }

 private:
  int socket_ = ::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  mutable int heard_ = 0;
};

TEST(ApplicationHost, AChainOfThreeRolesTakesWhatItPublishes) {
  const auto path = std::filesystem::temp_directory_path() / ("takt-host-" + std::to_string(::getpid()) + ".json");
  const auto reserved = testing::Reservation::ports();
  const std::string port = std::to_string(reserved.number());
  const auto listener_port = static_cast<std::uint16_t>(reserved.number() + 1);
  const Listener listener(listener_port);
  std::ofstream(path) << R"({
    "node": "all",
    "topics": [{"name": "process", "protocol": "opc-ua", "publisher_id": 31, "fields": {"v": {"type": "Double", "count": 4}}}, {"name": "report", "protocol": "opc-ua", "publisher_id": 32, "fields": {"v": {"type": "Double", "count": 4}}}],
    "applications": [
      {"name": "update", "on": "all", "threads": [{"name": "publish", "publish": "process", "every": "5ms"}]},
      {"name": "control", "on": "all", "threads": [{"name": "subscribe", "subscribe": "process", "every": "5ms", "offset": "1ms", "buffer": 1000},
                                      {"name": "publish", "publish": "report", "every": "5ms", "offset": "3ms", "payload": {"copy_of": "process"}}]},
      {"name": "diagnose", "on": "all", "threads": [{"name": "subscribe", "subscribe": "report", "every": "5ms", "offset": "4ms", "buffer": 1000}]}],
    "transport": {"kind": "udp", "interface": "lo", "port": )" +
                             port + R"(, "destinations": ["127.0.0.1", "127.0.0.1:)" + std::to_string(listener_port) +
                             R"("]}})";
  json::Diagnostics diagnostics;
  const auto loaded = load_applications(path.string(), diagnostics);
  std::filesystem::remove(path);
  ASSERT_TRUE(loaded) << diagnostics.to_text();
  std::string problem;
  std::string warnings;
  const auto host = ApplicationHost::make(*loaded, problem, warnings);
  ASSERT_TRUE(host) << problem;
  host->run([](const void* heard) { return static_cast<const Listener*>(heard)->has_heard_enough(); }, &listener);
  const auto statistics = host->statistics();
  ASSERT_EQ(statistics.size(), 3u);
  const ThreadStatistics& update = statistics[0].threads[0];
  const ThreadStatistics& control = statistics[1].threads[0];
  const ThreadStatistics& report = statistics[1].threads[1];
  const ThreadStatistics& diagnose = statistics[2].threads[0];
  // How often a thread is let run is this machine's matter. What holds on every machine: nothing is lost within it.
  EXPECT_EQ(update.sent, update.calls);
  EXPECT_EQ(control.taken, update.sent);
  EXPECT_EQ(control.lost + diagnose.lost, 0u);
  EXPECT_LE(report.sent, report.calls);
  EXPECT_GE(report.sent, static_cast<std::uint64_t>(enough));
  EXPECT_EQ(diagnose.taken, report.sent);
  EXPECT_EQ(update.window_ns, 10'000'000);
  for (const ApplicationStatistics& application : statistics)
    for (const ThreadStatistics& thread : application.threads) {
      EXPECT_EQ(thread.late.count(), thread.calls);
      EXPECT_EQ(thread.call_windows.expected, 2 * thread.call_windows.tests);
      EXPECT_LE(thread.call_windows.counted, thread.call_windows.expected);
    }
  const std::string json = to_json(host->report());
  EXPECT_NE(json.find("\"criterion_1\""), std::string::npos);
}

// The publisher alternates, so each sample that is taken changes the output. How late the machine is nobody knows; it
// is not earlier than the drawn response.
TEST(ApplicationHost, ASignalFollowsWhatAThreadTakesAfterItsResponse) {
  const auto reserved = testing::Reservation::ports();
  const auto listener_port = static_cast<std::uint16_t>(reserved.number() + 1);
  const Listener listener(listener_port);
  json::Diagnostics diagnostics;
  const auto loaded =
      load_applications_text(R"({
    "node": "all",
    "topics": [{"name": "level", "protocol": "opc-ua", "publisher_id": 32, "fields": {"v": "Int32"}}],
    "applications": [
      {"name": "update", "on": "all", "threads": [{"name": "publish", "publish": "level", "every": "5ms", "payload": "alternate"}]},
      {"name": "control", "on": "all", "threads": [{"name": "subscribe", "subscribe": "level", "every": "5ms", "response": "2ms", "signal": {"name": "valve", "pulse": "5ms"}, "buffer": 1000},
                                                   {"name": "never", "subscribe": "level", "every": "5ms", "response": "5ms", "signal": "stuck"}]}],
    "transport": {"kind": "udp", "interface": "lo", "port": )" +
                                 std::to_string(reserved.number()) + R"(, "destinations": ["127.0.0.1", "127.0.0.1:)" +
                                 std::to_string(listener_port) + R"("]}})",
                             "file", diagnostics);
  ASSERT_TRUE(loaded) << diagnostics.to_text();
  std::string problem;
  std::string warnings;
  const auto host = ApplicationHost::make(*loaded, problem, warnings);
  ASSERT_TRUE(host) << problem;
  host->run([](const void* heard) { return static_cast<const Listener*>(heard)->has_heard_enough(); }, &listener);
  const auto statistics = host->statistics();
  const ThreadStatistics& taking = statistics[1].threads[0];
  EXPECT_EQ(taking.response.count(), taking.calls);
  EXPECT_GE(taking.response.least(), 2'000'000);
  ASSERT_TRUE(taking.signal);
  const application::PulseFigures& figures = taking.signal->figures;
  EXPECT_EQ(taking.signal->name, "valve");
  EXPECT_GT(figures.latency.count(), 0u);
  EXPECT_LE(figures.latency.count(), taking.taken);
  EXPECT_GE(figures.latency.least(), sim::Duration::from_ps(2'000'000'000));
  EXPECT_EQ(figures.pulses.count(), figures.latency.count() / 2);  // each second edge is a fall
  const ThreadStatistics& never = statistics[1].threads[1];
  EXPECT_EQ(never.calls, 0u);
  EXPECT_GT(never.missed, 0u);
  EXPECT_EQ(never.signal->figures.latency.count(), 0u);
  EXPECT_FALSE(statistics[0].threads[0].signal);
  const std::string json = to_json(host->report());
  EXPECT_NE(json.find(R"("signal": {"name": "valve", "nominal_ns": 5000000,)"), std::string::npos) << json;
  EXPECT_NE(to_text(host->report()).find("control signal valve: "), std::string::npos);
}

}  // namespace
}  // namespace takt::node
