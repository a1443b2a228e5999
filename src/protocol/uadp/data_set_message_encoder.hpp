// SPDX-License-Identifier: Apache-2.0
// Writes one DataSetMessage behind what a Writer holds already; allocates nothing.
#pragma once

#include "uadp/data_set_message.hpp"

namespace takt::uadp {

/// Use: begin, the fields, end. FieldCount follows by itself.
class DataSetMessageEncoder {
 public:
  explicit DataSetMessageEncoder(Writer& writer) : writer_(writer) {}

  void begin(const DataSetMessageHeader& header);

  /// A field in the message's encoding: a scalar, an array as a span, a Variant or a DataValue.
  template <class T>
  void field(const T& value) {
    ++field_count_;
    put(value);
  }
  /// A field of a delta frame.
  template <class T>
  void delta_field(std::uint16_t index, const T& value) {
    writer_.put(index);
    field(value);
  }
  /// Octets of the body as they stand: RawData, or fields that were encoded before and are counted by `count_fields`.
  void body(Octets octets) { writer_.put_octets(octets); }
  void count_fields(std::size_t count) { field_count_ += count; }

  /// Ends the message and gives its length. `configured_size` (octets, 0: none) pads a shorter one with zeros; a longer
  /// one is replaced by a header that is not valid (OPC 10000-14, 6.3.1.3.3).
  std::size_t end(std::size_t configured_size = 0);

  /// False if there were more fields than FieldCount can say.
  bool is_sound() const { return is_sound_; }

 private:
  template <Scalar T>
  void put(const T& value) {
    if (header_.encoding == FieldEncoding::RawData) return put_value(writer_, value);
    put_mask();
    put_variant(writer_, value);
  }
  template <Scalar T>
  void put(std::span<const T> values) {
    if (header_.encoding == FieldEncoding::RawData) {
      writer_.put(static_cast<std::uint32_t>(values.size()));
      for (const T& value : values) put_value(writer_, value);
    } else {
      put_mask();
      put_variant<T>(writer_, values);
    }
  }
  void put(const Variant& value) {
    put_mask();
    put_variant(writer_, value);
  }
  void put(const DataValue& value) {
    if (header_.encoding == FieldEncoding::DataValue) return put_data_value(writer_, value);
    put_variant(writer_, value.value.value_or(Variant{}));
  }
  /// A DataValue that has a value and nothing else.
  void put_mask() {
    if (header_.encoding == FieldEncoding::DataValue) writer_.put(std::uint8_t{0x01});
  }

  Writer& writer_;
  DataSetMessageHeader header_;
  std::size_t begin_ = 0;
  std::size_t count_at_ = 0;
  bool has_count_ = false;
  bool is_sound_ = true;
  std::size_t field_count_ = 0;
};

}  // namespace takt::uadp
