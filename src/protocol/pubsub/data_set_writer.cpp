// SPDX-License-Identifier: Apache-2.0
#include "pubsub/data_set_writer.hpp"

namespace takt::pubsub {

using uadp::DataSetMessageType;
using uadp::FieldEncoding;

std::optional<uadp::RawLayout> raw_layout_of(const AnyDataSet& data_set) {
  std::vector<uadp::RawField> fields;
  for (std::size_t i = 0; i < data_set.field_count(); ++i) {
    fields.push_back(data_set.field(i));
    if (!uadp::RawLayout::problem_of(fields.back()).empty()) return std::nullopt;
  }
  return uadp::RawLayout(std::move(fields));
}

DataSetWriter::DataSetWriter(std::string name, AnyDataSet& data_set, const DataSetWriterSettings& settings,
                             std::size_t most_octets)
    : name_(std::move(name)), data_set_(data_set), settings_(settings), raw_layout_(raw_layout_of(data_set)) {
  TAKT_CHECK(settings_.data_set_writer_id != 0, "a DataSetWriter has an id");
  TAKT_CHECK(settings_.field_encoding != FieldEncoding::RawData || raw_layout_,
             "RawData needs fields of fixed lengths");
  if (settings_.field_encoding == FieldEncoding::RawData || data_set_.field_count() < 2) settings_.key_frame_count = 1;
  for (Fields* fields : {&sampled_, &sent_}) {
    fields->octets.resize(most_octets);
    fields->ends.resize(data_set_.field_count());
  }
}

Composed DataSetWriter::compose(sim::LocalTime now, uadp::DateTime timestamp, sim::Duration keep_alive_time,
                                uadp::Writer& writer) {
  if (!component_.operational()) return Composed::nothing;
  if (!sample()) return Composed::too_long;
  const bool key_frame = intervals_since_key_ == 0 || !delta_pays();
  bool any_changed = key_frame;
  for (std::size_t i = 0; i < data_set_.field_count() && !any_changed; ++i) any_changed = has_changed(i);
  uadp::DataSetMessageEncoder encoder(writer);
  if (!any_changed) {
    intervals_since_key_ = (intervals_since_key_ + 1) % settings_.key_frame_count;
    const bool silent_long = keep_alive_time > sim::Duration() && last_sent_ && now - *last_sent_ >= keep_alive_time;
    if (!silent_long) return Composed::nothing;
    encoder.begin(header_of(DataSetMessageType::KeepAlive, timestamp));
    encoder.end();
  } else {
    encoder.begin(header_of(key_frame ? DataSetMessageType::KeyFrame : DataSetMessageType::DeltaFrame, timestamp));
    if (key_frame)
      put_key_frame(encoder, timestamp, writer);
    else
      put_delta_frame(encoder, timestamp, writer);
    encoder.end(settings_.configured_size);
  }
  if (writer.overflowed()) return Composed::too_long;
  last_sent_ = now;
  if (!any_changed) return Composed::message;  // a keep-alive takes no sequence number
  ++sequence_number_;
  intervals_since_key_ = ((key_frame ? 0 : intervals_since_key_) + 1) % settings_.key_frame_count;
  sent_version_ = data_set_.version();
  std::swap(sampled_, sent_);
  return Composed::message;
}

/// Encodes all fields; false if they do not fit a message.
bool DataSetWriter::sample() {
  uadp::Writer writer(sampled_.octets);
  for (std::size_t i = 0; i < data_set_.field_count(); ++i) {
    data_set_.put(writer, i);
    sampled_.ends[i] = writer.position();
  }
  return !writer.overflowed();
}

bool DataSetWriter::has_changed(std::size_t field) const {
  const uadp::Octets now = sampled_.field(field);
  const uadp::Octets before = sent_.field(field);
  return !std::equal(now.begin(), now.end(), before.begin(), before.end());
}

/// A delta frame that is longer than the key frame is never sent. It has the octet DataSetFlags2, perhaps in addition.
bool DataSetWriter::delta_pays() const {
  const std::size_t beside = octets_beside_value();
  std::size_t key = 0;
  std::size_t delta = 1;
  for (std::size_t i = 0; i < data_set_.field_count(); ++i) {
    const std::size_t octets = sampled_.field(i).size() + beside;
    key += octets;
    if (has_changed(i)) delta += sizeof(std::uint16_t) + octets;
  }
  return delta < key;
}

uadp::DataSetMessageHeader DataSetWriter::header_of(DataSetMessageType type, uadp::DateTime timestamp) const {
  const std::uint32_t mask = settings_.data_set_message_content_mask;
  uadp::DataSetMessageHeader header;
  header.type = type;
  header.encoding = settings_.field_encoding;
  if ((mask & data_set_message_content::SequenceNumber) != 0) header.sequence_number = sequence_number_;
  if ((mask & data_set_message_content::Timestamp) != 0) header.timestamp = timestamp;
  if ((mask & data_set_message_content::PicoSeconds) != 0) header.picoseconds = std::uint16_t{0};
  if ((mask & data_set_message_content::Status) != 0) header.status = std::uint16_t{0};
  if ((mask & data_set_message_content::MajorVersion) != 0) header.major_version = settings_.major_version;
  if ((mask & data_set_message_content::MinorVersion) != 0) header.minor_version = settings_.minor_version;
  return header;
}

void DataSetWriter::put_key_frame(uadp::DataSetMessageEncoder& encoder, uadp::DateTime timestamp,
                                  uadp::Writer& writer) const {
  for (std::size_t i = 0; i < data_set_.field_count(); ++i) {
    if (settings_.field_encoding == FieldEncoding::RawData) {
      uadp::Reader reader(sampled_.field(i));
      const bool fits = raw_layout_->put(writer, i, uadp::get_variant(reader));
      TAKT_CHECK(fits || writer.overflowed(), "a field fits the layout that was made of its type");
      continue;
    }
    put_field(encoder, i, timestamp, writer);
  }
}

void DataSetWriter::put_delta_frame(uadp::DataSetMessageEncoder& encoder, uadp::DateTime timestamp,
                                    uadp::Writer& writer) const {
  for (std::size_t i = 0; i < data_set_.field_count(); ++i) {
    if (!has_changed(i)) continue;
    writer.put(static_cast<std::uint16_t>(i));
    put_field(encoder, i, timestamp, writer);
  }
}

/// A Variant, or a DataValue around it: mask, value, times (OPC 10000-6, 5.2.2.17).
void DataSetWriter::put_field(uadp::DataSetMessageEncoder& encoder, std::size_t field, uadp::DateTime timestamp,
                              uadp::Writer& writer) const {
  namespace content = data_set_field_content;
  const bool is_data_value = settings_.field_encoding == FieldEncoding::DataValue;
  const auto has = [&](std::uint32_t part) {
    return is_data_value && (settings_.data_set_field_content_mask & part) != 0;
  };
  unsigned mask = 0x01;
  if (has(content::SourceTimestamp)) mask |= 0x04U;
  if (has(content::ServerTimestamp)) mask |= 0x08U;
  if (has(content::SourcePicoSeconds)) mask |= 0x10U;
  if (has(content::ServerPicoSeconds)) mask |= 0x20U;
  if (is_data_value) writer.put(static_cast<std::uint8_t>(mask));
  encoder.body(sampled_.field(field));
  if (has(content::SourceTimestamp)) uadp::put_value(writer, timestamp);
  if (has(content::SourcePicoSeconds)) writer.put(std::uint16_t{0});
  if (has(content::ServerTimestamp)) uadp::put_value(writer, timestamp);
  if (has(content::ServerPicoSeconds)) writer.put(std::uint16_t{0});
  encoder.count_fields(1);
}

std::size_t DataSetWriter::octets_beside_value() const {
  namespace content = data_set_field_content;
  if (settings_.field_encoding != FieldEncoding::DataValue) return 0;
  const auto octets = [this](std::uint32_t part, std::size_t of_it) {
    return (settings_.data_set_field_content_mask & part) != 0 ? of_it : 0;
  };
  return 1 + octets(content::SourceTimestamp, 8) + octets(content::ServerTimestamp, 8) +
         octets(content::SourcePicoSeconds, 2) + octets(content::ServerPicoSeconds, 2);
}

}  // namespace takt::pubsub
