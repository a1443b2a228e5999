// SPDX-License-Identifier: Apache-2.0
// Variant and DataValue (OPC 10000-6, 5.2.2.16 and 5.2.2.17) as views of encoded octets.
#pragma once

#include <optional>

#include "uadp/value.hpp"

namespace takt::uadp {

/// A value with its type, seen in octets that somebody else owns. Decoding one checks where it ends and allocates
/// nothing; the value is read when it is asked for.
struct Variant {
  BuiltInType type = BuiltInType::Null;
  bool is_array = false;
  std::int32_t length = 0;  ///< elements of an array; -1 for a null array; 0 for a scalar
  Octets octets;            ///< the value, or the elements one behind the other
  std::size_t stride = 0;   ///< octets from element to element; 0 if they are packed (only RawData pads its strings)
  Octets dimensions;        ///< Int32 count and Int32[] as encoded; empty if there are none

  bool is_null() const { return type == BuiltInType::Null; }
  std::size_t size() const {
    return is_array ? static_cast<std::size_t>(length < 0 ? 0 : length) : (is_null() ? 0U : 1U);
  }

  /// The scalar; nothing if it is an array or of another type.
  template <Scalar T>
  std::optional<T> get() const {
    return is_array ? std::nullopt : element<T>(0);
  }
  /// An element of the array; nothing if it is none, of another type, or shorter.
  template <Scalar T>
  std::optional<T> at(std::size_t index) const {
    return is_array ? element<T>(index) : std::nullopt;
  }

 private:
  template <Scalar T>
  std::optional<T> element(std::size_t index) const {
    if (type != BuiltIn<T>::type || index >= size()) return std::nullopt;
    constexpr std::size_t fixed = fixed_octets(BuiltIn<T>::type);
    const std::size_t step = stride != 0 ? stride : fixed;
    if (step != 0) {
      if (octets.size() / step <= index) return std::nullopt;
      Reader reader(octets.subspan(index * step, step));
      const T value = get_value<T>(reader);
      return reader.failed() ? std::nullopt : std::optional<T>(value);
    }
    Reader reader(octets);
    for (std::size_t i = 0; i < index; ++i) get_value<T>(reader);
    const T value = get_value<T>(reader);
    return reader.failed() ? std::nullopt : std::optional<T>(value);
  }
};

/// The members that are there (OPC 10000-6, 5.2.2.17). Picoseconds count 10 ps, 0 to 9999.
struct DataValue {
  std::optional<Variant> value;
  std::optional<std::uint32_t> status;
  std::optional<DateTime> source_timestamp;
  std::optional<std::uint16_t> source_picoseconds;
  std::optional<DateTime> server_timestamp;
  std::optional<std::uint16_t> server_picoseconds;
};

/// Reads one; the reader fails, and the result is Null, for what is malformed.
Variant get_variant(Reader& reader, int depth = 0);
DataValue get_data_value(Reader& reader);

/// Writes what was decoded, octet for octet (padded strings of RawData are packed).
void put_variant(Writer& writer, const Variant& variant);
void put_data_value(Writer& writer, const DataValue& value);

namespace detail {
inline constexpr unsigned array_flag = 0x80;
inline constexpr unsigned dimensions_flag = 0x40;
}  // namespace detail

template <Scalar T>
void put_variant(Writer& writer, const T& value) {
  writer.put(static_cast<std::uint8_t>(BuiltIn<T>::type));
  put_value(writer, value);
}
template <Scalar T>
void put_variant(Writer& writer, std::span<const T> values) {
  writer.put(static_cast<std::uint8_t>(index_of(BuiltIn<T>::type) | detail::array_flag));
  writer.put(static_cast<std::int32_t>(values.size()));
  for (const T& value : values) put_value(writer, value);
}

}  // namespace takt::uadp
