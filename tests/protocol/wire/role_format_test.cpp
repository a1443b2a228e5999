// SPDX-License-Identifier: Apache-2.0
// Announcements and tables: round trips, lengths, and what is refused.
#include "wire/role_format.hpp"

#include <gtest/gtest.h>

#include "support.hpp"

namespace takt::wire::test {
namespace {

RoleFormat format() {
  RoleShape made;
  made.program.name = "p";
  made.program.participants = {"m", "r0", "r1"};
  made.program.first_publisher_id = 0x0100;
  made.skills = {handshake::skill_id("welding"), handshake::skill_id("gripping")};
  made.candidates = {"a", "b", "c"};
  return RoleFormat(std::move(made));
}

TEST(RoleFormat, AnAnnouncementComesBack) {
  const RoleFormat roles = format();
  AnnouncementMessage message{2, 77, {5, true, {}}};
  message.announcement.skills[0] = handshake::skill_id("welding");
  message.announcement.skills[7] = 9;
  std::array<std::byte, 200> buffer{};
  const uadp::Octets octets = roles.encode(message, buffer);
  EXPECT_EQ(octets.size(), announcement_octets);
  EXPECT_EQ(announcement_octets, 57u);
  const auto decoded = roles.decode(octets);
  ASSERT_TRUE(decoded);
  const auto& back = std::get<AnnouncementMessage>(*decoded);
  EXPECT_EQ(back.candidate, 2);
  EXPECT_EQ(back.sequence, 77);
  EXPECT_EQ(back.announcement, message.announcement);
  EXPECT_EQ(octets[2], std::byte{5}) << "0x0100, three participants, candidate 2";
}

TEST(RoleFormat, ATableComesBack) {
  const RoleFormat roles = format();
  TableMessage message;
  message.sequence = 3;
  message.incarnation = 0x01020304;
  message.bindings[1] = {2, 8};
  message.used_lives[0] = 6;
  std::array<std::byte, 200> buffer{};
  const uadp::Octets octets = roles.encode(message, buffer);
  EXPECT_EQ(octets.size(), 24u + 2 * 5 + 3 * 4);
  const auto decoded = roles.decode(octets);
  ASSERT_TRUE(decoded);
  const auto& back = std::get<TableMessage>(*decoded);
  EXPECT_EQ(back.incarnation, 0x01020304u);
  EXPECT_EQ(back.bindings, message.bindings);
  EXPECT_EQ(back.used_lives, message.used_lives);
}

TEST(RoleFormat, ForeignOnesAreRefused) {
  const RoleFormat roles = format();
  std::array<std::byte, 200> buffer{};
  const std::size_t size = roles.encode(AnnouncementMessage{0, 1, {1, false, {}}}, buffer).size();
  const uadp::Octets sound(buffer.data(), size);
  ASSERT_TRUE(roles.decode(sound));
  for (std::size_t length = 0; length < size; ++length) EXPECT_FALSE(roles.decode(sound.first(length))) << length;
  for (const std::size_t octet : {std::size_t{0}, std::size_t{3}, std::size_t{6}, std::size_t{8}}) {
    std::array<std::byte, 200> damaged = buffer;
    damaged[octet] ^= std::byte{0x40};
    EXPECT_FALSE(roles.decode(uadp::Octets(damaged.data(), size))) << octet;
  }
  std::array<std::byte, 200> dead = buffer;
  std::fill_n(dead.begin() + fields_at, 4, std::byte{0});
  EXPECT_FALSE(roles.decode(uadp::Octets(dead.data(), size))) << "life 0";
  TableMessage table;
  table.bindings[0] = {7, 1};
  const uadp::Octets octets = roles.encode(table, buffer);
  EXPECT_FALSE(roles.decode(octets)) << "there is no candidate 7";
}

}  // namespace
}  // namespace takt::wire::test
