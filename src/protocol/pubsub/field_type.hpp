// SPDX-License-Identifier: Apache-2.0
// Which C++ types a field of a DataSet may have, and how such a field becomes a Variant and comes back.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "uadp/raw_layout.hpp"

namespace takt::pubsub {

/// A string with room for N octets; longer text is cut. Unlike std::string it has a fixed length as RawData and never
/// allocates.
template <std::size_t N>
class BoundedString {
 public:
  BoundedString() = default;
  BoundedString(std::string_view text) : size_(std::min(text.size(), N)) {
    std::copy_n(text.data(), size_, text_.begin());
  }  // NOLINT
  std::string_view view() const { return {text_.data(), size_}; }
  bool operator==(const BoundedString& other) const { return view() == other.view(); }

 private:
  std::array<char, N> text_{};
  std::size_t size_ = 0;
};

/// A ByteString (an array of Byte is std::vector<std::uint8_t>).
using ByteString = std::vector<std::byte>;

/// How a C++ type stands for one element: its built-in type, its MaxStringLength, its value on the wire and back.
template <class T>
struct Element;
template <uadp::FixedScalar T>
struct Element<T> {
  using Wire = T;
  static constexpr std::uint32_t max_string_length = 0;
  static T to_wire(const T& value) { return value; }
  static bool from_wire(const T& wire, T& value) {
    value = wire;
    return true;
  }
};
template <>
struct Element<std::string> {
  using Wire = std::string_view;
  static constexpr std::uint32_t max_string_length = 0;
  static std::string_view to_wire(const std::string& value) { return value; }
  static bool from_wire(std::string_view wire, std::string& value) {
    value = wire;
    return true;
  }
};
template <std::size_t N>
struct Element<BoundedString<N>> {
  using Wire = std::string_view;
  static constexpr std::uint32_t max_string_length = N;
  static std::string_view to_wire(const BoundedString<N>& value) { return value.view(); }
  static bool from_wire(std::string_view wire, BoundedString<N>& value) {
    if (wire.size() > N) return false;
    value = wire;
    return true;
  }
};
template <>
struct Element<ByteString> {
  using Wire = uadp::ByteStringView;
  static constexpr std::uint32_t max_string_length = 0;
  static uadp::ByteStringView to_wire(const ByteString& value) { return {value}; }
  static bool from_wire(const uadp::ByteStringView& wire, ByteString& value) {
    value.assign(wire.octets.begin(), wire.octets.end());
    return true;
  }
};

/// A field: an element, or an array of elements. `array_length` 0 is an array of any length.
template <class T>
struct FieldType {
  using Item = T;
  static constexpr bool is_array = false;
  static constexpr std::uint32_t array_length = 0;
};
template <class T, std::size_t N>
struct FieldType<std::array<T, N>> {
  using Item = T;
  static constexpr bool is_array = true;
  static constexpr std::uint32_t array_length = N;
};
template <class T>
requires(!std::same_as<T, std::byte>) struct FieldType<std::vector<T>> {
  using Item = T;
  static constexpr bool is_array = true;
  static constexpr std::uint32_t array_length = 0;
};

/// What the DataSetMetaData says about a field of type T.
template <class T>
constexpr uadp::RawField describe_field() {
  using Type = FieldType<T>;
  using Item = Element<typename Type::Item>;
  return {uadp::BuiltIn<typename Item::Wire>::type, Type::is_array, Type::array_length, Item::max_string_length};
}

/// Writes the field as a Variant.
template <class T>
void put_field(uadp::Writer& writer, const T& value) {
  using Type = FieldType<T>;
  using Item = Element<typename Type::Item>;
  if constexpr (Type::is_array) {
    writer.put(static_cast<std::uint8_t>(uadp::index_of(describe_field<T>().type) | uadp::detail::array_flag));
    writer.put(static_cast<std::int32_t>(value.size()));
    for (std::size_t i = 0; i < value.size(); ++i) uadp::put_value(writer, Item::to_wire(value[i]));
  } else {
    uadp::put_variant(writer, Item::to_wire(value));
  }
}

/// Takes the field from a Variant; false, and the field as it was, if it is of another type or length.
template <class T>
bool accept_field(const uadp::Variant& variant, T& field) {
  using Type = FieldType<T>;
  using Item = Element<typename Type::Item>;
  using Wire = typename Item::Wire;
  if (variant.type != uadp::BuiltIn<Wire>::type || variant.is_array != Type::is_array) return false;
  if constexpr (!Type::is_array) {
    const auto wire = variant.template get<Wire>();
    return wire && Item::from_wire(*wire, field);
  } else {
    if (Type::array_length != 0 && variant.size() != Type::array_length) return false;
    T taken = field;
    if constexpr (Type::array_length == 0) taken.resize(variant.size());
    for (std::size_t i = 0; i < variant.size(); ++i) {
      const auto wire = variant.template at<Wire>(i);
      typename Type::Item item{};
      if (!wire || !Item::from_wire(*wire, item)) return false;
      taken[i] = item;
    }
    field = std::move(taken);
    return true;
  }
}

}  // namespace takt::pubsub
