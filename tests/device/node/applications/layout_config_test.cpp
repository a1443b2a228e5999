// SPDX-License-Identifier: Apache-2.0
// Files with topics in the layouts of others: what is refused, and what --describe tells.
#include <gtest/gtest.h>

#include "node/applications/config.hpp"
#include "node/applications/describe_topics.hpp"

namespace takt::node {
namespace {

using Lines = std::vector<std::string>;

struct Outcome {
  std::unique_ptr<LoadedApplications> loaded;
  Lines said;
};

/// A file with these topics; everything of `x` is published here by one thread and, with `more`, by others.
Outcome load(const std::string& topics, const std::string& payload = R"("counter")", const std::string& more = "") {
  json::Diagnostics diagnostics;
  Outcome outcome;
  outcome.loaded = load_applications_text(
      R"({"node": "a", "transport": {"kind": "udp", "destinations": ["239.0.0.1"]}, "topics": [)" + topics + R"(],
    "applications": [{"name": "p", "on": "a", "threads": [{"name": "t", "publish": "x", "every": "5ms", "payload": )" +
          payload + "}]}" + more + "]}",
      "file", diagnostics);
  for (const auto& each : diagnostics.sorted()) outcome.said.push_back(each.place.pointer + ": " + each.message);
  return outcome;
}

std::string topic(const std::string& name, const std::string& fields, const std::string& uadp,
                  const std::string& protocol = "opc-ua") {
  return R"({"name": ")" + name + R"(", "protocol": ")" + protocol + R"(", "fields": {)" + fields + "}" +
         (uadp.empty() ? "" : R"(, "uadp": )" + uadp) + "}";
}

const std::string two = R"("n": "UInt32", "m": "Double")";

TEST(LayoutFile, PartsNeedWhatTheyBelongTo) {
  const Outcome outcome = load(topic(
      "x", two,
      R"({"network_message": ["PublisherId", "WriterGroupId", "GroupVersion", "NetworkMessageNumber", "SequenceNumber", "PicoSeconds"],
    "data_set_message": ["PicoSeconds"], "encoding": "DataValue", "data_value": ["SourcePicoSeconds", "ServerPicoSeconds"]})"));
  EXPECT_EQ(outcome.said.size(), 8u);
  for (const std::string& each : outcome.said)
    EXPECT_NE(each.find("a part without what it belongs to"), std::string::npos) << each;
}

TEST(LayoutFile, WhatWouldDoNothingIsRefused) {
  EXPECT_EQ(load(topic("x", two, R"({"data_value": ["StatusCode"]})")).said,
            Lines{"/topics/0/uadp/data_value: parts of DataValues without them"});
  EXPECT_EQ(load(topic("x", two, R"({"network_message": ["PayloadHeader"], "publisher": {"byte": 1}})")).said,
            Lines{"/topics/0/uadp/publisher: a PublisherId that is not sent"});
  EXPECT_EQ(load(topic("x", two, R"({"publisher": {"byte": 1}}, "publisher_id": 3)")).said,
            Lines{"/topics/0/publisher_id: a PublisherId that is not sent"});
  EXPECT_EQ(load(topic("x", two, R"({"key_frame_count": 2, "encoding": "RawData"})")).said,
            Lines{"/topics/0/uadp/key_frame_count: no delta frames"});
  EXPECT_EQ(load(topic("x", two, R"({"key_frame_count": 2, "network_message": ["PublisherId"]})")).said,
            Lines{"/topics/0/uadp/key_frame_count: no delta frames"});
  EXPECT_EQ(load(topic("x", R"("n": "UInt32")", R"({"key_frame_count": 2})")).said,
            Lines{"/topics/0/uadp/key_frame_count: no delta frames"});
  EXPECT_EQ(load(topic("x", two, R"({"publisher": {"byte": 1, "uint32": 1}})")).said.size(), 1u);
  EXPECT_EQ(load(topic("x", two, R"({"publisher": {"byte": 256}})")).said.size(), 1u);
}

// Header 1 + 2, FieldCount 2, UInt32 1 + 4, Double 1 + 8: 19 octets.
TEST(LayoutFile, AConfiguredSizeHasRoomForAllFields) {
  EXPECT_EQ(load(topic("x", two, R"({"configured_size": 18})")).said,
            Lines{"/topics/0/uadp/configured_size: a DataSetMessage longer than its ConfiguredSize"});
  const Outcome as_long = load(topic("x", two, R"({"configured_size": 19})"));
  const Outcome longer = load(topic("x", two, R"({"configured_size": 119})"));
  ASSERT_TRUE(as_long.loaded && longer.loaded);
  const DescribedTopic described = description_of(*longer.loaded).topics.at(0);
  EXPECT_EQ(described.configured_size, 119);
  EXPECT_EQ(described.octets, description_of(*as_long.loaded).topics.at(0).octets + 100);
  EXPECT_EQ(load(topic("x", two, R"({"configured_size": 1401})")).said.size(), 1u);
  EXPECT_EQ(
      load(topic("x", two, R"({"configured_size": 1400, "publisher": {"string": ")" + std::string(100, 'p') + R"("}})"))
          .said,
      Lines{"/topics/0/fields: a sample too long for a NetworkMessage"});
}

TEST(LayoutFile, FieldsThatAreNoNumbers) {
  EXPECT_EQ(load(topic("x", R"("n": "UInt32", "s": "String")", "")).said,
            Lines{"/topics/0/fields/s: a text without a greatest length"});
  EXPECT_EQ(load(topic("x", R"("n": {"type": "UInt32", "max_length": 4})", "")).said,
            Lines{"/topics/0/fields/n/max_length: a length of what always has the same"});
  EXPECT_EQ(load(topic("x", R"("g": "Guid")", "")).said,
            Lines{"/applications/0/threads/0/publish: no field for the pattern"});
  EXPECT_EQ(load(topic("x", R"("n": "UInt32", "s": {"type": "String", "max_length": 1400, "count": 2})", "")).said,
            Lines{"/topics/0/fields: a sample too long for a NetworkMessage"});
  const std::string fields =
      R"("n": "UInt32", "s": {"type": "String", "max_length": 2}, "g": "Guid", "gs": {"type": "Guid", "count": 2})";
  const Outcome wrong = load(
      topic("x", fields, ""),
      R"({"pattern": "counter", "values": {"n": "1", "s": "abc", "g": "no", "gs": "72962b91-fa75-4ae6-8d28-b404dc7daf63", "other": ""}})");
  EXPECT_EQ(wrong.said, (Lines{"/applications/0/threads/0/payload/values: a value of another type",
                               "/applications/0/threads/0/payload/values: a value too long",
                               "/applications/0/threads/0/payload/values: not a value of its type",
                               "/applications/0/threads/0/payload/values: a value of another type",
                               "/applications/0/threads/0/payload/values: a value of no field"}));
  EXPECT_TRUE(load(topic("x", fields, ""),
                   R"({"pattern": "counter", "values": {"s": "ab", "g": "72962b91-fa75-4ae6-8d28-b404dc7daf63"}})")
                  .loaded);
  EXPECT_EQ(
      load(topic("x", two, "") + ", " + topic("y", R"("n": "UInt32", "g": "Guid")", R"({"writer_group_id": 2})", "dds"))
          .said,
      (Lines{"/topics/1/fields/g: not of DDS", "/topics/1/uadp: not of DDS"}));
}

// Receivers must be able to tell apart whom they hear.
TEST(LayoutFile, PublishersThatLookAlike) {
  const std::string off = R"("network_message": ["GroupHeader", "WriterGroupId", "PayloadHeader"])";
  EXPECT_EQ(load(topic("x", two, "{" + off + "}") + ", " + topic("y", two, "{" + off + "}")).said,
            Lines{"/topics/1/uadp: topics that look alike"});
  EXPECT_TRUE(
      load(topic("x", two, "{" + off + "}") + ", " + topic("y", two, "{" + off + R"(, "writer_group_id": 2})")).loaded);
  EXPECT_TRUE(
      load(topic("x", two, "{" + off + "}") + ", " + topic("y", two, "{" + off + R"(, "data_set_writer_id": 2})"))
          .loaded);
  EXPECT_EQ(load(topic("x", two, R"({"publisher": {"string": "me"}})") + ", " +
                 topic("y", two, R"({"publisher": {"string": "me"}})"))
                .said,
            Lines{"/topics/1/uadp/publisher: a PublisherId twice"});
  EXPECT_TRUE(load(topic("x", two, R"({"publisher": {"uint32": 1}})") + ", " +
                   topic("y", two, R"({"publisher": {"uint64": 1}})"))
                  .loaded);
  const std::string again = R"(, {"name": "q", "on": "b", "threads": [{"name": "t", "publish": "x", "every": "5ms"}]})";
  EXPECT_EQ(load(topic("x", two, R"({"writer_group_id": 65535})"), R"("counter")", again).said,
            Lines{"/topics/0/uadp/writer_group_id: more publications than ids"});
  EXPECT_EQ(
      load(topic("x", two, R"({"network_message": ["PublisherId", "PayloadHeader"]})"), R"("counter")", again).said,
      Lines{"/topics/0/uadp/network_message: publications that look alike"});
}

// Header 1 + 1 + 4 + 1 + 2 = 9, no PayloadHeader; DataSetMessage header 1 + 2 + 2; UInt32 at 14, String of 4 + 6 octets
// at 18, Guid at 28, two Doubles behind a length at 44: 64 octets.
TEST(LayoutFile, IsDescribed) {
  const Outcome outcome = load(
      topic(
          "x",
          R"("n": "UInt32", "s": {"type": "String", "max_length": 6}, "g": "Guid", "v": {"type": "Double", "count": 2})",
          R"({"publisher": {"uint32": 77}, "encoding": "RawData", "writer_group_id": 500,
    "network_message": ["PublisherId", "GroupHeader", "WriterGroupId"], "data_set_message": ["SequenceNumber", "Status"]})") +
          ", " + topic("z", two, ""),
      R"("counter")", R"(, {"name": "q", "on": "b", "threads": [{"name": "t", "publish": "x", "every": "2ms"}]})");
  ASSERT_TRUE(outcome.loaded) << outcome.said.front();
  const NodeDescription described = description_of(*outcome.loaded);
  ASSERT_EQ(described.topics.size(), 1u) << "z is of no use here";
  const DescribedTopic& x = described.topics[0];
  EXPECT_EQ(x.publisher_id_type, "UInt32");
  EXPECT_EQ(x.publisher_id, "77");
  EXPECT_EQ(x.network_message_content_mask, 0x7);
  EXPECT_EQ(x.data_set_message_content_mask, 0x24);
  EXPECT_EQ(x.data_set_field_content_mask, 0x20);
  EXPECT_EQ(x.data_set_offset, 9);
  EXPECT_EQ(x.octets, 64);
  std::vector<std::int64_t> offsets;
  for (const DescribedField& each : x.fields) offsets.push_back(each.offset.value_or(-1));
  EXPECT_EQ(offsets, (std::vector<std::int64_t>{14, 18, 28, 44}));
  EXPECT_EQ(x.fields[1].max_string_length, 6);
  EXPECT_EQ(x.fields[3].array_length, 2);
  ASSERT_EQ(x.publications.size(), 2u);
  EXPECT_EQ(x.publications[1].writer_group_id, 501);
  EXPECT_EQ(x.publications[1].application, "q");
  EXPECT_FALSE(x.publications[1].is_own);
  EXPECT_NE(to_json(described).find("\"data_set_writer_id\": 1"), std::string::npos);
}

}  // namespace
}  // namespace takt::node
