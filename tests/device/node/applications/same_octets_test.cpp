// SPDX-License-Identifier: Apache-2.0
// What simulated applications publish over OPC UA is, octet for octet, what the same applications publish as a real
// node.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "models/ethernet/traffic.hpp"
#include "node/applications/tasks.hpp"
#include "output/frame_octets.hpp"
#include "scenario/resolve.hpp"
#include "scenario/run/run.hpp"

namespace takt::node {
namespace {

using Message = std::vector<std::byte>;

constexpr std::size_t rounds = 4;

/// Two applications publish the same topic; another is laid out otherwise, with delta frames; a topic of DDS stands
/// before another one; arrays and single values. b listens only.
const std::string words = R"("topics": [
  {"name": "x", "protocol": "opc-ua", "fields": {"level": "UInt32", "axes": {"type": "Double", "count": 3}, "on": "Boolean"}},
  {"name": "none", "protocol": "dds", "fields": {"level": "UInt32"}},
  {"name": "y", "protocol": "opc-ua", "fields": {"text": {"type": "String", "max_length": 9}, "level": "Int16", "id": "Guid"},
   "uadp": {"publisher": {"uint64": 5000000000}, "encoding": "DataValue", "key_frame_count": 3, "data_set_message": ["SequenceNumber", "MajorVersion"], "major_version": 5}}],
 "applications": [
  {"name": "p", "on": "a", "threads": [{"name": "one", "publish": "x", "every": "1ms"}, {"name": "two", "publish": "y", "every": "1ms", "offset": "200us", "payload": {"pattern": "alternate", "values": {"text": "pump 3"}}}]},
  {"name": "s", "on": "b", "threads": [{"name": "one", "subscribe": "x", "every": "1ms"}, {"name": "two", "subscribe": "y", "every": "1ms"}]},
  {"name": "q", "on": "a", "threads": [{"name": "one", "publish": "x", "every": "1ms", "offset": "400us"}]}])";

/// The payloads of UDP of all frames, in the order in which they leave.
class Capture final : public sim::TraceSink {
 public:
  explicit Capture(const models::Network& network) : network_(network) {}
  void record(const sim::TraceRecord& record) override {
    if (record.kind != static_cast<std::uint32_t>(models::Occurrence::started)) return;
    output::FrameBuffer buffer{};
    const auto frame =
        output::encode_frame(network_, models::FrameIndex{static_cast<std::uint32_t>(record.what)}, buffer);
    constexpr std::size_t udp = 14 + 20;
    const std::size_t length =
        std::to_integer<std::size_t>(frame[udp + 4]) << 8 | std::to_integer<std::size_t>(frame[udp + 5]);
    const auto payload = frame.subspan(udp + 8, length - 8);
    messages.emplace_back(payload.begin(), payload.end());
  }
  std::vector<Message> messages;

 private:
  const models::Network& network_;
};

std::vector<Message> simulated() {
  const std::string text =
      R"({"name": "same", "duration": "3900us", "network": {"nodes": {"a": {"kind": "host"}, "b": {"kind": "host"}}, "links": [{"ends": ["a", "b"]}]}, )" +
      words + "}";
  json::Diagnostics diagnostics;
  const auto resolved = scenario::load_text(text, "same.json", {}, diagnostics);
  EXPECT_TRUE(resolved) << diagnostics.to_text();
  if (!resolved) return {};
  scenario::Run run(*resolved);
  Capture capture(run.network());
  run.simulation().set_trace(&capture);
  run.advance();
  return capture.messages;
}

class KeepingSocket final : public Socket {
 public:
  explicit KeepingSocket(std::vector<Message>& messages) : messages_(messages) {}
  void publish(uadp::Octets message, const pubsub::Destination&) override {
    messages_.emplace_back(message.begin(), message.end());
  }
  std::optional<Arrival> take() override { return std::nullopt; }
  int file_descriptor() const override { return -1; }
  std::uint64_t send_failures() const override { return 0; }
  std::string enable_launch_times(ClockName) override { return {}; }

 private:
  std::vector<Message>& messages_;
};

std::vector<Message> real() {
  const auto path = std::filesystem::temp_directory_path() / ("takt-same-" + std::to_string(::getpid()) + ".json");
  std::ofstream(path) << R"({"node": "a", "transport": {"kind": "udp", "destinations": ["239.0.0.1"]}, )" << words
                      << "}";
  json::Diagnostics diagnostics;
  const auto loaded = load_applications(path.string(), diagnostics);
  std::filesystem::remove(path);
  EXPECT_TRUE(loaded) << diagnostics.to_text();
  if (!loaded) return {};
  std::vector<Message> messages;
  OpcUaTopics topics(std::make_unique<KeepingSocket>(messages), [] { return std::int64_t{0}; });
  NewestSamples newest;
  std::vector<std::unique_ptr<Work>> works;
  for (const plant::Application& application : loaded->config.applications)
    for (const Thread& thread : application.threads) {
      const LoadedTopic& topic = loaded->topics[loaded->topic(*thread.publish)];
      works.push_back(make_publishing(
          topic.shape, topics.add_writer(topic, loaded->writer_groups.at({application.name, thread.name})),
          thread.payload.value_or(Payload{}), newest));
    }
  for (std::size_t round = 0; round < rounds; ++round)
    for (const auto& work : works) EXPECT_EQ(work->call(0).sent, 1u);
  return messages;
}

TEST(SameOctets, OfApplications) {
  const std::vector<Message> here = real();
  const std::vector<Message> there = simulated();
  ASSERT_EQ(here.size(), 3 * rounds);
  ASSERT_EQ(there.size(), 3 * rounds);
  for (std::size_t m = 0; m < here.size(); ++m) EXPECT_EQ(here[m], there[m]) << "message " << m;
  EXPECT_NE(here[0], here[2]) << "two publications of a topic are told apart";
}

}  // namespace
}  // namespace takt::node
