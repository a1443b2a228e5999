// SPDX-License-Identifier: Apache-2.0
// What is not supported or contradicts itself is refused by name.
#include "pair.hpp"

namespace takt::dds {
namespace {

using Problems = std::vector<std::string>;

TEST(BlockedRecord, OfWhatIsLeftOut) {
  World world;
  Participant& participant = world.add();
  WriterConfig writer = writer_config();
  writer.qos.presentation = {PresentationScope::group, true, true};
  EXPECT_EQ(participant.create_writer(writer, start).problems,
            (Problems{"presentation: coherent_access is not supported", "presentation: ordered_access is not supported",
                      "presentation: access_scope GROUP is not supported"}));
  ReaderConfig reader = reader_config();
  reader.content_filter = "x > 3";
  EXPECT_EQ(participant.create_reader(reader, start).problems,
            (Problems{"content_filter: an expression and what it lets pass belong together"}));
}

TEST(BlockedRecord, OfPoliciesThatContradictThemselves) {
  World world;
  Participant& participant = world.add();
  ReaderConfig reader = reader_config();
  reader.qos.history = {HistoryKind::keep_last, 5};
  reader.qos.resource_limits.max_samples_per_instance = 4;
  EXPECT_EQ(participant.create_reader(reader, start).problems.size(), 1u);
  WriterConfig writer = writer_config();
  writer.topic = "";
  writer.flow_controller = "none";
  writer.flow_share = {11, 101};
  MemoryStorage storage;
  writer.storage = &storage;
  EXPECT_EQ(
      participant.create_writer(writer, start).problems,
      (Problems{"topic: it needs a name", "storage: it needs a persistence GUID, under which things are found again",
                "flow_controller: only asynchronous writers have one",
                "flow_controller: there is none of the name none", "flow_share: priority is -10 to 10",
                "flow_share: reservation is 0 to 100 percent"}));
}

TEST(BlockedRecord, OfParticipants) {
  ParticipantConfig config;
  config.domain = 1000;
  config.max_message = 100;
  config.flow_controllers = {{"a", FlowScheduler::fifo, 10, sim::Duration::from_ps(1)},
                             {"b", FlowScheduler::fifo, 0, {}},
                             {"b", FlowScheduler::fifo, 0, sim::Duration::from_ps(1)}};
  const Problems problems = problems_of(config);
  ASSERT_EQ(problems.size(), 6u);
  EXPECT_TRUE(problems[0].starts_with("domain: "));
  EXPECT_EQ(problems[1], "prefix: a participant needs one of its own");
  EXPECT_EQ(problems[2], "max_message: 256 to 65507 octets");
  EXPECT_EQ(problems[5], "flow controller b: there are two of this name");
}

TEST(BlockedRecord, OfWrites) {
  Pair pair;
  EXPECT_EQ(pair.writing->write(pair.writer, InstanceKey{1}, payload_of(1), start).reason,
            "bad parameter: the topic has no key");
  EXPECT_EQ(pair.writing->dispose(pair.writer, no_key, start).verdict, WriteVerdict::refused);
  EXPECT_EQ(pair.writing->write(pair.writer, no_key, {}, start).verdict, WriteVerdict::refused);
  WriterConfig one = writer_config();
  one.has_key = true;
  one.qos.resource_limits.max_instances = 1;
  const WriterHandle writer = *pair.writing->create_writer(one, start).handle;
  EXPECT_EQ(pair.writing->write(writer, InstanceKey{1}, payload_of(1), start).verdict, WriteVerdict::written);
  EXPECT_EQ(pair.writing->write(writer, InstanceKey{2}, payload_of(1), start).reason,
            "out of resources: max_instances");
}

}  // namespace
}  // namespace takt::dds
