// SPDX-License-Identifier: Apache-2.0
#include "uadp/data_set_message.hpp"

#include "uadp/flags.hpp"

namespace takt::uadp {
namespace {

constexpr std::uint32_t bad = 0x80000000;

bool has(unsigned octet, unsigned flag) { return (octet & flag) != 0; }

/// RawData has no place in delta frames and events (OPC 10000-14, 7.2.4.5.6 and 7.2.4.5.7); an event has Variants only.
bool is_contradictory(const DataSetMessageHeader& header) {
  if (header.type == DataSetMessageType::DeltaFrame) return header.encoding == FieldEncoding::RawData;
  return header.type == DataSetMessageType::Event && header.encoding != FieldEncoding::Variant;
}

}  // namespace

DecodeStatus decode(Octets octets, DataSetMessage& message) {
  message = {};
  Reader reader(octets);
  DataSetMessageHeader& header = message.header;
  const unsigned first = reader.get<std::uint8_t>();
  if (reader.failed()) return DecodeStatus::truncated;
  header.valid = has(first, flags::valid);
  if (!header.valid) {
    message.body = reader.rest();
    message.body_offset = reader.position();
    return DecodeStatus::ok;
  }
  const unsigned encoding = first >> flags::field_encoding_shift & flags::field_encoding_mask;
  if (encoding > static_cast<unsigned>(FieldEncoding::DataValue)) return DecodeStatus::reserved;
  header.encoding = static_cast<FieldEncoding>(encoding);
  const unsigned second = has(first, flags::data_set_flags_2) ? reader.get<std::uint8_t>() : 0U;
  const unsigned type = second & flags::data_set_message_type_mask;
  if (type > static_cast<unsigned>(DataSetMessageType::KeepAlive)) return DecodeStatus::reserved;
  if (has(second, flags::data_set_flags_2_reserved)) return DecodeStatus::reserved;
  header.type = static_cast<DataSetMessageType>(type);
  if (has(first, flags::sequence_number)) header.sequence_number = reader.get<std::uint16_t>();
  if (has(second, flags::data_set_timestamp)) header.timestamp = get_value<DateTime>(reader);
  if (has(second, flags::data_set_picoseconds)) header.picoseconds = reader.get<std::uint16_t>();
  if (has(first, flags::status)) header.status = reader.get<std::uint16_t>();
  if (has(first, flags::major_version)) header.major_version = reader.get<std::uint32_t>();
  if (has(first, flags::minor_version)) header.minor_version = reader.get<std::uint32_t>();
  if (reader.failed()) return DecodeStatus::truncated;
  message.body = reader.rest();
  message.body_offset = reader.position();
  return is_contradictory(header) ? DecodeStatus::malformed : DecodeStatus::ok;
}

FieldReader::FieldReader(const DataSetMessage& message)
    : reader_(message.body),
      encoding_(message.header.encoding),
      is_delta_(message.header.type == DataSetMessageType::DeltaFrame) {
  const bool has_fields = message.header.valid && message.header.type != DataSetMessageType::KeepAlive &&
                          encoding_ != FieldEncoding::RawData && !message.body.empty();
  if (has_fields) count_ = reader_.get<std::uint16_t>();
}

std::optional<Field> FieldReader::next() {
  if (given_ == count_ || failed()) return std::nullopt;
  Field field;
  field.index = is_delta_ ? reader_.get<std::uint16_t>() : static_cast<std::uint16_t>(given_);
  if (encoding_ == FieldEncoding::DataValue) {
    field.value = get_data_value(reader_);
  } else {
    field.value.value = get_variant(reader_);
  }
  if (failed()) return std::nullopt;
  ++given_;
  return field;
}

std::optional<FieldState> state_of(const DataValue& field, BuiltInType type) {
  FieldState state{field.value, Status{field.status.value_or(0)}};
  const auto is_instead = [&](BuiltInType other) {
    return state.value && !state.value->is_array && state.value->type == other && type != other;
  };
  if (is_instead(BuiltInType::DataValue)) {
    Reader reader(state.value->octets);
    const DataValue within = get_data_value(reader);
    if (reader.failed()) return std::nullopt;
    state.value = within.value;
    if (within.status) state.status = Status{*within.status};
  }
  if (is_instead(BuiltInType::StatusCode)) {
    state.status = state.value->get<Status>().value_or(Status{bad});
    state.value.reset();
  }
  if (state.status.is_bad() || (state.value && state.value->is_null())) state.value.reset();
  return state;
}

bool is_well_formed(const DataSetMessage& message) {
  FieldReader fields(message);
  while (fields.next()) {
  }
  return !fields.failed();
}

}  // namespace takt::uadp
