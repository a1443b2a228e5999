// SPDX-License-Identifier: Apache-2.0
// Writes a NetworkMessage with its DataSetMessages into octets that the caller owns; allocates nothing.
#pragma once

#include "uadp/data_set_message_encoder.hpp"
#include "uadp/network_message.hpp"

namespace takt::uadp {

/// Use: construct; for each DataSetMessage begin, its fields, end (or append a finished one); finish. Flags follow from
/// what the headers hold, in the canonical form: a flag octet that would be 0 is left out.
class NetworkMessageEncoder {
 public:
  /// With a PayloadHeader: `writer_ids` says which DataSetMessages follow, 1 to 255.
  NetworkMessageEncoder(std::span<std::byte> target, const NetworkMessageHeader& header,
                        std::span<const std::uint16_t> writer_ids);
  /// Without a PayloadHeader: the receivers know by configuration what follows.
  NetworkMessageEncoder(std::span<std::byte> target, const NetworkMessageHeader& header);
  NetworkMessageEncoder(const NetworkMessageEncoder&) = delete;
  NetworkMessageEncoder& operator=(const NetworkMessageEncoder&) = delete;

  /// See DataSetMessageEncoder.
  void begin(const DataSetMessageHeader& header) { message_.begin(header); }
  template <class T>
  void field(const T& value) {
    message_.field(value);
  }
  template <class T>
  void delta_field(std::uint16_t index, const T& value) {
    message_.delta_field(index, value);
  }
  void body(Octets octets) { message_.body(octets); }
  void count_fields(std::size_t count) { message_.count_fields(count); }
  void end(std::size_t configured_size = 0) { note(message_.end(configured_size)); }

  /// A whole DataSetMessage that was encoded before.
  void append(Octets data_set_message);

  /// The NetworkMessage; nothing if it does not fit or a DataSetMessage is longer than a size can say.
  Octets finish();

  std::size_t position() const { return writer_.position(); }

 private:
  void put_header(const NetworkMessageHeader& header, bool has_payload_header,
                  std::span<const std::uint16_t> writer_ids);
  /// A DataSetMessage of this length is complete.
  void note(std::size_t size);

  Writer writer_;
  DataSetMessageEncoder message_;
  std::size_t expected_;      ///< DataSetMessages; 0 if nobody said how many
  std::size_t ended_ = 0;     ///< DataSetMessages so far
  std::size_t sizes_at_ = 0;  ///< position of the Sizes
  bool has_sizes_ = false;
  bool is_too_long_ = false;  ///< a size is beyond what 16 bits say
};

}  // namespace takt::uadp
