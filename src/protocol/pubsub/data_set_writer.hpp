// SPDX-License-Identifier: Apache-2.0
// DataSetWriter: makes the DataSetMessages of one DataSet (OPC 10000-14, 6.2.4).
#pragma once

#include <string>
#include <vector>

#include "pubsub/content_mask.hpp"
#include "pubsub/data_set.hpp"
#include "pubsub/pubsub_state.hpp"
#include "sim/time.hpp"
#include "uadp/data_set_message_encoder.hpp"

namespace takt::pubsub {

struct DataSetWriterSettings {
  std::uint16_t data_set_writer_id = 0;  ///< 0: the next free one of the Publisher, from 1 on
  std::uint32_t data_set_message_content_mask = data_set_message_content::SequenceNumber;
  uadp::FieldEncoding field_encoding = uadp::FieldEncoding::Variant;
  /// Of DataValues: what each has beside its value. Its fields are Good, and a StatusCode that is Good is left out (OPC
  /// 10000-6, 5.2.2.17).
  std::uint32_t data_set_field_content_mask = 0;
  /// At least every so many PublishingIntervals a key frame, delta frames between; at least 1. 1 where delta frames
  /// cannot be: RawData, a single field, no PayloadHeader.
  std::uint32_t key_frame_count = 1;
  std::size_t configured_size = 0;  ///< octets of the DataSetMessage; 0: as long as it is
  std::uint32_t major_version = 0;  ///< ConfigurationVersion: VersionTime
  std::uint32_t minor_version = 0;
};

enum class Composed : std::uint8_t { nothing, message, too_long };

class DataSetWriter {
 public:
  /// `most_octets` bounds a DataSetMessage. The DataSet outlives the writer.
  DataSetWriter(std::string name, AnyDataSet& data_set, const DataSetWriterSettings& settings, std::size_t most_octets);

  const std::string& name() const { return name_; }
  std::uint16_t id() const { return settings_.data_set_writer_id; }
  PubSubComponent& component() { return component_; }
  const PubSubComponent& component() const { return component_; }

  /// Writes the message of this PublishingInterval: a key frame, a delta frame, a keep-alive or nothing.
  /// `keep_alive_time` 0: no keep-alives.
  Composed compose(sim::LocalTime now, uadp::DateTime timestamp, sim::Duration keep_alive_time, uadp::Writer& writer);

  /// True if the application has set the DataSet since the last message.
  bool changed() const { return data_set_.version() != sent_version_; }
  /// The next message is a key frame.
  void restart() { intervals_since_key_ = 0; }
  /// Sequence number of the next DataSetMessage.
  std::uint16_t next_sequence_number() const { return sequence_number_; }

 private:
  struct Fields {
    std::vector<std::byte> octets;  ///< Variants, one behind the other
    std::vector<std::size_t> ends;  ///< of each field
    uadp::Octets field(std::size_t index) const {
      const std::size_t begin = index == 0 ? 0 : ends[index - 1];
      return uadp::Octets(octets).subspan(begin, ends[index] - begin);
    }
  };

  bool sample();
  bool delta_pays() const;
  uadp::DataSetMessageHeader header_of(uadp::DataSetMessageType type, uadp::DateTime timestamp) const;
  void put_key_frame(uadp::DataSetMessageEncoder& encoder, uadp::DateTime timestamp, uadp::Writer& writer) const;
  void put_delta_frame(uadp::DataSetMessageEncoder& encoder, uadp::DateTime timestamp, uadp::Writer& writer) const;
  void put_field(uadp::DataSetMessageEncoder& encoder, std::size_t field, uadp::DateTime timestamp,
                 uadp::Writer& writer) const;
  std::size_t octets_beside_value() const;
  bool has_changed(std::size_t field) const;

  std::string name_;
  AnyDataSet& data_set_;
  DataSetWriterSettings settings_;
  std::optional<uadp::RawLayout> raw_layout_;
  PubSubComponent component_;
  Fields sampled_;
  Fields sent_;
  std::uint32_t intervals_since_key_ = 0;  ///< 0: a key frame is next
  std::uint16_t sequence_number_ = 0;
  std::uint64_t sent_version_ = 0;
  std::optional<sim::LocalTime> last_sent_;
};

}  // namespace takt::pubsub
