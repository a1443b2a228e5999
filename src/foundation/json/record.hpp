// SPDX-License-Identifier: Apache-2.0
// Records: each struct that takt writes is described once, and what it writes, its JSON Schema, its reference for
// people and the list of its figures are walks over that. What is read has tables of its own (table.hpp).
//
//   const json::Record& describe(json::Type<PortResult>) {   // declared beside the struct, in its namespace
//     static constexpr json::Output outputs[] = {
//         json::output<&PortResult::node>("node", "The node."),
//         json::output<&PortResult::queue_peak>("queue_peak", "Most frames in one queue.", {.counts_from_start =
//         true}),
//     };
//     static constexpr json::Record record{"port", "An egress port.", outputs};
//     return record;
//   }
//
// A value may be a bool, integer, double, text, time (in ps), a described struct, or std::optional (null), std::vector
// or array, or a vector of names and these.
#pragma once

#include <array>
#include <concepts>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "json/node.hpp"
#include "json/type.hpp"
#include "sim/time.hpp"

namespace takt::json {

struct Record;

/// What can stand at some place of an output.
struct Shape {
  enum class Kind : std::uint8_t { truth, integer, real, text, record, list, map };
  Kind kind;
  std::string_view unit = {};
  const Record& (*record)() = nullptr;  ///< of a record
  const Shape* item = nullptr;          ///< of a list or map
  bool may_be_null = false;
};

/// What an output means beyond its type.
struct Meaning {
  std::string_view unit = {};  ///< of a number; times have theirs
  std::string_view keys = {};  ///< of a map: what its names are, such as "stream"; empty: of no list of the scenario
  bool counts_from_start = false;  ///< whatever instant the figures are asked from, with all that is in it
  bool is_zero_if_absent = false;  ///< a map that names only what occurred
  bool is_judgement = false;       ///< of what was required: with all that is in it no figure itself
};

/// A member of a record.
struct Output {
  std::string_view name;
  std::string_view help;
  Meaning meaning;
  const Shape* shape = nullptr;
  Node (*write)(const void* object) = nullptr;
  bool (*is_there)(const void* object) = nullptr;  ///< null: always
  std::string_view only;                           ///< "with a warm-up": when it is there, in words
  bool is_spread = false;                          ///< its members stand here instead of itself
};

struct Record {
  std::string_view name;  ///< of the definition in the schema
  std::string_view help;
  std::span<const Output> outputs;
  bool is_row = false;  ///< written as an array of its values
};

/// Whether and in what way a type is written.
template <class T>
concept Recorded = requires {
  { describe(Type<T>{}) } -> std::same_as<const Record&>;
};

Node write_record(const Record& record, const void* object);
/// The JSON Schema (draft-07) of what write_record() gives.
Node record_schema(const Record& record, std::string_view title);
/// Markdown for people: a section for each record. `opening` is the text below the title.
std::string record_reference(const Record& record, std::string_view title, std::string_view opening);

template <class T>
struct ShapeOf;  // a type without a specialisation cannot be written; a struct needs describe()

template <Recorded T>
struct ShapeOf<T> {
  static constexpr Shape shape{Shape::Kind::record, {}, []() -> const Record& { return describe(Type<T>{}); }};
  static Node write(const T& value) { return write_record(describe(Type<T>{}), &value); }
};
template <>
struct ShapeOf<bool> {
  static constexpr Shape shape{Shape::Kind::truth};
  static Node write(bool value) { return Node::of_bool(value); }
};
template <std::integral T>
requires(!std::same_as<T, bool>) struct ShapeOf<T> {
  static constexpr Shape shape{Shape::Kind::integer};
  static Node write(T value) { return Node::of_integer(static_cast<sim::int128>(value)); }
};
template <>
struct ShapeOf<double> {
  static constexpr Shape shape{Shape::Kind::real};
  static Node write(double value) { return Node::of_double(value); }
};
template <class T>
requires std::convertible_to<const T&, std::string_view>
struct ShapeOf<T> {
  static constexpr Shape shape{Shape::Kind::text};
  static Node write(std::string_view value) { return Node::of_string(value); }
};
template <>
struct ShapeOf<sim::Duration> {
  static constexpr Shape shape{Shape::Kind::integer, "ps"};
  static Node write(sim::Duration value) { return Node::of_integer(value.ps()); }
};
template <>
struct ShapeOf<sim::TrueTime> {
  static constexpr Shape shape{Shape::Kind::integer, "ps"};
  static Node write(sim::TrueTime value) { return Node::of_integer(value.ps()); }
};
/// Null if there is none.
template <class T>
struct ShapeOf<std::optional<T>> {
  static constexpr Shape shape = [] {
    Shape made = ShapeOf<T>::shape;
    made.may_be_null = true;
    return made;
  }();
  static Node write(const std::optional<T>& value) { return value ? ShapeOf<T>::write(*value) : Node(); }
};
template <class T>
struct ShapeOf<std::vector<T>> {
  static constexpr Shape shape{Shape::Kind::list, {}, nullptr, &ShapeOf<T>::shape};
  static Node write(const std::vector<T>& values) {
    Node array = Node::array();
    for (const T& value : values) array.items.push_back(ShapeOf<T>::write(value));
    return array;
  }
};
template <class T, std::size_t count>
struct ShapeOf<std::array<T, count>> {
  static constexpr Shape shape{Shape::Kind::list, {}, nullptr, &ShapeOf<T>::shape};
  static Node write(const std::array<T, count>& values) {
    return ShapeOf<std::vector<T>>::write({values.begin(), values.end()});
  }
};
template <class T>
struct ShapeOf<std::vector<std::pair<std::string, T>>> {
  static constexpr Shape shape{Shape::Kind::map, {}, nullptr, &ShapeOf<T>::shape};
  static Node write(const std::vector<std::pair<std::string, T>>& values) {
    Node object = Node::object();
    for (const auto& [name, value] : values) object.add(name, ShapeOf<T>::write(value));
    return object;
  }
};

namespace detail {
/// The struct that a pointer to a member, or to a function of it, belongs to.
template <class T>
struct OwnerOf;
template <class Struct, class Value>
struct OwnerOf<Value Struct::*> {
  using Type = Struct;
};
template <class Struct, class Value>
struct OwnerOf<Value (*)(const Struct&)> {
  using Type = Struct;
};
template <auto Get>
using Owner = typename OwnerOf<decltype(Get)>::Type;
template <auto Get>
using ValueOf = std::remove_cvref_t<std::invoke_result_t<decltype(Get), const Owner<Get>&>>;
template <auto Get>
decltype(auto) get(const void* object) {
  return std::invoke(Get, *static_cast<const Owner<Get>*>(object));
}

template <class Row>
inline constexpr Shape rows_shape{Shape::Kind::map, {}, nullptr, &ShapeOf<Row>::shape};
template <const Record& (*Part)()>
inline constexpr Shape part_shape{Shape::Kind::record, {}, Part};

template <class T>
bool is_something(const T& value) {
  if constexpr (requires { value.has_value(); })
    return value.has_value();
  else if constexpr (requires { value.empty(); })
    return !value.empty();
  else
    return value != T{};
}
}  // namespace detail

/// A member, or what a function (of the struct, or of a reference to it) makes of it.
template <auto Get>
constexpr Output output(std::string_view name, std::string_view help, const Meaning& meaning = {}) {
  using Value = detail::ValueOf<Get>;
  return {name,
          help,
          meaning,
          &ShapeOf<Value>::shape,
          [](const void* object) { return ShapeOf<Value>::write(detail::get<Get>(object)); },
          nullptr,
          {},
          false};
}

/// Left out where there is none of it: nothing, an empty text or list, zero. `only` says when it is there.
template <auto Get>
constexpr Output output_if_any(std::string_view name, std::string_view help, std::string_view only,
                               const Meaning& meaning = {}) {
  Output made = output<Get>(name, help, meaning);
  made.is_there = [](const void* object) { return detail::is_something(detail::get<Get>(object)); };
  made.only = only;
  return made;
}

/// Left out where a member or function of the struct says so.
template <auto Is>
constexpr Output only_if(Output made, std::string_view words) {
  made.is_there = [](const void* object) -> bool { return detail::get<Is>(object); };
  made.only = words;
  return made;
}

/// Rows, as an object with the name that each row has.
template <auto Get, auto Name>
constexpr Output outputs_by_name(std::string_view name, std::string_view help, const Meaning& meaning = {}) {
  using Row = typename detail::ValueOf<Get>::value_type;
  Output made = output<Get>(name, help, meaning);
  made.shape = &detail::rows_shape<Row>;
  made.write = [](const void* object) {
    Node all = Node::object();
    for (const Row& row : detail::get<Get>(object)) all.add(std::invoke(Name, row), ShapeOf<Row>::write(row));
    return all;
  };
  return made;
}

/// An object of its own with some outputs of the same struct.
template <class Struct, const Record& (*Part)()>
constexpr Output part(std::string_view name, std::string_view help, const Meaning& meaning = {}) {
  return {name,
          help,
          meaning,
          &detail::part_shape<Part>,
          [](const void* object) { return write_record(Part(), object); },
          nullptr,
          {},
          false};
}

/// The outputs of a member, among those of the struct.
template <auto Get>
constexpr Output spread(const Meaning& meaning = {}) {
  Output made = output<Get>("", "", meaning);
  made.is_spread = true;
  return made;
}

/// The value as JSON text.
template <Recorded T>
std::string write(const T& value) {
  return pretty(ShapeOf<T>::write(value));
}

}  // namespace takt::json
