// SPDX-License-Identifier: Apache-2.0
#include "pubsub/data_set_reader.hpp"

namespace takt::pubsub {

using uadp::DataSetMessageType;
using uadp::FieldEncoding;

DataSetReader::DataSetReader(std::string name, AnyDataSet& data_set, const DataSetReaderSettings& settings)
    : name_(std::move(name)), data_set_(data_set), settings_(settings), raw_layout_(raw_layout_of(data_set)) {}

StatusCode DataSetReader::enable() {
  const PubSubState before = state();
  const StatusCode status = component_.enable();
  tell(before);
  return status;
}

StatusCode DataSetReader::disable() {
  const PubSubState before = state();
  const StatusCode status = component_.disable();
  deadline_ = sim::LocalTime::never();
  tell(before);
  return status;
}

void DataSetReader::set_parent(PubSubState parent) {
  const PubSubState before = state();
  component_.set_parent(parent);
  tell(before);
}

void DataSetReader::tell(PubSubState before) {
  const PubSubState now = state();
  if (!component_.active()) {
    deadline_ = sim::LocalTime::never();
    has_key_ = false;
    window_.forget();
  }
  if (call_back_ && before != now) call_back_(before, now);
}

std::optional<std::size_t> DataSetReader::take(uadp::Octets octets, sim::LocalTime now) {
  uadp::DataSetMessage message;
  if (decode(octets, message) != uadp::DecodeStatus::ok) {
    ++counts_.mismatched;
    return std::nullopt;
  }
  const std::optional<std::size_t> length = length_of(message);
  if (component_.active()) accept_message(message, now);
  return length;
}

/// Where the next DataSetMessage begins if the NetworkMessage does not say so.
std::optional<std::size_t> DataSetReader::length_of(const uadp::DataSetMessage& message) const {
  if (settings_.configured_size != 0) return settings_.configured_size;
  if (!message.header.valid) return message.body_offset;
  if (message.header.type == DataSetMessageType::KeepAlive) return message.body_offset;
  if (message.header.encoding == FieldEncoding::RawData) {
    if (message.body.empty()) return message.body_offset;
    if (!raw_layout_) return std::nullopt;
    return message.body_offset + raw_layout_->size();
  }
  uadp::FieldReader fields(message);
  while (fields.next()) {
  }
  if (fields.failed()) return std::nullopt;
  return message.body_offset + fields.position();
}

void DataSetReader::accept_message(const uadp::DataSetMessage& message, sim::LocalTime now) {
  const uadp::DataSetMessageHeader& header = message.header;
  if (!header.valid) {
    ++counts_.not_valid;
    return;
  }
  if (settings_.major_version && header.major_version && *header.major_version != *settings_.major_version) {
    ++counts_.other_version;
    return;
  }
  // A message that will not be taken must not move the window either.
  if (header.type == DataSetMessageType::DeltaFrame && (!has_key_ || is_behind_gap(header))) {
    ++counts_.without_key;
    return;
  }
  const bool heartbeat = is_heartbeat(message);
  if (header.type != DataSetMessageType::KeepAlive && !heartbeat && !fits(message)) {
    ++counts_.mismatched;
    return;
  }
  if (!is_new(header)) {
    ++counts_.not_newer;
    return;
  }
  if (header.type == DataSetMessageType::KeepAlive) {
    ++counts_.keep_alives;
    return alive(now, false);
  }
  if (heartbeat) {
    ++counts_.keep_alives;
    return alive(now, data_set_.field_count() == 0);
  }
  ++counts_.taken;
  const bool taken = accept_fields(message);
  TAKT_CHECK(taken, "fields that fit are taken");
  if (data_set_.any_bad()) ++counts_.with_bad;
  has_key_ = has_key_ || header.type == DataSetMessageType::KeyFrame;
  alive(now, true);
  data_set_.notify();
}

/// A keep-alive carries the number that the next message will have, so it must not use it up.
bool DataSetReader::is_new(const uadp::DataSetMessageHeader& header) {
  if (!header.sequence_number) return true;
  if (header.type != DataSetMessageType::KeepAlive)
    return window_.take(*header.sequence_number) == uadp::Sequence::newer;
  return !window_.last() || uadp::compare_sequence(*header.sequence_number, *window_.last()) == uadp::Sequence::newer;
}

/// As nothing behind the gap moves the window but a key frame, all delta frames until then are behind it, too.
bool DataSetReader::is_behind_gap(const uadp::DataSetMessageHeader& header) const {
  if (!settings_.needs_key_after_gap || !header.sequence_number || !window_.last()) return false;
  const auto next = static_cast<std::uint16_t>(*window_.last() + 1);
  return uadp::compare_sequence(*header.sequence_number, *window_.last()) == uadp::Sequence::newer &&
         *header.sequence_number != next;
}

/// The header alone, without FieldCount (OPC 10000-14, 7.2.4.5.5), or no field: the publisher lives, and there is no
/// value. It uses a number up.
bool DataSetReader::is_heartbeat(const uadp::DataSetMessage& message) const {
  if (message.header.type == DataSetMessageType::KeepAlive) return false;
  if (message.header.encoding == FieldEncoding::RawData) return message.body.empty();
  const uadp::FieldReader fields(message);
  return fields.count() == 0 && !fields.failed();
}

/// All fields are there and of the types of the DataSet; so a message is taken whole or not at all. A field that
/// is Bad has no value to be of a type, and is no reason to refuse the others. A Null field, as some stacks pad delta
/// frames with, is no value and is passed over.
bool DataSetReader::fits(const uadp::DataSetMessage& message) const {
  if (message.header.encoding == FieldEncoding::RawData) {
    if (!raw_layout_) return false;
    for (std::size_t i = 0; i < raw_layout_->count(); ++i) {
      const auto value = raw_layout_->at(message.body, i);
      if (!value || !data_set_.can_take(i, *value)) return false;
    }
    return true;
  }
  uadp::FieldReader fields(message);
  const bool all = message.header.type != DataSetMessageType::DeltaFrame;
  if (all && fields.count() != data_set_.field_count()) return false;
  while (const auto field = fields.next()) {
    if (field->value.value && field->value.value->is_null() && !field->value.status) continue;
    if (field->index >= data_set_.field_count()) return false;
    const auto state = uadp::state_of(field->value, data_set_.field(field->index).type);
    if (!state || (state->value && !data_set_.can_take(field->index, *state->value))) return false;
  }
  return !fields.failed();
}

bool DataSetReader::accept_fields(const uadp::DataSetMessage& message) {
  data_set_.set_overall_status(uadp::Status{std::uint32_t{message.header.status.value_or(0)} << 16});
  if (message.header.encoding == FieldEncoding::RawData) return accept_raw(message);
  uadp::FieldReader fields(message);
  bool taken = true;
  while (const auto field = fields.next()) {
    if (field->value.value && field->value.value->is_null() && !field->value.status) continue;
    const auto state = uadp::state_of(field->value, data_set_.field(field->index).type);
    if (state->value) taken = data_set_.take(field->index, *state->value) && taken;
    data_set_.set_status(field->index, state->status);
  }
  return taken;
}

/// RawData has no room for the status of a field: that of the message counts for all of them.
bool DataSetReader::accept_raw(const uadp::DataSetMessage& message) {
  bool taken = true;
  const uadp::Status status = data_set_.overall_status();
  for (std::size_t i = 0; i < raw_layout_->count(); ++i) {
    if (!status.is_bad()) taken = data_set_.take(i, *raw_layout_->at(message.body, i)) && taken;
    data_set_.set_status(i, status);
  }
  return taken;
}

/// A new message, keep-alives included, restarts the time-out and ends an Error (OPC 10000-14, 6.2.9.6).
void DataSetReader::alive(sim::LocalTime now, bool starts) {
  const PubSubState before = state();
  if (starts) component_.start();
  component_.recover();
  const bool runs = state() == PubSubState::Operational && settings_.message_receive_timeout > sim::Duration();
  deadline_ = runs ? now.plus_saturated(settings_.message_receive_timeout) : sim::LocalTime::never();
  tell(before);
}

void DataSetReader::advance(sim::LocalTime now) {
  if (now < deadline_) return;
  const PubSubState before = state();
  deadline_ = sim::LocalTime::never();
  component_.fail(StatusCode::BadTimeout);
  window_.forget();
  tell(before);
}

}  // namespace takt::pubsub
