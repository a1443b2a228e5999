// SPDX-License-Identifier: Apache-2.0
// Two real nodes over loopback, in each layout: what one publishes the other takes.
#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "node/applications/host.hpp"
#include "support/reservation.hpp"

namespace takt::node {
namespace {

struct Layout {
  const char* name;
  const char* uadp;
  bool has_numbers = true;  ///< so that losses would be seen
};

class Layouts : public ::testing::TestWithParam<Layout> {};

std::unique_ptr<LoadedApplications> load(const std::string& node, int own_port, int other_port) {
  json::Diagnostics diagnostics;
  auto loaded = load_applications_text(R"({"node": ")" + node + R"(",
    "topics": [{"name": "x", "protocol": "opc-ua", "fields": {"s": {"type": "String", "max_length": 12}, "n": "UInt32", "g": "Guid", "t": "DateTime", "b": {"type": "ByteString", "max_length": 4}, "v": {"type": "Double", "count": 8}},
                "uadp": )" + Layouts::GetParam().uadp +
                                           R"(}],
    "applications": [{"name": "p", "on": "a", "threads": [{"name": "t", "publish": "x", "every": "2ms",
                        "payload": {"pattern": "alternate", "values": {"s": "Förderer", "g": "72962b91-fa75-4ae6-8d28-b404dc7daf63", "t": "2024-01-17T21:20:00Z", "b": "00ff"}}}]},
                     {"name": "s", "on": "b", "threads": [{"name": "t", "subscribe": "x", "every": "2ms", "buffer": 1000, "signal": "lamp"}]}],
    "transport": {"kind": "udp", "interface": "lo", "port": )" +
                                           std::to_string(own_port) + R"(, "destinations": ["127.0.0.1:)" +
                                           std::to_string(other_port) + R"("]}})",
                                       "file", diagnostics);
  EXPECT_TRUE(loaded) << diagnostics.to_text();
  return loaded;
}

// The publisher alternates between 1 and 0, and every sample that is taken moves the output; with delta frames only if
// both kinds of frames are read aright.
TEST_P(Layouts, FromNodeToNode) {
  const auto reserved = testing::Reservation::ports();
  const auto a = load("a", reserved.number(), reserved.number() + 1);
  const auto b = load("b", reserved.number() + 1, reserved.number());
  ASSERT_TRUE(a && b);
  std::string problem;
  std::string warnings;
  const auto publisher = ApplicationHost::make(*a, problem, warnings);
  const auto subscriber = ApplicationHost::make(*b, problem, warnings);
  ASSERT_TRUE(publisher && subscriber) << problem;
  std::atomic<bool> is_over = false;
  const auto stop = [](const void* flag) { return static_cast<const std::atomic<bool>*>(flag)->load(); };
  std::thread listening([&] { subscriber->run(stop, &is_over); });
  std::atomic<int> asked = 0;
  publisher->run([](const void* count) { return ++*static_cast<std::atomic<int>*>(const_cast<void*>(count)) > 8; },
                 &asked);  // each time 50 ms later
  is_over = true;
  listening.join();
  const ThreadStatistics sent = publisher->statistics().at(0).threads.at(0);
  const ThreadStatistics taken = subscriber->statistics().at(0).threads.at(0);
  EXPECT_GT(sent.sent, 20u);
  EXPECT_EQ(sent.sent, sent.calls);
  if (GetParam().has_numbers) {
    EXPECT_EQ(taken.taken + taken.lost, sent.sent);
  }
  EXPECT_GE(taken.taken + 5, sent.sent);
  ASSERT_TRUE(taken.signal);
  EXPECT_GT(taken.signal->figures.latency.count(), 1u) << "values change";
}

INSTANTIATE_TEST_SUITE_P(
    All, Layouts,
    ::testing::Values(
        Layout{"Usual", "{}"}, Layout{"RawData", R"({"encoding": "RawData"})"},
        Layout{
            "DataValue",
            R"({"encoding": "DataValue", "data_value": ["StatusCode", "SourceTimestamp", "ServerTimestamp", "SourcePicoSeconds", "ServerPicoSeconds"]})"},
        Layout{"DeltaFrames", R"({"key_frame_count": 10})"},
        Layout{"DeltaDataValues",
               R"({"key_frame_count": 3, "encoding": "DataValue", "data_value": ["SourceTimestamp"]})"},
        Layout{"Byte", R"({"publisher": {"byte": 200}})"}, Layout{"UInt32", R"({"publisher": {"uint32": 4000000000}})"},
        Layout{"UInt64", R"({"publisher": {"uint64": 18446744073709551615}})"},
        Layout{"String", R"({"publisher": {"string": "Zelle/Förderer"}})"},
        Layout{
            "NoPublisherId",
            R"({"network_message": ["GroupHeader", "WriterGroupId", "PayloadHeader"], "writer_group_id": 700, "data_set_writer_id": 8})"},
        Layout{
            "PeriodicFixed",
            R"({"network_message": ["PublisherId", "GroupHeader", "WriterGroupId", "GroupVersion", "NetworkMessageNumber", "SequenceNumber"], "data_set_message": ["Status", "SequenceNumber"], "encoding": "RawData", "group_version": 760000000})"},
        Layout{
            "Everything",
            R"({"network_message": ["PublisherId", "GroupHeader", "WriterGroupId", "GroupVersion", "NetworkMessageNumber", "SequenceNumber", "PayloadHeader", "Timestamp", "PicoSeconds"],
                                               "data_set_message": ["Timestamp", "PicoSeconds", "Status", "MajorVersion", "MinorVersion", "SequenceNumber"], "major_version": 760000001, "minor_version": 760000002})"},
        Layout{"ConfiguredSize", R"({"configured_size": 300})"},
        Layout{"ConfiguredSizeOfDeltaFrames", R"({"configured_size": 301, "key_frame_count": 4})"},
        Layout{
            "ConfiguredSizeOfRawData",
            R"({"configured_size": 1400, "encoding": "RawData", "network_message": ["PublisherId"], "data_set_message": ["SequenceNumber"]})"},
        Layout{"Nothing", R"({"network_message": [], "data_set_message": []})", false}),
    [](const auto& each) { return std::string(each.param.name); });

}  // namespace
}  // namespace takt::node
