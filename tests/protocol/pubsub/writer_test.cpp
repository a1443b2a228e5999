// SPDX-License-Identifier: Apache-2.0
// What a DataSetWriter sends in which interval: key frames, delta frames, keep-alives, sequence numbers.
#include "tests/protocol/pubsub/support.hpp"
#include "uadp/data_set_message.hpp"
#include "uadp/network_message.hpp"

namespace takt::pubsub {
namespace {

using uadp::DataSetMessageType;
using Three = std::tuple<double, double, double>;

struct Sent {
  DataSetMessageType type;
  std::uint16_t sequence_number;
  std::size_t fields;
  bool operator==(const Sent&) const = default;
};

/// A publisher of three doubles in intervals of 1 ms.
struct WriterFixture {
  RecordingStack stack;
  Communication master{stack, stack};
  DataSet<Three> data;
  Publisher publisher;
  LocalTime now;

  explicit WriterFixture(const WriterGroupSettings& group, const DataSetWriterSettings& writer)
      : publisher(PublisherId::uint16(1), group) {
    EXPECT_TRUE(publisher.add_data_set("data", data, writer));
    master.add_publisher(publisher);
    master.enable(LocalTime());
  }
  /// One interval; what was sent in it.
  std::vector<Sent> step() {
    now += 1_ms;
    stack.messages.clear();
    master.advance(now);
    std::vector<Sent> sent;
    for (const auto& octets : stack.messages) {
      uadp::NetworkMessage message;
      EXPECT_EQ(decode(octets, message), uadp::DecodeStatus::ok);
      uadp::DataSetMessage each;
      EXPECT_EQ(decode(message.data_set_message(0), each), uadp::DecodeStatus::ok);
      EXPECT_TRUE(is_well_formed(each));
      sent.push_back({each.header.type, each.header.sequence_number.value(), uadp::FieldReader(each).count()});
    }
    return sent;
  }
};

constexpr auto key = DataSetMessageType::KeyFrame;
constexpr auto delta = DataSetMessageType::DeltaFrame;
constexpr auto alive = DataSetMessageType::KeepAlive;

TEST(Writers, AKeyFrameInEachInterval) {
  WriterFixture fixture({}, {});
  for (std::uint16_t i = 0; i < 3; ++i) EXPECT_EQ(fixture.step(), (std::vector<Sent>{{key, i, 3}}));
}

TEST(Writers, DeltaFramesBetween) {
  for (const auto encoding : {uadp::FieldEncoding::Variant, uadp::FieldEncoding::DataValue}) {
    DataSetWriterSettings settings;
    settings.key_frame_count = 4;
    settings.field_encoding = encoding;
    WriterFixture fixture({}, settings);
    EXPECT_EQ(fixture.step(), (std::vector<Sent>{{key, 0, 3}}));
    fixture.data.set({1, 0, 0});
    EXPECT_EQ(fixture.step(), (std::vector<Sent>{{delta, 1, 1}}));
    EXPECT_EQ(fixture.step(), std::vector<Sent>{}) << "nothing has changed";
    fixture.data.set({1, 2, 0});
    EXPECT_EQ(fixture.step(), (std::vector<Sent>{{delta, 2, 1}}));
    EXPECT_EQ(fixture.step(), (std::vector<Sent>{{key, 3, 3}})) << "four intervals after the last";
    fixture.data.set({5, 6, 7});
    EXPECT_EQ(fixture.step(), (std::vector<Sent>{{key, 4, 3}})) << "a delta frame would be longer";
  }
}

TEST(Writers, KeepAlivesTakeNoNumber) {
  WriterGroupSettings group;
  group.keep_alive_time = 2_ms;
  DataSetWriterSettings settings;
  settings.key_frame_count = 100;
  WriterFixture fixture(group, settings);
  EXPECT_EQ(fixture.step(), (std::vector<Sent>{{key, 0, 3}}));    // 1 ms
  EXPECT_EQ(fixture.step(), std::vector<Sent>{});                 // 2 ms
  EXPECT_EQ(fixture.step(), (std::vector<Sent>{{alive, 1, 0}}));  // 3 ms: silent for 2 ms
  EXPECT_EQ(fixture.step(), std::vector<Sent>{});
  EXPECT_EQ(fixture.step(), (std::vector<Sent>{{alive, 1, 0}}));
  fixture.data.set({1, 0, 0});
  EXPECT_EQ(fixture.step(), (std::vector<Sent>{{delta, 1, 1}}));
}

TEST(Writers, ADisabledWriterIsSilentAndBeginsWithAKeyFrame) {
  DataSetWriterSettings settings;
  settings.key_frame_count = 100;
  WriterFixture fixture({}, settings);
  fixture.step();
  EXPECT_EQ(fixture.master.disable(fixture.now), StatusCode::Good);
  EXPECT_EQ(fixture.step(), std::vector<Sent>{});
  EXPECT_EQ(fixture.master.enable(fixture.now), StatusCode::Good);
  EXPECT_EQ(fixture.step(), (std::vector<Sent>{{key, 1, 3}}));
}

// 134397081908376086 is a time of day in 2026; local time 1 ms is 10000 ticks later.
TEST(Writers, TimestampsCountFromTheEpoch) {
  WriterGroupSettings group;
  group.epoch = {134397081908376086};
  group.network_message_content_mask |= network_message_content::Timestamp;
  DataSetWriterSettings settings;
  settings.data_set_message_content_mask = data_set_message_content::dynamic;
  settings.minor_version = 5;
  WriterFixture fixture(group, settings);
  fixture.step();
  uadp::NetworkMessage message;
  ASSERT_EQ(decode(fixture.stack.messages.at(0), message), uadp::DecodeStatus::ok);
  EXPECT_EQ(message.header.timestamp, uadp::DateTime{134397081908386086});
  uadp::DataSetMessage each;
  ASSERT_EQ(decode(message.data_set_message(0), each), uadp::DecodeStatus::ok);
  EXPECT_EQ(each.header.timestamp, uadp::DateTime{134397081908386086});
  EXPECT_EQ(each.header.minor_version, 5u);
  EXPECT_FALSE(each.header.major_version);
}

}  // namespace
}  // namespace takt::pubsub
