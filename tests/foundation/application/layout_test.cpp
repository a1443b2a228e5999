// SPDX-License-Identifier: Apache-2.0
// Topics in the layouts of others: octets by hand from OPC 10000-14, and what an independent stack sends
// (tests/golden/uadp) heard by a topic that is configured for it.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>

#include "application/opc_ua_topic.hpp"
#include "application/topic_values.hpp"

namespace takt::application::layout_test {
namespace {

using plant::DataSetMessagePart;
using plant::DataValuePart;
using plant::NetworkMessagePart;
using plant::TopicType;
using Octets = std::vector<std::byte>;

Octets octets(std::string_view hex) {
  Octets all;
  std::string digits;
  for (const char c : hex)
    if (c != ' ') digits += c;
  for (std::size_t i = 0; i + 1 < digits.size(); i += 2)
    all.push_back(static_cast<std::byte>(std::stoul(digits.substr(i, 2), nullptr, 16)));
  return all;
}

std::string hex(uadp::Octets octets) {
  std::string text;
  for (const std::byte each : octets)
    text += "0123456789abcdef"[std::to_integer<unsigned>(each) >> 4],
        text += "0123456789abcdef"[std::to_integer<unsigned>(each) & 15];
  return text;
}

plant::Topic topic_of(const json::NameMap<plant::TopicField>& fields) {
  plant::Topic topic;
  topic.name = "x";
  topic.fields = fields;
  topic.uadp.emplace();
  return topic;
}

struct Wire final : pubsub::PublishedData {
  void publish(uadp::Octets message, const pubsub::Destination&) override {
    messages.emplace_back(message.begin(), message.end());
  }
  std::vector<Octets> messages;
};

/// The messages of these values, one after the other.
std::vector<Octets> published(const TopicShape& shape, const OpcUaAddress& address, const std::vector<Octets>& values,
                              uadp::DateTime epoch = {}) {
  Wire wire;
  OpcUaPublication publication(shape, address, wire, sim::LocalTime(), epoch);
  for (const Octets& each : values) {
    const bool is_published = publication.publish(each, sim::LocalTime());
    EXPECT_TRUE(is_published);
  }
  return wire.messages;
}

/// What a subscription takes, message by message; empty: nothing.
std::vector<std::string> heard(const TopicShape& shape, const OpcUaAddress& address,
                               const std::vector<Octets>& messages) {
  OpcUaSubscription subscription(shape, {&address, 1}, sim::LocalTime());
  std::vector<std::string> all;
  for (const Octets& each : messages) {
    const auto value = subscription.receive(each, sim::LocalTime());
    all.push_back(value ? hex(*value) : "");
  }
  return all;
}

// A.2.1, with PublisherId UInt16 100, WriterGroup 1, GroupVersion 0x2F0E1A00; Int32 -5, Double 1.5, Boolean true. The
// first of its sequence.
TEST(Layout, PeriodicFixed) {
  plant::Topic topic = topic_of({{"i", {TopicType::int32}}, {"d", {TopicType::float64}}, {"b", {TopicType::boolean}}});
  using Part = NetworkMessagePart;
  topic.uadp->network_message = {Part::sequence_number, Part::publisher_id,  Part::group_header,
                                 Part::writer_group_id, Part::group_version, Part::network_message_number};
  topic.uadp->data_set_message = {DataSetMessagePart::status, DataSetMessagePart::sequence_number};
  topic.uadp->encoding = plant::UadpEncoding::raw_data;
  topic.uadp->group_version = 0x2F0E1A00;
  const TopicShape shape = shape_of(topic, {});
  const Octets value = octets("06 FBFFFFFF 0B 000000000000F83F 01 01");
  const auto messages = published(shape, {100, 1}, {value});
  ASSERT_EQ(messages.size(), 1u);
  EXPECT_EQ(messages[0], octets("B1 01 6400 0F 0100 001A0E2F 0100 0000  1B 0000 0000  FBFFFFFF 000000000000F83F 01"));
  EXPECT_EQ(messages[0].size(), 33u);
  EXPECT_EQ(longest_message(shape, {100, 1}), 33u);
  EXPECT_EQ(heard(shape, {100, 1}, messages), std::vector<std::string>{hex(value)});
  topic.uadp->group_version = 7;
  EXPECT_EQ(heard(shape_of(topic, {}), {100, 1}, messages), std::vector<std::string>{""}) << "of another GroupVersion";
}

// A delta frame with PublisherId Byte 7, a PayloadHeader with writer 33; field 1 has changed to 2.5. Its fifth message.
TEST(Layout, DeltaFrame) {
  plant::Topic topic = topic_of({{"i", {TopicType::int32}}, {"d", {TopicType::float64}}});
  topic.uadp->network_message = {NetworkMessagePart::publisher_id, NetworkMessagePart::payload_header};
  topic.uadp->publisher.emplace().byte = 7;
  topic.uadp->data_set_writer_id = 33;
  topic.uadp->key_frame_count = 10;
  const TopicShape shape = shape_of(topic, {});
  std::vector<Octets> values;
  for (const char* const last : {"0040", "F03F", "0040", "F03F", "0440"})
    values.push_back(octets(std::string("06 01000000 0B 000000000000") + last));
  const auto messages = published(shape, {1, 1}, values);
  ASSERT_EQ(messages.size(), 5u);
  EXPECT_EQ(messages[0], octets("51 07 01 2100  09 0000 0200 06 01000000 0B 0000000000000040"));
  EXPECT_EQ(messages[4], octets("51 07 01 2100  89 01 0400 0100 0100 0B 0000000000000440"));
  std::vector<std::string> all;
  for (const Octets& each : values) all.push_back(hex(each));
  EXPECT_EQ(heard(shape, {1, 1}, messages), all);
  values = {values[0], values[0], values[1]};
  EXPECT_EQ(published(shape, {1, 1}, values).size(), 2u) << "nothing has changed the second time";
}

// Behind a loss a delta frame does not tell all, so nothing is taken until the next key frame, and what was refused is
// lost too.
TEST(Layout, DeltaFramesWithoutTheirKeyFrameAreNotTaken) {
  plant::Topic topic = topic_of({{"i", {TopicType::int32}}, {"d", {TopicType::float64}}, {"e", {TopicType::float64}}});
  topic.uadp->key_frame_count = 4;
  const TopicShape shape = shape_of(topic, {});
  std::vector<Octets> values;
  for (int n = 1; n <= 12; ++n)
    values.push_back(octets("06 0" + std::to_string(n % 10) + "000000 0B 0000000000000040 0B 0000000000000040"));
  const auto messages = published(shape, {9, 1}, values);
  ASSERT_EQ(messages.size(), 12u);
  EXPECT_GT(messages[4].size(), messages[5].size());
  const OpcUaAddress address{9, 1};
  OpcUaSubscription subscription(shape, {&address, 1}, sim::LocalTime());
  std::vector<int> came;
  for (int n : {2, 3, 5, 6, 8, 8, 7, 10, 11, 12}) {  // late; 7 is lost and comes too late; the key frame 9 is lost
    const auto value = subscription.receive(messages[static_cast<std::size_t>(n - 1)], sim::LocalTime());
    if (!value) continue;
    EXPECT_EQ(hex(*value), hex(values[static_cast<std::size_t>(n - 1)])) << n;
    came.push_back(n);
  }
  EXPECT_EQ(came, (std::vector<int>{5, 6, 7}));
  EXPECT_EQ(subscription.lost(), 0u) << "what has not ended yet";
  const auto more = published(shape, {9, 1},
                              {values[0], values[1], values[2], values[3], values[4], values[5], values[6], values[7],
                               values[8], values[9], values[10], values[11], values[0]});
  EXPECT_TRUE(subscription.receive(more[12], sim::LocalTime())) << "the next key frame";
  EXPECT_EQ(subscription.lost(), 5u) << "8 to 12";
}

// Two publishers of a topic: delta frames of one say nothing of the other.
TEST(Layout, EachPublicationHasItsOwnFields) {
  plant::Topic topic = topic_of({{"i", {TopicType::int32}}, {"d", {TopicType::float64}}, {"e", {TopicType::float64}}});
  topic.uadp->key_frame_count = 4;
  topic.uadp->writer_group_id = 0x8001;
  const TopicShape shape = shape_of(topic, {});
  const auto value = [](int i, const char* d) {
    return octets("06 0" + std::to_string(i) + "000000 0B " + d + " 0B 0000000000000040");
  };
  const auto one = published(shape, {9, 1}, {value(1, "0000000000000040"), value(2, "0000000000000040")});
  const auto two = published(shape, {9, 2}, {value(7, "0000000000001040"), value(8, "0000000000001040")});
  EXPECT_EQ(hex(one[0]).substr(0, 14), "f1010900010180");
  EXPECT_EQ(hex(two[0]).substr(0, 14), "f1010900010280");
  const OpcUaAddress both[] = {{9, 1}, {9, 2}};
  OpcUaSubscription subscription(shape, both, sim::LocalTime());
  subscription.receive(one[0], sim::LocalTime());
  subscription.receive(two[0], sim::LocalTime());
  EXPECT_EQ(hex(*subscription.receive(one[1], sim::LocalTime())), hex(value(2, "0000000000000040")));
  EXPECT_EQ(hex(*subscription.receive(two[1], sim::LocalTime())), hex(value(8, "0000000000001040")));
}

// Double 1.0 with the source's time, 133500000000000000; then with all members but the status, which is Good.
TEST(Layout, DataValue) {
  plant::Topic topic = topic_of({{"d", {TopicType::float64}}});
  topic.uadp->encoding = plant::UadpEncoding::data_value;
  topic.uadp->data_value = {DataValuePart::status_code, DataValuePart::source_timestamp};
  topic.uadp->network_message = {NetworkMessagePart::publisher_id, NetworkMessagePart::payload_header};
  topic.uadp->publisher.emplace().uint32 = 0xDEADBEEF;
  topic.uadp->data_set_message = {};
  const Octets value = octets("0B 000000000000F03F");
  const uadp::DateTime epoch{133'500'000'000'000'000};
  auto messages = published(shape_of(topic, {}), {1, 1}, {value}, epoch);
  EXPECT_EQ(hex(messages.at(0)),
            hex(octets("D1 02 EFBEADDE 01 0100  05 0100  05 0B 000000000000F03F 00C083ED8A49DA01")));
  EXPECT_EQ(heard(shape_of(topic, {}), {1, 1}, messages), std::vector<std::string>{hex(value)});
  topic.uadp->data_value = {DataValuePart::server_timestamp, DataValuePart::source_timestamp,
                            DataValuePart::server_pico_seconds, DataValuePart::source_pico_seconds};
  messages = published(shape_of(topic, {}), {1, 1}, {value}, epoch);
  EXPECT_EQ(
      hex(messages.at(0)),
      hex(octets(
          "D1 02 EFBEADDE 01 0100  05 0100  3D 0B 000000000000F03F 00C083ED8A49DA01 0000 00C083ED8A49DA01 0000")));
  EXPECT_EQ(heard(shape_of(topic, {}), {1, 1}, messages), std::vector<std::string>{hex(value)});
}

/// One field of each type that is no number, and a number.
plant::Topic mixed() {
  return topic_of({{"s", {TopicType::string, 1, std::uint16_t{5}}},
                   {"n", {TopicType::uint16}},
                   {"g", {TopicType::guid}},
                   {"t", {TopicType::date_time}},
                   {"b", {TopicType::byte_string, 1, std::uint16_t{3}}},
                   {"two", {TopicType::string, 2, std::uint16_t{2}}}});
}

// Part 6, 5.2.2.6: of the GUID 72962B91-FA75-4AE6-8D28-B404DC7DAF63 the first three numbers are little-endian. RawData:
// 4 + 5, 2, 16, 8, 4 + 3, 4 + 2 * (4 + 2) = 58 octets.
TEST(Layout, TextsGuidsAndTimes) {
  plant::Topic topic = mixed();
  plant::Payload payload;
  payload.pattern = plant::Pattern::counter;
  payload.values = {{"s", "abc"},
                    {"g", "72962B91-FA75-4AE6-8D28-B404DC7DAF63"},
                    {"t", "2024-01-17T21:20:00.0000001Z"},
                    {"b", "0aff"}};
  for (const auto encoding :
       {plant::UadpEncoding::raw_data, plant::UadpEncoding::variant, plant::UadpEncoding::data_value}) {
    topic.uadp->encoding = encoding;
    const TopicShape shape = shape_of(topic, {});
    Publication values(shape, payload);
    values.next();
    const uadp::Octets second = values.next();
    const Octets value(second.begin(), second.end());
    EXPECT_EQ(hex(value), hex(octets("0C 03000000 616263  05 0200  0E 912B9672 75FA E64A 8D28B404DC7DAF63  0D "
                                     "01C083ED8A49DA01  0F 02000000 0AFF  8C 02000000 00000000 00000000")));
    EXPECT_FALSE(shape.is_zero(value));
    EXPECT_TRUE(shape.is_zero(shape.zeros()));
    const auto messages = published(shape, {1, 1}, {value});
    EXPECT_EQ(heard(shape, {1, 1}, messages), std::vector<std::string>{hex(value)});
    EXPECT_LE(messages[0].size(), longest_message(shape, {1, 1}));
    if (encoding != plant::UadpEncoding::raw_data) continue;
    EXPECT_EQ(messages[0].size(), longest_message(shape, {1, 1}));
    EXPECT_EQ(
        hex(messages[0]),
        hex(octets("F1 01 0100 01 0100 01 0100  0B 0000  03000000 6162630000  0200  912B967275FAE64A8D28B404DC7DAF63  "
                   "01C083ED8A49DA01  02000000 0AFF00  02000000 00000000 0000 00000000 0000")));
  }
}

// A String longer than its field has room for is none of the topic, whoever sends it.
TEST(Layout, LongerTextsAreRefused) {
  plant::Topic topic = topic_of({{"s", {TopicType::string, 1, std::uint16_t{5}}}, {"n", {TopicType::uint16}}});
  const TopicShape shape = shape_of(topic, {});
  topic.fields[0].second.max_length = std::uint16_t{9};
  const TopicShape other = shape_of(topic, {});
  const auto messages =
      published(other, {1, 1}, {octets("0C 05000000 6162636465 05 0100"), octets("0C 06000000 616263646566 05 0200")});
  EXPECT_EQ(heard(shape, {1, 1}, messages), (std::vector<std::string>{"0c050000006162636465050100", ""}));
  Wire wire;
  OpcUaPublication publication(shape, {1, 1}, wire, sim::LocalTime());
  EXPECT_FALSE(publication.publish(octets("0C 06000000 616263646566 05 0200"), sim::LocalTime()));
}

// Without a PublisherId its type bits say nothing (open62541 sends that of the one that is switched off). And who waits
// for one is not content without.
TEST(Layout, WithoutPublisherIdWhateverItsTypeBitsSay) {
  plant::Topic topic = topic_of({{"n", {TopicType::uint16}}});
  topic.uadp->network_message = {NetworkMessagePart::group_header, NetworkMessagePart::writer_group_id,
                                 NetworkMessagePart::payload_header};
  const TopicShape off = shape_of(topic, {});
  topic.uadp.reset();
  const TopicShape on = shape_of(topic, {});
  const Octets value = octets("05 0700");
  const auto plain = published(off, {1, 1}, {value});
  EXPECT_EQ(hex(plain.at(0)), hex(octets("61 01 0100 01 0100  09 0000 0100 05 0700")));
  const auto with_id = published(on, {1, 1}, {value});
  EXPECT_EQ(heard(off, {1, 1}, with_id), std::vector<std::string>{""});
  EXPECT_EQ(heard(on, {1, 1}, plain), std::vector<std::string>{""});
  for (int bits = 0; bits < 8; ++bits) {
    Octets message = plain[0];
    message[0] |= std::byte{0x80};
    message.insert(message.begin() + 1, static_cast<std::byte>(bits));
    EXPECT_EQ(heard(off, {1, 1}, {message}), std::vector<std::string>{"050700"}) << bits;
  }
}

// Each type of PublisherId, and the same number in another type, which is somebody else.
TEST(Layout, PublisherIdsOfAllTypes) {
  std::vector<plant::Topic> topics(5, topic_of({{"n", {TopicType::uint16}}}));
  topics[0].uadp->publisher.emplace().byte = 7;
  topics[1].uadp->publisher.emplace().uint32 = 7;
  topics[2].uadp->publisher.emplace().uint64 = 7;
  topics[3].uadp->publisher.emplace().string = "7";
  std::vector<std::vector<Octets>> messages;
  for (const plant::Topic& each : topics)
    messages.push_back(published(shape_of(each, {}), {7, 1}, {octets("05 0700")}));
  const char* const begins[] = {"7107", "f10207000000", "f1030700000000000000", "f1040100000037", "f1010700"};
  for (std::size_t i = 0; i < topics.size(); ++i) {
    EXPECT_EQ(hex(messages[i].at(0)).substr(0, std::string_view(begins[i]).size()), begins[i]);
    for (std::size_t k = 0; k < topics.size(); ++k)
      EXPECT_EQ(heard(shape_of(topics[i], {}), {7, 1}, messages[k])[0].empty(), i != k) << i << " " << k;
  }
}

// All that is cut short, and any octet that is another: refused, or taken as fields of the topic and no others.
TEST(Layout, HostileMessages) {
  plant::Topic topic = mixed();
  for (const auto encoding :
       {plant::UadpEncoding::raw_data, plant::UadpEncoding::variant, plant::UadpEncoding::data_value}) {
    topic.uadp->encoding = encoding;
    const TopicShape shape = shape_of(topic, {});
    const Octets message = published(shape, {1, 1}, {shape.longest()}).at(0);
    for (std::size_t length = 0; length < message.size(); ++length)
      EXPECT_EQ(
          heard(shape, {1, 1}, {Octets(message.begin(), message.begin() + static_cast<std::ptrdiff_t>(length))})[0], "")
          << length;
    for (std::size_t at = 0; at < message.size(); ++at)
      for (const int other : {0x00, 0x01, 0x7F, 0x80, 0xFF}) {
        Octets changed = message;
        changed[at] = static_cast<std::byte>(other);
        const auto taken = heard(shape, {1, 1}, {changed});
        if (taken[0].empty()) continue;
        EXPECT_LE(taken[0].size(), 2 * shape.longest().size());
        EXPECT_NO_FATAL_FAILURE(static_cast<void>(shape.is_zero(octets(taken[0]))));
      }
  }
}

nlohmann::json capture(const std::string& name) {
  std::ifstream file(TAKT_SOURCE_DIR "/tests/golden/uadp/" + name + ".json");
  return nlohmann::json::parse(file);
}

std::string variant_of(const nlohmann::json& field) {
  Octets room(32);
  uadp::Writer writer(room);
  if (field.at("type") == "Int32")
    uadp::put_variant(writer, field.at("value").get<std::int32_t>());
  else
    uadp::put_variant(writer, field.at("value").get<double>());
  return hex(writer.finished());
}

struct Stranger {
  const char* capture;
  const char* uadp;  ///< the key of the topic, as a file writes it
  std::uint16_t writer = 1;
};

class Strangers : public ::testing::TestWithParam<Stranger> {};

// Int32 and five Doubles in every layout that the other stack was made to send; a topic with its ids hears every
// message, one with others none.
TEST_P(Strangers, AreHeard) {
  plant::Topic topic = topic_of({{"i", {TopicType::int32}},
                                 {"a", {TopicType::float64}},
                                 {"b", {TopicType::float64}},
                                 {"c", {TopicType::float64}},
                                 {"d", {TopicType::float64}},
                                 {"e", {TopicType::float64}}});
  json::Diagnostics diagnostics;
  const auto document = json::parse(GetParam().uadp, "uadp", diagnostics);
  ASSERT_TRUE(document && json::decode(*document, *topic.uadp, diagnostics)) << diagnostics.to_text();
  const TopicShape shape = shape_of(topic, {});
  const nlohmann::json recorded = capture(GetParam().capture);
  std::vector<Octets> messages;
  std::vector<std::string> expected;
  std::vector<std::string> now(6);
  for (const auto& each : recorded.at("messages")) {
    messages.push_back(octets(each.at("hex").get<std::string>()));
    const auto& fields = each.at("message").at("dataSetMessages").at(0).at("fields");
    const bool is_delta = each.at("message").at("dataSetMessages").at(0).at("type") == "DeltaFrame";
    for (std::size_t i = 0; i < fields.size(); ++i) {
      const auto& field = is_delta                                                           ? fields[i].at("field")
                          : fields[i].contains("value") && fields[i].at("value").is_object() ? fields[i].at("value")
                                                                                             : fields[i];
      if (field.at("type") != "Null") now[is_delta ? fields[i].at("index").get<std::size_t>() : i] = variant_of(field);
    }
    expected.emplace_back();
    if (fields.empty()) continue;  // a sign of life, no sample
    for (const std::string& field : now) expected.back() += field;
  }
  EXPECT_EQ(heard(shape, {2234, 1}, messages), expected);
  topic.uadp->writer_group_id = 101;
  topic.uadp->data_set_writer_id = 9;
  EXPECT_EQ(heard(shape_of(topic, {}), {2234, 1}, messages), std::vector<std::string>(messages.size()))
      << "another group and writer";
}

constexpr const char* usual = R"({"writer_group_id": 100})";
INSTANTIATE_TEST_SUITE_P(
    Open62541, Strangers,
    ::testing::Values(
        Stranger{"c03_i32_f64x05", usual},
        Stranger{"c10_pubid_byte", R"({"writer_group_id": 100, "publisher": {"byte": 200}})"},
        Stranger{"c10_pubid_u16", usual},
        Stranger{"c10_pubid_u64", R"({"writer_group_id": 100, "publisher": {"uint64": 18000000000000000000}})"},
        Stranger{"c20_no_group", R"({"network_message": ["PublisherId", "PayloadHeader"]})"},
        Stranger{"c25_group_wgid_seq", usual}, Stranger{"c26_group_all", usual},
        Stranger{"c36_everything", R"({"writer_group_id": 100, "group_version": 77})"},
        Stranger{"c30_no_payload_header",
                 R"({"writer_group_id": 100, "network_message": ["PublisherId", "GroupHeader", "WriterGroupId"]})"},
        Stranger{"c40_dsm_seq_ts_status_major_minor", usual},
        Stranger{
            "c51_raw_nopayload",
            R"({"writer_group_id": 100, "encoding": "RawData", "network_message": ["PublisherId", "GroupHeader", "WriterGroupId", "GroupVersion"]})"},
        Stranger{"c70_delta_key5", R"({"writer_group_id": 100, "key_frame_count": 5})"},
        Stranger{"c72_delta_key5_master", R"({"writer_group_id": 100, "key_frame_count": 5})"},
        Stranger{"c60_multi2", usual}, Stranger{"d02_eth_i32_f64x05_vlan", usual}),
    [](const auto& each) { return std::string(each.param.capture); });

// Texts and times among all types: the octets of the message from FieldCount on.
TEST(Strangers, AllTypes) {
  const TopicType types[] = {TopicType::boolean, TopicType::sbyte,   TopicType::byte,    TopicType::int16,
                             TopicType::uint16,  TopicType::int32,   TopicType::uint32,  TopicType::int64,
                             TopicType::uint64,  TopicType::float32, TopicType::float64, TopicType::date_time,
                             TopicType::string};
  json::NameMap<plant::TopicField> fields;
  for (const TopicType type : types)
    fields.push_back({"f" + std::to_string(fields.size()),
                      {type, 1, type == TopicType::string ? std::optional<std::uint16_t>(8) : std::nullopt}});
  plant::Topic topic = topic_of(fields);
  topic.uadp->writer_group_id = 100;
  for (const auto& each : capture("c51_variant_alltypes").at("messages")) {
    const std::string message = each.at("hex").get<std::string>();
    EXPECT_EQ(heard(shape_of(topic, {}), {2234, 1}, {octets(message)})[0], message.substr(message.find("010d00") + 6));
  }
}

}  // namespace
}  // namespace takt::application::layout_test
