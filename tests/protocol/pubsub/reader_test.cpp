// SPDX-License-Identifier: Apache-2.0
// What a DataSetReader takes, and its time-out. Also: frames of an independent stack.
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/protocol/pubsub/support.hpp"
#include "uadp/data_set_message_encoder.hpp"

namespace takt::pubsub {
namespace {

using uadp::DataSetMessageHeader;
using uadp::DataSetMessageType;
using Two = std::tuple<std::int32_t, double>;

struct ReaderFixture {
  DataSet<Two> data;
  DataSetReader reader;
  std::vector<PubSubState> states;
  std::array<std::byte, 128> buffer{};
  int notified = 0;

  explicit ReaderFixture(sim::Duration timeout = {}, std::optional<std::uint32_t> major = {})
      : reader("data", data, {1, timeout, major}) {
    reader.on_state([this](PubSubState, PubSubState to) { states.push_back(to); });
    data.on_received([this](const Two&) { ++notified; });
  }

  static DataSetMessageHeader header(DataSetMessageType type, std::uint16_t sequence_number) {
    DataSetMessageHeader header;
    header.type = type;
    header.sequence_number = sequence_number;
    return header;
  }
  void send(const DataSetMessageHeader& header, std::optional<std::int32_t> first, std::optional<double> second,
            LocalTime now) {
    uadp::Writer writer(buffer);
    uadp::DataSetMessageEncoder encoder(writer);
    encoder.begin(header);
    const bool is_delta = header.type == DataSetMessageType::DeltaFrame;
    if (first && is_delta) encoder.delta_field(0, *first);
    if (second && is_delta) encoder.delta_field(1, *second);
    if (first && !is_delta) encoder.field(*first);
    if (second && !is_delta) encoder.field(*second);
    encoder.end();
    reader.take(writer.finished(), now);
  }
  void key(std::uint16_t sequence_number, std::int32_t value, LocalTime now = LocalTime()) {
    send(header(DataSetMessageType::KeyFrame, sequence_number), value, 0.0, now);
  }
  std::int32_t value() const { return std::get<0>(data.get()); }
};

TEST(Readers, TakeNewerMessagesOnly) {
  ReaderFixture fixture;
  fixture.key(65535, 1);
  fixture.key(65535, 2);
  EXPECT_EQ(fixture.value(), 1) << "the same again";
  fixture.key(0, 3);
  EXPECT_EQ(fixture.value(), 3) << "rolled over";
  fixture.key(65535, 4);
  EXPECT_EQ(fixture.value(), 3) << "overtaken";
  fixture.key(30000, 5);
  EXPECT_EQ(fixture.value(), 3) << "too far";
  fixture.key(3, 6);
  EXPECT_EQ(fixture.value(), 6);
  EXPECT_EQ(fixture.reader.missed(), 2u);
  EXPECT_EQ(fixture.reader.counts(), (ReaderCounts{.taken = 3, .not_newer = 3}));
  EXPECT_EQ(fixture.notified, 3);
}

// Message 2 is lost, which may have changed the field that 3 does not have.
TEST(Readers, DeltaFramesBehindAGapNeedAKeyFrameWhereThatIsAsked) {
  DataSet<Two> data;
  DataSetReader reader("data", data, {.data_set_writer_id = 1, .needs_key_after_gap = true});
  reader.set_parent(PubSubState::Operational);
  const auto take = [&](DataSetMessageType type, std::uint16_t number, std::int32_t value) {
    std::array<std::byte, 64> buffer{};
    uadp::Writer writer(buffer);
    uadp::DataSetMessageEncoder encoder(writer);
    encoder.begin(ReaderFixture::header(type, number));
    if (type == DataSetMessageType::KeyFrame) encoder.field(value), encoder.field(0.5);
    if (type == DataSetMessageType::DeltaFrame) encoder.delta_field(0, value);
    encoder.end();
    reader.take(writer.finished(), LocalTime());
    return std::get<0>(data.get());
  };
  EXPECT_EQ(take(DataSetMessageType::KeyFrame, 65534, 1), 1);
  EXPECT_EQ(take(DataSetMessageType::DeltaFrame, 65535, 2), 2);
  EXPECT_EQ(take(DataSetMessageType::DeltaFrame, 0, 3), 3);
  EXPECT_EQ(take(DataSetMessageType::DeltaFrame, 3, 4), 3);
  EXPECT_EQ(take(DataSetMessageType::DeltaFrame, 4, 5), 3);
  EXPECT_EQ(reader.counts().without_key, 2u);
  EXPECT_EQ(take(DataSetMessageType::KeyFrame, 5, 6), 6);
  EXPECT_EQ(take(DataSetMessageType::DeltaFrame, 6, 7), 7);
  EXPECT_EQ(reader.missed(), 4u);
}

TEST(Readers, DeltaFramesNeedAKeyFrame) {
  ReaderFixture fixture;
  fixture.send(ReaderFixture::header(DataSetMessageType::DeltaFrame, 0), 9, std::nullopt, LocalTime());
  EXPECT_EQ(fixture.reader.state(), PubSubState::PreOperational);
  EXPECT_EQ(fixture.value(), 0);
  fixture.key(1, 5);
  fixture.send(ReaderFixture::header(DataSetMessageType::DeltaFrame, 2), std::nullopt, 2.5, LocalTime());
  EXPECT_EQ(fixture.data.get(), (Two{5, 2.5}));
  EXPECT_EQ(fixture.reader.counts(), (ReaderCounts{.taken = 2, .without_key = 1}));
}

TEST(Readers, AMessageIsTakenWholeOrNotAtAll) {
  ReaderFixture fixture;
  fixture.key(0, 5);
  fixture.send(ReaderFixture::header(DataSetMessageType::KeyFrame, 1), 6, std::nullopt, LocalTime());
  EXPECT_EQ(fixture.value(), 5) << "a field is missing";
  uadp::Writer writer(fixture.buffer);
  uadp::DataSetMessageEncoder encoder(writer);
  encoder.begin(ReaderFixture::header(DataSetMessageType::KeyFrame, 1));
  encoder.field(std::int32_t{6});
  encoder.field(std::string_view("not a double"));
  encoder.end();
  fixture.reader.take(writer.finished(), LocalTime());
  EXPECT_EQ(fixture.value(), 5) << "another type";
  EXPECT_EQ(fixture.reader.counts().mismatched, 2u);
  fixture.key(1, 7);
  EXPECT_EQ(fixture.value(), 7) << "what was not taken has used up no number";
}

TEST(Readers, OtherVersionsAndInvalidMessages) {
  ReaderFixture fixture({}, 7);
  DataSetMessageHeader header = ReaderFixture::header(DataSetMessageType::KeyFrame, 0);
  header.major_version = 8;
  fixture.send(header, 1, 1.0, LocalTime());
  header.major_version = 7;
  header.valid = false;
  fixture.send(header, 1, 1.0, LocalTime());
  EXPECT_EQ(fixture.reader.counts(), (ReaderCounts{.not_valid = 1, .other_version = 1}));
  header.valid = true;
  fixture.send(header, 1, 1.0, LocalTime());
  EXPECT_EQ(fixture.value(), 1);
}

// OPC 10000-14, 6.2.9.6: the time-out starts with Operational, restarts with each new message, keep-alives included.
TEST(Readers, MessageReceiveTimeout) {
  ReaderFixture fixture(10_ms);
  EXPECT_EQ(fixture.reader.next_time(), LocalTime::never());
  fixture.key(0, 1, at(1_ms));
  EXPECT_EQ(fixture.reader.next_time(), at(11_ms));
  fixture.send(ReaderFixture::header(DataSetMessageType::KeepAlive, 1), {}, {}, at(5_ms));
  EXPECT_EQ(fixture.reader.next_time(), at(15_ms));
  fixture.send(ReaderFixture::header(DataSetMessageType::KeepAlive, 1), {}, {}, at(6_ms));
  EXPECT_EQ(fixture.reader.next_time(), at(16_ms)) << "a keep-alive repeats its number";
  fixture.key(0, 2, at(7_ms));
  EXPECT_EQ(fixture.reader.next_time(), at(16_ms)) << "an old message is no life sign";
  fixture.reader.advance(at(16_ms) - 1_ps);
  EXPECT_EQ(fixture.reader.state(), PubSubState::Operational);
  fixture.reader.advance(at(16_ms));
  EXPECT_EQ(fixture.reader.state(), PubSubState::Error);
  EXPECT_EQ(fixture.reader.failure(), StatusCode::BadTimeout);
  EXPECT_EQ(fixture.reader.next_time(), LocalTime::never());
  fixture.key(40000, 3, at(20_ms));
  EXPECT_EQ(fixture.value(), 3) << "after the silence any number is the first";
  EXPECT_EQ(fixture.reader.next_time(), at(30_ms));
  EXPECT_EQ(fixture.states,
            (std::vector<PubSubState>{PubSubState::Operational, PubSubState::Error, PubSubState::Operational}));
}

TEST(Readers, APausedReaderIsDeaf) {
  ReaderFixture fixture(10_ms);
  fixture.key(0, 1);
  fixture.reader.set_parent(PubSubState::Paused);
  EXPECT_EQ(fixture.reader.state(), PubSubState::Paused);
  EXPECT_EQ(fixture.reader.next_time(), LocalTime::never());
  fixture.key(1, 2);
  EXPECT_EQ(fixture.value(), 1);
  fixture.reader.set_parent(PubSubState::Operational);
  EXPECT_EQ(fixture.reader.state(), PubSubState::PreOperational);
  fixture.key(0, 3);
  EXPECT_EQ(fixture.value(), 3);
  EXPECT_EQ(fixture.reader.disable(), StatusCode::Good);
  EXPECT_EQ(fixture.reader.disable(), StatusCode::BadInvalidState);
  EXPECT_EQ(fixture.reader.state(), PubSubState::Disabled);
  EXPECT_EQ(fixture.reader.enable(), StatusCode::Good);
  EXPECT_EQ(fixture.reader.enable(), StatusCode::BadInvalidState);
}

// OPC 10000-14, 7.2.4.5.5: the header of a key frame alone. It is a sign of life and nothing else.
TEST(Readers, AHeartbeatIsNoSample) {
  ReaderFixture fixture(10_ms);
  const DataSetMessageHeader header = ReaderFixture::header(DataSetMessageType::KeyFrame, 0);
  fixture.send(header, {}, {}, at(1_ms));
  EXPECT_EQ(fixture.notified, 0);
  EXPECT_EQ(fixture.reader.counts(), (ReaderCounts{.keep_alives = 1}));
  EXPECT_EQ(fixture.reader.state(), PubSubState::PreOperational) << "no key frame with values has come";
  fixture.send(ReaderFixture::header(DataSetMessageType::DeltaFrame, 1), 9, {}, at(2_ms));
  EXPECT_EQ(fixture.value(), 0) << "nor is it one for delta frames";
  fixture.key(1, 5, at(3_ms));
  fixture.send(ReaderFixture::header(DataSetMessageType::KeyFrame, 2), {}, {}, at(8_ms));
  EXPECT_EQ(fixture.reader.next_time(), at(18_ms));
  EXPECT_EQ(fixture.value(), 5);
  fixture.key(2, 6, at(9_ms));
  EXPECT_EQ(fixture.value(), 5) << "it has used its number up";
  EXPECT_EQ(fixture.notified, 1);
}

TEST(Readers, AMessageOfElevenOctetsIsNoSample) {
  RecordingStack stack;
  Communication slave(stack, stack);
  DataSet<double> data;
  int notified = 0;
  data.on_received([&](double) { ++notified; });
  Subscriber subscriber(PublisherId::uint16(2234));
  subscriber.add_data_set("data", data);
  slave.add_subscriber(subscriber);
  slave.enable(LocalTime());
  std::vector<std::byte> octets;
  for (const int octet : {0xF1, 0x01, 0xBA, 0x08, 0x01, 0x01, 0x00, 0x01, 0x01, 0x00, 0x01})
    octets.push_back(static_cast<std::byte>(octet));
  slave.received(octets, LocalTime());
  EXPECT_EQ(notified, 0);
  EXPECT_EQ(subscriber.reader("data")->counts(), (ReaderCounts{.keep_alives = 1}));
}

constexpr std::uint32_t bad_no_communication = 0x80310000;
constexpr std::uint32_t uncertain_last_usable_value = 0x40900000;

// OPC 10000-14, 7.2.4.5.4: encoded as a Variant, a field that is Bad is a StatusCode instead of a value.
TEST(Readers, ABadFieldHasNoValueAndTheOthersHave) {
  ReaderFixture fixture;
  fixture.key(0, 1);
  uadp::Writer writer(fixture.buffer);
  uadp::DataSetMessageEncoder encoder(writer);
  encoder.begin(ReaderFixture::header(DataSetMessageType::KeyFrame, 1));
  encoder.field(uadp::Status{bad_no_communication});
  encoder.field(2.5);
  encoder.end();
  fixture.reader.take(writer.finished(), LocalTime());
  EXPECT_EQ(fixture.data.get(), (Two{1, 2.5}));
  EXPECT_EQ(fixture.data.status(0), uadp::Status{bad_no_communication});
  EXPECT_EQ(fixture.data.status(1), uadp::Status{});
  EXPECT_TRUE(fixture.data.any_bad());
  EXPECT_EQ(fixture.notified, 2);
  EXPECT_EQ(fixture.reader.counts(), (ReaderCounts{.taken = 2, .with_bad = 1}));
  fixture.key(2, 3);
  EXPECT_FALSE(fixture.data.any_bad()) << "a value again";
}

/// A DataSetMessage in octets.
void drain_octets(DataSetReader& reader, std::initializer_list<unsigned> octets) {
  std::vector<std::byte> message;
  for (const unsigned octet : octets) message.push_back(static_cast<std::byte>(octet));
  reader.take(message, LocalTime());
}

// The same clause: a field that is Uncertain is a DataValue with value and StatusCode; as a DataValue (7.2.4.5.5) each
// field carries its own.
TEST(Readers, AnUncertainFieldHasItsValueAndItsStatus) {
  ReaderFixture fixture;
  // 01: valid, Variants. Two fields: a Variant of type 23 (mask 3: Int32 7, 0x40900000), a Double 1.0.
  drain_octets(fixture.reader,
               {0x01, 2, 0, 23, 0x03, 6, 7, 0, 0, 0, 0, 0, 0x90, 0x40, 11, 0, 0, 0, 0, 0, 0, 0xF0, 0x3F});
  EXPECT_EQ(fixture.data.get(), (Two{7, 1.0}));
  EXPECT_EQ(fixture.data.status(0), uadp::Status{uncertain_last_usable_value});
  EXPECT_TRUE(fixture.data.status(0).is_uncertain());
  EXPECT_FALSE(fixture.data.any_bad());
  // 05: valid, DataValues: Int32 8 and Bad; a Double 2.0 and Good.
  drain_octets(fixture.reader,
               {0x05, 2, 0, 0x03, 6, 8, 0, 0, 0, 0, 0, 0x31, 0x80, 0x01, 11, 0, 0, 0, 0, 0, 0, 0, 0x40});
  EXPECT_EQ(fixture.data.get(), (Two{7, 2.0})) << "what comes with Bad is no value";
  EXPECT_EQ(fixture.data.status(0), uadp::Status{bad_no_communication});
  // Bad, and no value at all.
  drain_octets(fixture.reader, {0x05, 2, 0, 0x02, 0, 0, 0x31, 0x80, 0x01, 11, 0, 0, 0, 0, 0, 0, 0x08, 0x40});
  EXPECT_EQ(fixture.data.get(), (Two{7, 3.0}));
  EXPECT_EQ(fixture.notified, 3);
  EXPECT_EQ(fixture.reader.counts(), (ReaderCounts{.taken = 3, .with_bad = 2}));
}

// RawData: one StatusCode, in the header, for all fields. 17: valid, RawData, status.
TEST(Readers, RawDataIsAsGoodAsItsMessage) {
  ReaderFixture fixture;
  const auto raw = [&](unsigned low, unsigned high, unsigned value) {
    drain_octets(fixture.reader, {0x13, low, high, value, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xF0, 0x3F});
  };
  raw(0, 0, 1);
  EXPECT_EQ(fixture.data.get(), (Two{1, 1.0}));
  raw(0x90, 0x40, 2);
  EXPECT_EQ(fixture.data.get(), (Two{2, 1.0}));
  EXPECT_TRUE(fixture.data.status(1).is_uncertain());
  raw(0x31, 0x80, 3);
  EXPECT_EQ(fixture.data.get(), (Two{2, 1.0}));
  EXPECT_TRUE(fixture.data.status(0).is_bad() && fixture.data.status(1).is_bad());
  EXPECT_EQ(fixture.data.overall_status(), uadp::Status{bad_no_communication});
}

// A StatusCode where a StatusCode is to be is a value.
TEST(Readers, AStatusMayBeTheValue) {
  DataSet<uadp::Status> data;
  DataSetReader reader("data", data, {1});
  drain_octets(reader, {0x01, 1, 0, 19, 0, 0, 0x31, 0x80});
  EXPECT_EQ(data.get(), uadp::Status{bad_no_communication});
  EXPECT_FALSE(data.any_bad());
}

/// Feeds a recorded capture (tests/golden/uadp) and gives the values after each frame.
template <class T>
std::vector<T> heard_of(const std::string& capture) {
  std::ifstream file(TAKT_SOURCE_DIR "/tests/golden/uadp/" + capture + ".json");
  const auto json = nlohmann::json::parse(file);
  RecordingStack stack;
  Communication slave(stack, stack);
  DataSet<T> data;
  std::vector<T> heard;
  data.on_received([&](const T& value) { heard.push_back(value); });
  Subscriber subscriber(PublisherId::uint16(2234));
  subscriber.add_data_set("data", data);
  slave.add_subscriber(subscriber);
  slave.enable(LocalTime());
  for (const auto& message : json.at("messages")) {
    const auto hex = message.at("hex").template get<std::string>();
    std::vector<std::byte> octets;
    for (std::size_t i = 0; i < hex.size(); i += 2)
      octets.push_back(static_cast<std::byte>(std::stoul(hex.substr(i, 2), nullptr, 16)));
    slave.received(octets, LocalTime());
  }
  return heard;
}

// The recorded publisher adds 1/8 to each double and 1 to the Int32 in each cycle, from -2, 2.0, 3.0, ... on.
TEST(Recorded, KeyFramesOfAnotherStack) {
  using Six = std::tuple<std::int32_t, double, double, double, double, double>;
  for (const char* capture : {"c10_pubid_u16", "c36_everything", "c52_dv_all", "c50_raw_f64x05", "c51_raw_nopayload",
                              "c30_no_payload_header"}) {
    SCOPED_TRACE(capture);
    if (std::string(capture) == "c50_raw_f64x05") {
      EXPECT_EQ((heard_of<std::tuple<double, double, double, double, double>>(capture).size()), 10u);
      continue;
    }
    const auto heard = heard_of<Six>(capture);
    ASSERT_EQ(heard.size(), 10u);
    EXPECT_EQ(heard.front(), (Six{-2, 2.0, 3.0, 4.0, 5.0, 6.0}));
    EXPECT_EQ(heard.back(), (Six{7, 3.125, 4.125, 5.125, 6.125, 7.125}));
  }
}

// Its delta frames are padded with Null fields of index 0, which must not touch field 0.
TEST(Recorded, DeltaFramesOfAnotherStack) {
  using Six = std::tuple<std::int32_t, double, double, double, double, double>;
  const auto heard = heard_of<Six>("c70_delta_key5");
  ASSERT_EQ(heard.size(), 12u);
  EXPECT_EQ(heard[0], (Six{1, 10.0, 20.0, 30.0, 40.0, 50.0}));
  EXPECT_EQ(heard[1], heard[0]) << "a delta frame in which nothing changed";
  EXPECT_EQ(heard[2], (Six{1, 11.0, 20.0, 30.0, 40.0, 50.0}));
}

}  // namespace
}  // namespace takt::pubsub
