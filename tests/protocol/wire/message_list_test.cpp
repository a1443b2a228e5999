// SPDX-License-Identifier: Apache-2.0
// The list of messages against the messages themselves: what stands where it says.
#include "wire/message_list.hpp"

#include <gtest/gtest.h>

#include <array>

#include "support.hpp"

namespace takt::wire {
namespace {

const FieldOnWire& field(const MessageOnWire& message, std::string_view name) {
  const auto found = std::ranges::find(message.fields, name, &FieldOnWire::name);
  EXPECT_NE(found, message.fields.end()) << name;
  return *found;
}
template <class T>
T at(uadp::Octets octets, const FieldOnWire& field) {
  return uadp::load_little_endian<T>(octets.data() + field.offset);
}

TEST(MessageList, FieldsOfAStateStandWhereItSays) {
  const ProgramFormat format(test::shape());
  StateMessage state;
  state.sender = 1;
  state.word.state = handshake::PublishedState::Suspended;
  state.word.incarnation = 0x01020304;
  state.word.run = 0x05060708;
  state.word.intent.number = 0x11121314;
  state.word.intent.run = 0x21222324;
  state.word.intent.kind = handshake::IntentKind::Suspend;
  state.word.intent.origin = 2;
  std::array<std::byte, 200> buffer{};
  const uadp::Octets octets = format.encode(state, buffer);
  const std::vector<MessageOnWire> messages = messages_of(format);
  const MessageOnWire& listed = messages[1];
  EXPECT_EQ(listed.name, "state");
  EXPECT_EQ(listed.publisher, format.shape().participants[1]);
  EXPECT_EQ(listed.octets, octets.size());
  EXPECT_EQ(uadp::load_little_endian<std::uint16_t>(octets.data() + 2), listed.publisher_id);
  EXPECT_EQ(uadp::load_little_endian<std::uint16_t>(octets.data() + 5), listed.writer_group_id);
  EXPECT_EQ(uadp::load_little_endian<std::uint32_t>(octets.data() + 7), format.group_version());
  EXPECT_EQ(at<std::int32_t>(octets, field(listed, "CurrentState")), static_cast<std::int32_t>(state.word.state));
  EXPECT_EQ(at<std::uint32_t>(octets, field(listed, "Incarnation")), 0x01020304u);
  EXPECT_EQ(at<std::uint32_t>(octets, field(listed, "Run")), 0x05060708u);
  EXPECT_EQ(at<std::uint32_t>(octets, field(listed, "IntentNumber")), 0x11121314u);
  EXPECT_EQ(at<std::uint32_t>(octets, field(listed, "IntentRun")), 0x21222324u);
  EXPECT_EQ(at<std::uint8_t>(octets, field(listed, "IntentKind")),
            static_cast<std::uint8_t>(handshake::IntentKind::Suspend));
  EXPECT_EQ(at<std::uint8_t>(octets, field(listed, "IntentOrigin")), 2u);
}

TEST(MessageList, EveryMessageHasItsLengthAndAnIdOfItsOwn) {
  RoleShape roles;
  roles.program = test::shape();
  roles.program.data_sets.clear();
  roles.skills.assign(roles.program.participants.size() - 1, handshake::skill_id("welding"));
  roles.candidates = {"a", "b", "c"};
  const RoleFormat format(roles);
  const std::vector<MessageOnWire> messages = messages_of(format);
  ASSERT_EQ(messages.size(), 4u);
  std::array<std::byte, 400> buffer{};
  const uadp::Octets announced = format.encode(AnnouncementMessage{2, 5, {7, true, {}}}, buffer);
  EXPECT_EQ(messages[3].octets, announced.size());
  EXPECT_EQ(uadp::load_little_endian<std::uint16_t>(announced.data() + 2), messages[3].publisher_id);
  EXPECT_EQ(uadp::load_little_endian<std::uint16_t>(announced.data() + 5), messages[3].writer_group_id);
  EXPECT_EQ(at<std::uint32_t>(announced, field(messages[3], "Life")), 7u);
  EXPECT_EQ(at<std::uint8_t>(announced, field(messages[3], "Leaving")), 1u);
  EXPECT_EQ(messages[0].octets, table_octets(format.roles(), format.candidates()));
}

}  // namespace
}  // namespace takt::wire
