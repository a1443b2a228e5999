// SPDX-License-Identifier: Apache-2.0
// Which C++ types can be fields, and what limits each may have: CodecOf<T> for every such T.
//
// The templates only convert types to the untyped functions of table.hpp, so that each field costs little to compile.
#pragma once

#include <concepts>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "json/quantity.hpp"
#include "json/table.hpp"
#include "json/type.hpp"

namespace takt::json {

/// A type that has a table: `const Object& describe(Type<T>)`, or Enumeration, Tagged or Custom. It must be declared
/// beside the type, before the type is first used as a field.
template <class T>
concept Described = requires {
  describe(Type<T>{});
};

/// A value and where it was written, for fields whose struct does not keep a Source (see fields.hpp).
template <class T>
struct Located {
  T value{};
  Source where;
  bool operator==(const Located&) const = default;
};

/// A JSON object whose keys are names that the user chooses, in the order of the file.
template <class T>
using NameMap = std::vector<std::pair<std::string, T>>;

/// A value, or "auto": takt chooses one before the run and writes it here.
template <class T>
struct OrAuto {
  T value{};
  bool is_auto = false;  ///< nothing has been chosen yet
  constexpr OrAuto() = default;
  constexpr OrAuto(T chosen) : value(chosen) {}
  constexpr operator T() const { return value; }
  friend constexpr bool operator==(const OrAuto&, const OrAuto&) = default;
  friend constexpr bool operator==(const OrAuto& a, const T& b) { return !a.is_auto && a.value == b; }
};

template <class T>
struct CodecOf;  // a type without a specialisation cannot be a field; a struct or enum needs describe()

/// Limits of fields without any.
struct NoLimits {
  static constexpr void apply(Bounds&) {}
};

template <class T>
constexpr Bounds bounds_of(const typename CodecOf<T>::Limits& limits) {
  Bounds bounds;
  limits.apply(bounds);
  return bounds;
}

template <Described T>
struct CodecOf<T> {
  using Limits = NoLimits;
  static constexpr Codec codec{
      [](const Node& node, void* value, const Bounds&, Reader& reader) {
        decode_by(describe(Type<T>{}), node, value, reader);
      },
      [](const void* value) { return encode_by(describe(Type<T>{}), value); },
      [](const Bounds&, SchemaBuilder& builder) { return schema_by(describe(Type<T>{}), builder); }};
};

template <>
struct CodecOf<bool> {
  using Limits = NoLimits;
  static constexpr Codec codec{[](const Node& node, void* value, const Bounds&, Reader& reader) {
                                 decode_bool(node, *static_cast<bool*>(value), reader);
                               },
                               [](const void* value) { return Node::of_bool(*static_cast<const bool*>(value)); },
                               [](const Bounds&, SchemaBuilder&) { return bool_schema(); }};
};

template <>
struct CodecOf<std::string> {
  struct Limits {
    std::size_t min_length = 0;
    std::size_t max_length = std::numeric_limits<std::size_t>::max();
    constexpr void apply(Bounds& bounds) const {
      bounds.min_length = min_length;
      bounds.max_length = max_length;
    }
  };
  static constexpr Codec codec{
      [](const Node& node, void* value, const Bounds& bounds, Reader& reader) {
        decode_string(node, *static_cast<std::string*>(value), bounds, reader);
      },
      [](const void* value) { return Node::of_string(*static_cast<const std::string*>(value)); },
      [](const Bounds& bounds, SchemaBuilder&) { return string_schema(bounds); }};
};

template <>
struct CodecOf<double> {
  struct Limits {
    std::optional<double> min{};
    std::optional<double> max{};
    bool above_min = false;  ///< min itself is excluded
    constexpr void apply(Bounds& bounds) const {
      bounds.has_min = min.has_value();
      bounds.has_max = max.has_value();
      bounds.above_min = above_min;
      bounds.min_real = min.value_or(0);
      bounds.max_real = max.value_or(0);
    }
  };
  static constexpr Codec codec{[](const Node& node, void* value, const Bounds& bounds, Reader& reader) {
                                 decode_double(node, *static_cast<double*>(value), bounds, reader);
                               },
                               [](const void* value) { return Node::of_double(*static_cast<const double*>(value)); },
                               [](const Bounds& bounds, SchemaBuilder&) { return double_schema(bounds); }};
};

template <std::integral T>
requires(!std::same_as<T, bool>) struct CodecOf<T> {
  struct Limits {
    T min = std::numeric_limits<T>::min();
    T max = std::numeric_limits<T>::max();
    constexpr void apply(Bounds& bounds) const {
      bounds.has_min = bounds.has_max = true;
      bounds.min = min;
      bounds.max = max;
    }
  };
  static constexpr Codec codec{[](const Node& node, void* value, const Bounds& bounds, Reader& reader) {
                                 sim::int128 number = 0;
                                 if (decode_integer(node, number, bounds, reader))
                                   *static_cast<T*>(value) = static_cast<T>(number);
                               },
                               [](const void* value) { return Node::of_integer(*static_cast<const T*>(value)); },
                               [](const Bounds& bounds, SchemaBuilder&) { return integer_schema(bounds); }};
};

/// Joins a quantity's type to its dimension: the integer member that holds its value in takt's unit.
template <class Q>
struct QuantityOf;
template <>
struct QuantityOf<sim::Duration> {
  static constexpr const Dimension& dimension = duration_dimension;
  static constexpr std::int64_t raw(sim::Duration q) { return q.ps(); }
  static constexpr sim::Duration make(sim::int128 raw) {
    return sim::Duration::from_ps(static_cast<std::int64_t>(raw));
  }
};
template <>
struct QuantityOf<sim::DataRate> {
  static constexpr const Dimension& dimension = data_rate_dimension;
  static constexpr sim::int128 raw(sim::DataRate q) { return q.bits_per_second; }
  static constexpr sim::DataRate make(sim::int128 raw) { return {static_cast<std::uint64_t>(raw)}; }
};
template <>
struct QuantityOf<sim::Length> {
  static constexpr const Dimension& dimension = length_dimension;
  static constexpr std::int64_t raw(sim::Length q) { return q.millimetres; }
  static constexpr sim::Length make(sim::int128 raw) { return {static_cast<std::int64_t>(raw)}; }
};
template <>
struct QuantityOf<sim::Octets> {
  static constexpr const Dimension& dimension = octets_dimension;
  static constexpr std::int64_t raw(sim::Octets q) { return q.count; }
  static constexpr sim::Octets make(sim::int128 raw) { return {static_cast<std::uint32_t>(raw)}; }
};
template <>
struct QuantityOf<sim::FrequencyOffset> {
  static constexpr const Dimension& dimension = frequency_offset_dimension;
  static constexpr std::int64_t raw(sim::FrequencyOffset q) { return q.parts_per_trillion; }
  static constexpr sim::FrequencyOffset make(sim::int128 raw) { return {static_cast<std::int64_t>(raw)}; }
};
template <>
struct QuantityOf<FrequencyDrift> {
  static constexpr const Dimension& dimension = frequency_drift_dimension;
  static constexpr std::int64_t raw(FrequencyDrift q) { return q.parts_per_trillion_per_second; }
  static constexpr FrequencyDrift make(sim::int128 raw) { return {static_cast<std::int64_t>(raw)}; }
};
template <>
struct QuantityOf<Probability> {
  static constexpr const Dimension& dimension = probability_dimension;
  static constexpr std::int64_t raw(Probability q) { return q.parts_per_quintillion; }
  static constexpr Probability make(sim::int128 raw) { return {static_cast<std::int64_t>(raw)}; }
};

template <class T>
concept Quantity = requires(T q) {
  QuantityOf<T>::raw(q);
};

template <Quantity T>
struct CodecOf<T> {
  /// Durations are not negative unless min is. min and max belong to the range unless above_min.
  struct Limits {
    std::optional<T> min{};
    std::optional<T> max{};
    bool above_min = false;
    constexpr void apply(Bounds& bounds) const {
      bounds.has_min = min.has_value();
      bounds.has_max = max.has_value();
      bounds.above_min = above_min;
      if (min) bounds.min = QuantityOf<T>::raw(*min);
      if (max) bounds.max = QuantityOf<T>::raw(*max);
    }
  };
  static constexpr Codec codec{
      [](const Node& node, void* value, const Bounds& bounds, Reader& reader) {
        sim::int128 number = 0;
        if (decode_quantity(node, number, QuantityOf<T>::dimension, bounds, reader))
          *static_cast<T*>(value) = QuantityOf<T>::make(number);
      },
      [](const void* value) {
        return encode_quantity(QuantityOf<T>::raw(*static_cast<const T*>(value)), QuantityOf<T>::dimension);
      },
      [](const Bounds& bounds, SchemaBuilder&) { return quantity_schema(QuantityOf<T>::dimension, bounds); }};
};

template <Quantity T>
struct CodecOf<OrAuto<T>> {
  using Limits = typename CodecOf<T>::Limits;
  static constexpr Codec codec{
      [](const Node& node, void* value, const Bounds& bounds, Reader& reader) {
        auto& made = *static_cast<OrAuto<T>*>(value);
        made.is_auto = node.kind == Kind::string && node.text == "auto";
        if (!made.is_auto) CodecOf<T>::codec.decode(node, &made.value, bounds, reader);
      },
      [](const void* value) {
        const auto& written = *static_cast<const OrAuto<T>*>(value);
        return written.is_auto ? Node::of_string("auto") : CodecOf<T>::codec.encode(&written.value);
      },
      [](const Bounds& bounds, SchemaBuilder&) { return quantity_or_auto_schema(QuantityOf<T>::dimension, bounds); }};
};

/// May be absent, without a default. Left out when it is written and empty.
template <class T>
struct CodecOf<std::optional<T>> {
  using Limits = typename CodecOf<T>::Limits;
  static constexpr Codec codec{
      [](const Node& node, void* value, const Bounds& bounds, Reader& reader) {
        CodecOf<T>::codec.decode(node, &static_cast<std::optional<T>*>(value)->emplace(), bounds, reader);
      },
      [](const void* value) { return CodecOf<T>::codec.encode(&**static_cast<const std::optional<T>*>(value)); },
      [](const Bounds& bounds, SchemaBuilder& builder) { return CodecOf<T>::codec.schema(bounds, builder); },
      [](const void* value) { return !static_cast<const std::optional<T>*>(value)->has_value(); }};
};

template <class T>
struct CodecOf<Located<T>> {
  using Limits = typename CodecOf<T>::Limits;
  static constexpr Codec codec{
      [](const Node& node, void* value, const Bounds& bounds, Reader& reader) {
        auto& located = *static_cast<Located<T>*>(value);
        located.where = reader.source(node);
        CodecOf<T>::codec.decode(node, &located.value, bounds, reader);
      },
      [](const void* value) { return CodecOf<T>::codec.encode(&static_cast<const Located<T>*>(value)->value); },
      [](const Bounds& bounds, SchemaBuilder& builder) { return CodecOf<T>::codec.schema(bounds, builder); }};
};

/// Limits of arrays and maps, and of what they contain.
template <class T>
struct ItemLimits {
  std::size_t min_items = 0;
  std::size_t max_items = std::numeric_limits<std::size_t>::max();
  bool unique = false;  ///< no two items are written alike (arrays)
  typename CodecOf<T>::Limits items{};
  constexpr void apply(Bounds& bounds) const {
    items.apply(bounds);  // of arrays in arrays only the outer one has limits of its number
    bounds.min_items = min_items;
    bounds.max_items = max_items;
    bounds.unique_items = unique;
  }
};

template <class T>
struct CodecOf<std::vector<T>> {
  static_assert(!std::same_as<T, bool>, "std::vector<bool> has no references to its items");
  using Limits = ItemLimits<T>;
  using Vector = std::vector<T>;
  static constexpr Sequence sequence{
      &CodecOf<T>::codec, [](void* v) -> void* { return &static_cast<Vector*>(v)->emplace_back(); },
      [](const void* v) { return static_cast<const Vector*>(v)->size(); },
      [](const void* v, std::size_t index) -> const void* { return &(*static_cast<const Vector*>(v))[index]; },
      [](void* v) { static_cast<Vector*>(v)->clear(); }};
  static constexpr Codec codec{
      [](const Node& node, void* value, const Bounds& bounds, Reader& reader) {
        decode_sequence(node, value, sequence, bounds, reader);
      },
      [](const void* value) { return encode_sequence(value, sequence); },
      [](const Bounds& bounds, SchemaBuilder& builder) { return sequence_schema(CodecOf<T>::codec, bounds, builder); }};
};

template <class T>
struct CodecOf<std::vector<std::pair<std::string, T>>> {
  using Limits = ItemLimits<T>;
  using Map = NameMap<T>;
  static constexpr Mapping mapping{
      &CodecOf<T>::codec,
      [](void* m, const std::string& name) -> void* {
        return &static_cast<Map*>(m)
                    ->emplace_back(std::piecewise_construct, std::forward_as_tuple(name), std::tuple<>{})
                    .second;
      },
      [](const void* m) { return static_cast<const Map*>(m)->size(); },
      [](const void* m, std::size_t index) -> const std::string& { return (*static_cast<const Map*>(m))[index].first; },
      [](const void* m, std::size_t index) -> const void* { return &(*static_cast<const Map*>(m))[index].second; },
      [](void* m) { static_cast<Map*>(m)->clear(); }};
  static constexpr Codec codec{
      [](const Node& node, void* value, const Bounds& bounds, Reader& reader) {
        decode_mapping(node, value, mapping, bounds, reader);
      },
      [](const void* value) { return encode_mapping(value, mapping); },
      [](const Bounds& bounds, SchemaBuilder& builder) { return mapping_schema(CodecOf<T>::codec, bounds, builder); }};
};

}  // namespace takt::json
