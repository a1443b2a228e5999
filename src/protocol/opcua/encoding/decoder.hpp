// SPDX-License-Identifier: Apache-2.0
// Reads OPC UA Binary (OPC 10000-6, 5.2), never past the end, and never makes more of the octets than its limits allow.
#pragma once

#include "opcua/encoding/encoder.hpp"

namespace takt::opcua {

/// Of one message. Beyond them it is Bad_EncodingLimitsExceeded.
struct DecodingLimits {
  std::size_t text_octets = 64 * 1024;  ///< of a String or a ByteString
  std::size_t array_elements = 10'000;  ///< of one array
  std::size_t elements = 100'000;       ///< of all arrays and values of a message: they bound the memory that it takes
  int depth = 8;                        ///< of values in values
};

class Decoder {
 public:
  explicit Decoder(Octets octets, const DecodingLimits& limits = {})
      : reader_(octets), limits_(limits), budget_(limits.elements) {}

  template <sim::Number T>
  T get() {
    return reader_.get<T>();
  }
  Octets take(std::size_t octets) { return reader_.take(octets); }
  /// Int32 length and octets; `is_null` if the length is -1. Another negative one is malformed.
  Octets read_with_length(bool& is_null);
  /// How many elements follow; nothing for a null array. Never more than there are octets, each of which has one at
  /// least.
  std::optional<std::size_t> count();
  void fail(StatusCode why = StatusCode::BadDecodingError) {
    if (failure_ == StatusCode::Good) failure_ = why;
    reader_.fail();
  }

  /// Goes one deeper while it lives.
  class Deeper {
   public:
    explicit Deeper(Decoder& decoder) : decoder_(decoder) {
      if (++decoder_.depth_ > decoder_.limits_.depth) decoder_.fail(StatusCode::BadEncodingLimitsExceeded);
    }
    Deeper(const Deeper&) = delete;
    Deeper& operator=(const Deeper&) = delete;
    ~Deeper() { --decoder_.depth_; }

   private:
    Decoder& decoder_;
  };

  bool failed() const { return reader_.failed(); }
  /// Good, Bad_DecodingError or Bad_EncodingLimitsExceeded.
  StatusCode status() const {
    return !reader_.failed()              ? StatusCode::Good
           : failure_ == StatusCode::Good ? StatusCode::BadDecodingError
                                          : failure_;
  }
  std::size_t left() const { return reader_.left(); }
  std::size_t position() const { return reader_.position(); }
  const DecodingLimits& limits() const { return limits_; }

 private:
  uadp::Reader reader_;
  DecodingLimits limits_;
  std::size_t budget_;
  int depth_ = 0;
  StatusCode failure_ = StatusCode::Good;
};

template <sim::Number T>
void decode(Decoder& from, T& number) {
  number = from.get<T>();
}
inline void decode(Decoder& from, bool& flag) { flag = from.get<std::uint8_t>() != 0; }
template <Enumerated T>
void decode(Decoder& from, T& value) {
  value = static_cast<T>(from.get<std::underlying_type_t<T>>());
}
inline void decode(Decoder& from, DateTime& time) { time.ticks = from.get<std::int64_t>(); }
void decode(Decoder& from, Text& text);
void decode(Decoder& from, Bytes& octets);
void decode(Decoder& from, Guid& guid);
void decode(Decoder& from, XmlElement& xml);
void decode(Decoder& from, NodeId& id);
void decode(Decoder& from, ExpandedNodeId& id);
void decode(Decoder& from, QualifiedName& name);
void decode(Decoder& from, LocalizedText& text);
void decode(Decoder& from, DiagnosticInfo& info);
void decode(Decoder& from, ExtensionObject& object);
void decode(Decoder& from, Variant& value);
void decode(Decoder& from, DataValue& value);

template <Structure T>
void decode(Decoder& from, T& structure);

template <class T>
void decode(Decoder& from, List<T>& list) {
  const auto count = from.count();
  list.clear();
  list.is_empty_not_null = count.has_value();
  for (std::size_t i = 0; i < count.value_or(0) && !from.failed(); ++i) {
    T element{};
    decode(from, element);
    list.push_back(std::move(element));
  }
}

template <Structure T>
void decode(Decoder& from, T& structure) {
  std::apply([&](auto... member) { (decode(from, structure.*member), ...); }, T::members());
}

/// The body as this structure; nothing if it is of another type, no octets, or malformed.
template <Structure T>
std::optional<T> structure_in(const ExtensionObject& object, const DecodingLimits& limits = {}) {
  if (object.type != NodeId(T::encoding_id) || object.form != 1) return std::nullopt;
  Decoder decoder(object.body.value, limits);
  T made;
  decode(decoder, made);
  return decoder.failed() ? std::nullopt : std::optional<T>(std::move(made));
}

}  // namespace takt::opcua
