// SPDX-License-Identifier: Apache-2.0
#include "wire/role_format.hpp"

#include "uadp/octets.hpp"

namespace takt::wire {
namespace {

using uadp::BuiltInType;
using uadp::RawField;

// In UADP-Periodic-Fixed with a UInt16 PublisherId (OPC 10000-14, A.2.1.2).
constexpr std::size_t publisher_id_at = 2;
constexpr std::size_t writer_group_at = 5;

std::uint32_t version_of(const RoleShape& shape) {
  ProgramShape all = shape.program;
  for (const handshake::SkillId skill : shape.skills) all.participants.push_back(std::to_string(skill));
  all.participants.insert(all.participants.end(), shape.candidates.begin(), shape.candidates.end());
  return group_version_of(all);
}

}  // namespace

RoleFormat::RoleFormat(RoleShape shape) : shape_(std::move(shape)) {
  TAKT_CHECK(shape_.program.participants.size() == shape_.skills.size() + 1, "each role needs a skill");
  TAKT_CHECK(shape_.candidates.size() <= handshake::most_candidates, "a group has at most 64 candidates");
  uadp::PeriodicFixedLayout::Settings settings;
  settings.group_version = version_of(shape_);
  settings.writer_group_id = announcement_writer_group;
  std::vector<RawField> fields = {{BuiltInType::UInt32}, {BuiltInType::Byte}};
  fields.insert(fields.end(), handshake::most_skills, {BuiltInType::UInt32});
  settings.data_sets = {uadp::RawLayout(std::move(fields))};
  for (std::size_t c = 0; c < shape_.candidates.size(); ++c) {
    settings.publisher_id = uadp::PublisherId::uint16(
        static_cast<std::uint16_t>(shape_.program.first_publisher_id + shape_.program.participants.size() + c));
    announcements_.emplace_back(settings);
    TAKT_CHECK(announcements_.back().size() == announcement_octets, "an announcement has its length");
  }
  fields = {{BuiltInType::UInt32}};
  for (std::size_t role = 0; role < roles(); ++role)
    fields.insert(fields.end(), {{BuiltInType::Byte}, {BuiltInType::UInt32}});
  fields.insert(fields.end(), candidates(), {BuiltInType::UInt32});
  settings.writer_group_id = table_writer_group;
  settings.publisher_id = uadp::PublisherId::uint16(shape_.program.first_publisher_id);
  settings.data_sets = {uadp::RawLayout(std::move(fields))};
  table_.emplace_back(settings);
  TAKT_CHECK(table_.front().size() == table_octets(roles(), candidates()), "a table has its length");
}

uadp::Octets RoleFormat::encode(const AnnouncementMessage& message, std::span<std::byte> target) const {
  const uadp::PeriodicFixedLayout& layout = announcements_[message.candidate];
  layout.start(target, message.sequence);
  layout.set_header(target, 0, message.sequence);
  uadp::Writer writer(target.subspan(fields_at));
  writer.put(message.announcement.life);
  writer.put(static_cast<std::uint8_t>(message.announcement.leaving ? 1 : 0));
  for (const handshake::SkillId skill : message.announcement.skills) writer.put(skill);
  return target.first(layout.size());
}

uadp::Octets RoleFormat::encode(const TableMessage& message, std::span<std::byte> target) const {
  const uadp::PeriodicFixedLayout& layout = table_.front();
  layout.start(target, message.sequence);
  layout.set_header(target, 0, message.sequence);
  uadp::Writer writer(target.subspan(fields_at));
  writer.put(message.incarnation);
  for (std::size_t role = 0; role < roles(); ++role) {
    writer.put(message.bindings[role].candidate);
    writer.put(message.bindings[role].life);
  }
  for (std::size_t c = 0; c < candidates(); ++c) writer.put(message.used_lives[c]);
  return target.first(layout.size());
}

auto RoleFormat::decode(uadp::Octets octets) const -> std::optional<std::variant<AnnouncementMessage, TableMessage>> {
  if (octets.size() < fields_at) return std::nullopt;
  const auto group = uadp::load_little_endian<std::uint16_t>(octets.data() + writer_group_at);
  if (group == table_writer_group) {
    if (auto message = decode_table(octets)) return *message;
    return std::nullopt;
  }
  if (group != announcement_writer_group) return std::nullopt;
  const auto id = uadp::load_little_endian<std::uint16_t>(octets.data() + publisher_id_at);
  const std::size_t candidate =
      static_cast<std::uint16_t>(id - shape_.program.first_publisher_id - shape_.program.participants.size());
  if (candidate >= candidates()) return std::nullopt;
  if (auto message = decode_announcement(octets, static_cast<std::uint8_t>(candidate))) return *message;
  return std::nullopt;
}

Verdict RoleFormat::refusal_of(uadp::Octets octets) const {
  if (octets.size() < fields_at) return Verdict::not_uadp;
  const auto group = uadp::load_little_endian<std::uint16_t>(octets.data() + writer_group_at);
  if (group != table_writer_group && group != announcement_writer_group) return Verdict::other_group;
  constexpr std::size_t version_at = 7;
  if (uadp::load_little_endian<std::uint32_t>(octets.data() + version_at) != version_of(shape_))
    return Verdict::other_version;
  const auto id = uadp::load_little_endian<std::uint16_t>(octets.data() + publisher_id_at);
  const std::size_t candidate =
      static_cast<std::uint16_t>(id - shape_.program.first_publisher_id - shape_.program.participants.size());
  const bool is_table = group == table_writer_group;
  if (is_table ? id != shape_.program.first_publisher_id : candidate >= candidates()) return Verdict::other_publisher;
  return (is_table ? table_.front() : announcements_[candidate]).matches(octets) ? Verdict::impossible
                                                                                 : Verdict::other_layout;
}

/// A master can say so: candidates that there are, each in one role at most, with lives that there are.
bool RoleFormat::is_sound(const TableMessage& message) const {
  std::uint64_t bound = 0;
  for (std::size_t role = 0; role < roles(); ++role) {
    const handshake::Binding& binding = message.bindings[role];
    if (!binding.bound() && binding.life == 0) continue;
    if (binding.candidate >= candidates() || !handshake::is_life(binding.life) ||
        (bound >> binding.candidate & 1U) != 0)
      return false;
    bound |= std::uint64_t{1} << binding.candidate;
  }
  for (std::size_t c = 0; c < candidates(); ++c)
    if (message.used_lives[c] != 0 && !handshake::is_life(message.used_lives[c])) return false;
  return true;
}

std::optional<AnnouncementMessage> RoleFormat::decode_announcement(uadp::Octets octets, std::uint8_t candidate) const {
  const uadp::PeriodicFixedLayout& layout = announcements_[candidate];
  if (!layout.matches(octets)) return std::nullopt;
  AnnouncementMessage message;
  message.candidate = candidate;
  message.sequence = layout.sequence_number(octets, 0);
  uadp::Reader reader(octets.subspan(fields_at));
  message.announcement.life = reader.get<std::uint32_t>();
  const auto leaving = reader.get<std::uint8_t>();
  message.announcement.leaving = leaving != 0;
  for (handshake::SkillId& skill : message.announcement.skills) skill = reader.get<std::uint32_t>();
  if (!handshake::is_life(message.announcement.life) || leaving > 1) return std::nullopt;
  return message;
}

std::optional<TableMessage> RoleFormat::decode_table(uadp::Octets octets) const {
  const uadp::PeriodicFixedLayout& layout = table_.front();
  if (!layout.matches(octets)) return std::nullopt;
  TableMessage message;
  message.sequence = layout.sequence_number(octets, 0);
  uadp::Reader reader(octets.subspan(fields_at));
  message.incarnation = reader.get<std::uint32_t>();
  for (std::size_t role = 0; role < roles(); ++role) {
    message.bindings[role].candidate = reader.get<std::uint8_t>();
    message.bindings[role].life = reader.get<std::uint32_t>();
  }
  for (std::size_t c = 0; c < candidates(); ++c) message.used_lives[c] = reader.get<std::uint32_t>();
  if (!is_sound(message)) return std::nullopt;
  return message;
}

}  // namespace takt::wire
