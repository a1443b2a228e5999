// SPDX-License-Identifier: Apache-2.0
#include "uadp/data_set_message_encoder.hpp"

#include "uadp/flags.hpp"

namespace takt::uadp {
namespace {

constexpr std::size_t most_fields = 0xFFFF;

unsigned flag_if(bool present, unsigned flag) { return present ? flag : 0U; }

void put_header(Writer& writer, const DataSetMessageHeader& header) {
  const unsigned second = static_cast<unsigned>(header.type) |
                          flag_if(header.timestamp.has_value(), flags::data_set_timestamp) |
                          flag_if(header.picoseconds.has_value(), flags::data_set_picoseconds);
  const unsigned first =
      flag_if(header.valid, flags::valid) | static_cast<unsigned>(header.encoding) << flags::field_encoding_shift |
      flag_if(header.sequence_number.has_value(), flags::sequence_number) |
      flag_if(header.status.has_value(), flags::status) |
      flag_if(header.major_version.has_value(), flags::major_version) |
      flag_if(header.minor_version.has_value(), flags::minor_version) | flag_if(second != 0, flags::data_set_flags_2);
  writer.put(static_cast<std::uint8_t>(first));
  if (second != 0) writer.put(static_cast<std::uint8_t>(second));
  if (header.sequence_number) writer.put(*header.sequence_number);
  if (header.timestamp) put_value(writer, *header.timestamp);
  if (header.picoseconds) writer.put(*header.picoseconds);
  if (header.status) writer.put(*header.status);
  if (header.major_version) writer.put(*header.major_version);
  if (header.minor_version) writer.put(*header.minor_version);
}

}  // namespace

void DataSetMessageEncoder::begin(const DataSetMessageHeader& header) {
  header_ = header;
  begin_ = writer_.position();
  put_header(writer_, header);
  has_count_ =
      header.valid && header.type != DataSetMessageType::KeepAlive && header.encoding != FieldEncoding::RawData;
  count_at_ = writer_.position();
  field_count_ = 0;
  if (has_count_) writer_.put(std::uint16_t{0});
}

std::size_t DataSetMessageEncoder::end(std::size_t configured_size) {
  if (writer_.overflowed()) return 0;
  if (has_count_) {
    is_sound_ = is_sound_ && field_count_ <= most_fields;
    // A key frame without fields is a heartbeat and has no FieldCount either (OPC 10000-14, 7.2.4.5.5).
    if (field_count_ == 0 && header_.type == DataSetMessageType::KeyFrame)
      writer_.rewind_to(count_at_);
    else
      writer_.patch(count_at_, static_cast<std::uint16_t>(field_count_));
  }
  if (configured_size == 0) return writer_.position() - begin_;
  if (writer_.position() - begin_ > configured_size) {
    writer_.rewind_to(begin_);
    DataSetMessageHeader refused;
    refused.valid = false;
    put_header(writer_, refused);
  }
  writer_.put_zeros(configured_size - (writer_.position() - begin_));
  return configured_size;
}

}  // namespace takt::uadp
