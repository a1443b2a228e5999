// SPDX-License-Identifier: Apache-2.0
// Writes CDR (DDS-XTypes 7.4): primitives, strings, sequences, arrays, aligned from behind the encapsulation header.
#pragma once

#include <algorithm>
#include <string_view>

#include "dds/message/encapsulation.hpp"
#include "dds/message/octets.hpp"

namespace takt::dds {

/// Writes a serialized payload from its encapsulation header on. Members of a struct one behind the other; bool is an
/// octet 0 or 1, char is std::uint8_t or char, an enum is its std::int32_t.
class CdrWriter {
 public:
  /// `encapsulation` is one of cdr and cdr2 (final types), in either byte order.
  explicit CdrWriter(std::span<std::byte> target, Encapsulation encapsulation = Encapsulation::cdr_le)
      : writer_(target, static_cast<std::uint16_t>(encapsulation) % 2 != 0 ? ByteOrder::little : ByteOrder::big),
        greatest_alignment_(encapsulation >= Encapsulation::cdr2_be ? 4 : 8) {
    TAKT_CHECK(encapsulation <= Encapsulation::cdr_le || encapsulation == Encapsulation::cdr2_be ||
                   encapsulation == Encapsulation::cdr2_le,
               "types are final, and members stand in their order");
    writer_.put(std::uint8_t{0});
    writer_.put(static_cast<std::uint8_t>(encapsulation));
    writer_.put_zeros(2);
  }

  template <Number T>
  void put(T number) {
    align(sizeof(T));
    writer_.put(number);
  }
  void put(bool value) { writer_.put(static_cast<std::uint8_t>(value ? 1 : 0)); }
  /// A string with its length, which counts the octet 0 at its end. `text` has no octet 0.
  void put(std::string_view text) {
    put(static_cast<std::uint32_t>(text.size() + 1));
    writer_.put_octets(std::as_bytes(std::span(text)));
    writer_.put(std::uint8_t{0});
  }
  /// Elements without a length.
  template <Number T>
  void put_array(std::span<const T> elements) {
    for (const T element : elements) put(element);
  }
  /// Elements with their number.
  template <Number T>
  void put_sequence(std::span<const T> elements) {
    begin_sequence(elements.size());
    put_array(elements);
  }
  /// The number of elements; the caller puts them.
  void begin_sequence(std::size_t count) { put(static_cast<std::uint32_t>(count)); }

  /// The payload, filled up to a multiple of 4, which its options tell; nothing if it does not fit.
  Octets finish() {
    const std::size_t filling = rounded_up(writer_.position(), 4) - writer_.position();
    writer_.put_zeros(filling);
    if (!writer_.overflowed()) writer_.patch(3, static_cast<std::uint8_t>(filling));
    return writer_.finished();
  }

 private:
  void align(std::size_t size) { writer_.align(std::min(size, greatest_alignment_), encapsulation_size); }

  Writer writer_;
  std::size_t greatest_alignment_;
};

}  // namespace takt::dds
