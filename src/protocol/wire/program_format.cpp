// SPDX-License-Identifier: Apache-2.0
#include "wire/program_format.hpp"

#include <algorithm>

#include "uadp/network_message.hpp"
#include "uadp/octets.hpp"

namespace takt::wire {
namespace {

using handshake::Variant;
using uadp::BuiltInType;
using uadp::RawField;

// In UADP-Periodic-Fixed with a UInt16 PublisherId (OPC 10000-14, A.2.1.2).
constexpr std::size_t writer_group_at = 5;
// Upper half of the DataSetMessage's StatusCode; all fields are RawData, so it is that of each of them.
constexpr std::size_t status_at = 18;

bool has_no_value(uadp::Octets message) {
  return uadp::Status{std::uint32_t{uadp::load_little_endian<std::uint16_t>(message.data() + status_at)} << 16}
      .is_bad();
}

uadp::RawLayout state_fields(Variant variant) {
  std::vector<RawField> fields = {{BuiltInType::Int32}};
  if (variant == Variant::robust) {
    fields.insert(fields.end(), 4, {BuiltInType::UInt32});
    fields.insert(fields.end(), 2, {BuiltInType::Byte});
  }
  return uadp::RawLayout(std::move(fields));
}

uadp::RawLayout data_fields(const DataSetShape& data_set) {
  std::vector<RawField> fields = {{BuiltInType::UInt32}};
  for (const FieldShape& field : data_set.fields) fields.insert(fields.end(), field.count, {field.type});
  return uadp::RawLayout(std::move(fields));
}

}  // namespace

ProgramFormat::ProgramFormat(ProgramShape shape)
    : shape_(std::move(shape)), participants_(shape_.participants.size()), group_version_(group_version_of(shape_)) {
  const auto layout = [&](std::size_t participant, std::size_t group, uadp::RawLayout fields) {
    uadp::PeriodicFixedLayout::Settings settings;
    settings.publisher_id =
        uadp::PublisherId::uint16(static_cast<std::uint16_t>(shape_.first_publisher_id + participant));
    settings.writer_group_id = static_cast<std::uint16_t>(group);
    settings.group_version = group_version_;
    settings.data_sets.push_back(std::move(fields));
    return uadp::PeriodicFixedLayout(settings);
  };
  for (std::size_t p = 0; p < shape_.participants.size(); ++p)
    states_.push_back(layout(p, state_writer_group, state_fields(shape_.variant)));
  for (std::size_t d = 0; d < shape_.data_sets.size(); ++d)
    data_.push_back(layout(shape_.data_sets[d].from, first_data_writer_group + d, data_fields(shape_.data_sets[d])));
  for (const uadp::PeriodicFixedLayout& each : states_)
    TAKT_CHECK(each.size() == state_octets(shape_.variant), "a state has its length");
  for (const uadp::PeriodicFixedLayout& each : data_)
    TAKT_CHECK(each.field_offset(0, 0) == fields_at, "fields begin at octet 20");
}

std::size_t ProgramFormat::longest() const {
  std::size_t octets = state_octets(shape_.variant);
  for (const uadp::PeriodicFixedLayout& each : data_) octets = std::max(octets, each.size());
  return octets;
}

uadp::Octets ProgramFormat::encode(const StateMessage& message, std::span<std::byte> target) const {
  const uadp::PeriodicFixedLayout& layout = states_[message.sender];
  shape_.variant == Variant::robust ? layout.start<state_octets(Variant::robust)>(target, message.sequence)
                                    : layout.start(target, message.sequence);
  layout.set_header(target, 0, message.sequence);
  // start() has seen that there is room; the constructor, that the fields end with the message.
  std::byte* const fields = target.data() + fields_at;
  uadp::store_little_endian(fields, static_cast<std::int32_t>(message.word.state));
  if (shape_.variant == Variant::robust) {
    uadp::store_little_endian(fields + 4, message.word.incarnation);
    uadp::store_little_endian(fields + 8, message.word.run);
    uadp::store_little_endian(fields + 12, message.word.intent.number);
    uadp::store_little_endian(fields + 16, message.word.intent.run);
    uadp::store_little_endian(fields + 20, static_cast<std::uint8_t>(message.word.intent.kind));
    uadp::store_little_endian(fields + 21, message.word.intent.origin);
  }
  return target.first(layout.size());
}

uadp::Octets ProgramFormat::encode(const ProcessDataMessage& message, std::span<std::byte> target) const {
  const uadp::PeriodicFixedLayout& layout = data_[message.data_set];
  layout.start(target, message.sequence);
  layout.set_header(target, 0, message.sequence);
  uadp::store_little_endian(target.data() + fields_at, message.run);
  if (!message.fields.empty()) {
    TAKT_CHECK(process_data_octets(0) + message.fields.size() == layout.size(), "all fields of a data set, or none");
    std::copy(message.fields.begin(), message.fields.end(), target.begin() + process_data_octets(0));
  }
  return target.first(layout.size());
}

std::optional<ProgramMessage> ProgramFormat::decode(uadp::Octets octets) const {
  const auto sender = sender_of(octets);
  if (!sender) return std::nullopt;
  const auto group = uadp::load_little_endian<std::uint16_t>(octets.data() + writer_group_at);
  if (group == state_writer_group) return decode_state(static_cast<std::uint8_t>(*sender), octets);
  ProcessDataMessage message;
  return decode_data(static_cast<std::uint16_t>(group - first_data_writer_group), octets, message)
             ? std::optional<ProgramMessage>(message)
             : std::nullopt;
}

bool ProgramFormat::decode(uadp::Octets octets, ProcessDataMessage& message) const {
  if (octets.size() < fields_at) return false;
  return decode_data(
      static_cast<std::uint16_t>(uadp::load_little_endian<std::uint16_t>(octets.data() + writer_group_at) -
                                 first_data_writer_group),
      octets, message);
}

Verdict ProgramFormat::refusal_of(uadp::Octets octets) const {
  uadp::NetworkMessage message;
  const uadp::DecodeStatus status = uadp::decode(octets, message);
  if (status == uadp::DecodeStatus::secured) return Verdict::secured;
  if (status != uadp::DecodeStatus::ok) return Verdict::not_uadp;
  const auto& id = message.header.publisher_id;
  const auto& group = message.header.group;
  if (!id || id->type != uadp::PublisherIdType::UInt16) return Verdict::other_publisher;
  const std::size_t sender = static_cast<std::uint16_t>(id->number - shape_.first_publisher_id);
  if (sender >= states_.size()) return Verdict::other_publisher;
  if (!group || !group->writer_group_id) return Verdict::other_group;
  const bool is_state = group->writer_group_id == state_writer_group;
  const std::size_t data_set = static_cast<std::uint16_t>(*group->writer_group_id - first_data_writer_group);
  if (!is_state && (data_set >= data_.size() || shape_.data_sets[data_set].from != sender)) return Verdict::other_group;
  if (group->group_version != group_version_) return Verdict::other_version;
  return (is_state ? states_[sender] : data_[data_set]).matches(octets) ? Verdict::impossible : Verdict::other_layout;
}

std::optional<ProgramMessage> ProgramFormat::decode_state(std::uint8_t sender, uadp::Octets octets) const {
  const uadp::PeriodicFixedLayout& layout = states_[sender];
  if (!layout.matches(octets) || has_no_value(octets)) return std::nullopt;
  StateMessage message;
  message.sender = sender;
  message.sequence = layout.sequence_number(octets, 0);
  uadp::Reader reader(octets.subspan(fields_at));
  const auto state = handshake::published_state_from_number(reader.get<std::uint32_t>());
  if (!state) return std::nullopt;
  message.word.state = *state;
  if (shape_.variant == Variant::paper) return message;
  message.word.incarnation = reader.get<std::uint32_t>();
  message.word.run = reader.get<std::uint32_t>();
  message.word.intent.number = reader.get<std::uint32_t>();
  message.word.intent.run = reader.get<std::uint32_t>();
  message.word.intent.kind = static_cast<handshake::IntentKind>(reader.get<std::uint8_t>());
  message.word.intent.origin = reader.get<std::uint8_t>();
  if (!handshake::is_valid(message.word, shape_.variant, shape_.participants.size() - 1)) return std::nullopt;
  return message;
}

/// The layout holds the PublisherId of the only participant that may send the data set.
inline bool ProgramFormat::decode_data(std::size_t data_set, uadp::Octets octets, ProcessDataMessage& message) const {
  if (data_set >= data_.size()) return false;
  const uadp::PeriodicFixedLayout& layout = data_[data_set];
  if (!layout.matches(octets) || has_no_value(octets)) return false;
  message.sender = shape_.data_sets[data_set].from;
  message.data_set = static_cast<std::uint8_t>(data_set);
  message.sequence = layout.sequence_number(octets, 0);
  message.run = uadp::load_little_endian<std::uint32_t>(octets.data() + fields_at);
  message.fields = octets.subspan(process_data_octets(0), layout.size() - process_data_octets(0));
  return true;
}

}  // namespace takt::wire
