// SPDX-License-Identifier: Apache-2.0
// DataSetReader: takes the DataSetMessages of one DataSetWriter into a DataSet (OPC 10000-14, 6.2.9).
#pragma once

#include <string>

#include "pubsub/data_set.hpp"
#include "pubsub/pubsub_state.hpp"
#include "sim/time.hpp"
#include "uadp/data_set_message.hpp"
#include "uadp/sequence_number.hpp"

namespace takt::pubsub {

struct DataSetReaderSettings {
  std::uint16_t data_set_writer_id = 0;  ///< 0: the next one of the Subscriber, from 1 on, as a Publisher numbers them
  /// Without a new message for so long the reader is in Error (Bad_Timeout), until one comes; 0: never.
  sim::Duration message_receive_timeout = {};
  std::optional<std::uint32_t> major_version = {};  ///< a message with another one is not understood
  /// Of messages without a PayloadHeader: octets of the DataSetMessage in its NetworkMessage; 0: as long as it is.
  std::size_t configured_size = 0;
  /// After a gap in the sequence numbers delta frames are not taken until the next key frame: what is lost may have
  /// changed fields that they do not have. Otherwise fields keep what they last had.
  bool needs_key_after_gap = false;
};

/// What a reader did with DataSetMessages.
struct ReaderCounts {
  std::uint64_t taken = 0;        ///< key frames, delta frames, events
  std::uint64_t keep_alives = 0;  ///< and heartbeats, which are key or delta frames without fields
  std::uint64_t not_newer = 0;    ///< the same again, overtaken, or with a number far away
  std::uint64_t not_valid = 0;    ///< the publisher says so
  std::uint64_t without_key = 0;  ///< delta frames before the first key frame, and behind a gap where it counts
  std::uint64_t other_version = 0;
  std::uint64_t mismatched = 0;  ///< malformed, or of other types or numbers of fields than the DataSet
  std::uint64_t with_bad = 0;    ///< of those taken: with fields that are Bad and so have no value
  bool operator==(const ReaderCounts&) const = default;
};

class DataSetReader {
 public:
  /// The DataSet outlives the reader.
  DataSetReader(std::string name, AnyDataSet& data_set, const DataSetReaderSettings& settings);

  const std::string& name() const { return name_; }
  std::uint16_t writer_id() const { return settings_.data_set_writer_id; }
  PubSubState state() const { return component_.state(); }
  /// Why it is in Error.
  StatusCode failure() const { return component_.failure(); }
  const ReaderCounts& counts() const { return counts_; }
  /// Sequence numbers that were jumped over.
  std::uint64_t missed() const { return window_.missed(); }
  /// Called when the state has changed; it may ask the reader, but must not change it.
  void on_state(std::function<void(PubSubState from, PubSubState to)> call_back) { call_back_ = std::move(call_back); }

  StatusCode enable();
  StatusCode disable();
  void set_parent(PubSubState parent);

  /// Takes a DataSetMessage. Returns how many octets of `octets` it occupies; nothing if that cannot be told.
  std::optional<std::size_t> take(uadp::Octets octets, sim::LocalTime now);

  /// When the time-out strikes; never if none runs.
  sim::LocalTime next_time() const { return deadline_; }
  void advance(sim::LocalTime now);

 private:
  std::optional<std::size_t> length_of(const uadp::DataSetMessage& message) const;
  void accept_message(const uadp::DataSetMessage& message, sim::LocalTime now);
  bool is_new(const uadp::DataSetMessageHeader& header);
  bool is_behind_gap(const uadp::DataSetMessageHeader& header) const;
  bool accept_fields(const uadp::DataSetMessage& message);
  bool accept_raw(const uadp::DataSetMessage& message);
  bool is_heartbeat(const uadp::DataSetMessage& message) const;
  bool fits(const uadp::DataSetMessage& message) const;
  void alive(sim::LocalTime now, bool starts);
  void tell(PubSubState before);

  std::string name_;
  AnyDataSet& data_set_;
  DataSetReaderSettings settings_;
  std::optional<uadp::RawLayout> raw_layout_;
  PubSubComponent component_{true};
  uadp::SequenceWindow window_;
  bool has_key_ = false;
  sim::LocalTime deadline_ = sim::LocalTime::never();
  ReaderCounts counts_;
  std::function<void(PubSubState, PubSubState)> call_back_;
};

}  // namespace takt::pubsub
