// SPDX-License-Identifier: Apache-2.0
// Field tables: each struct of a JSON input is described once, and is read, written and put into the schema by that.
//
//   struct Link {
//     json::Source where;                              // optional: filled with the place where the link is written
//     std::vector<std::string> ends;
//     sim::DataRate rate = 1_Gbps;                     // the initialiser is the default of an optional field
//     bool operator==(const Link&) const = default;
//   };
//   const json::Object& describe(json::Type<Link>);    // beside the struct, in its namespace
//
//   const json::Object& describe(json::Type<Link>) {   // in a .cpp
//     static constexpr json::Field fields[] = {
//         json::required<&Link::ends>("ends", "The two nodes that it joins.", {.min_items = 2, .max_items = 2}),
//         json::optional<&Link::rate>("rate", "Bits a second in each direction.", {.min = 10_Mbps}),
//     };
//     static constexpr json::Object table = json::object<Link>("link", "A full-duplex cable.", fields);
//     return table;
//   }
//
// A field may be a bool, integer, double, string, a quantity of sim/units.hpp or quantity.hpp, an enum or struct with
// describe(), or std::optional, Located, std::vector or NameMap of these. Unknown keys are errors, null is no value.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

#include "json/codecs.hpp"
#include "json/document.hpp"
#include "json/table.hpp"

namespace takt::json {

namespace detail {
template <auto Member>
struct MemberOf;
template <class Of, class Value, Value Of::*Member>
struct MemberOf<Member> {
  using Struct = Of;
  using Type = Value;
  /// A member of a base is found through the struct that has it: the base need not lie at its beginning.
  template <class Owner>
  static void* get(void* object) {
    return &(static_cast<Owner*>(object)->*Member);
  }
};
template <auto Member>
using LimitsOf = typename CodecOf<typename MemberOf<Member>::Type>::Limits;
}  // namespace detail

/// A field that must be written. Of a member of a base the struct that the table describes is told as `Owner`.
template <auto Member, class Owner = typename detail::MemberOf<Member>::Struct>
constexpr Field required(std::string_view name, std::string_view help, const detail::LimitsOf<Member>& limits = {}) {
  using Value = typename detail::MemberOf<Member>::Type;
  return {name,
          help,
          true,
          bounds_of<Value>(limits),
          &CodecOf<Value>::codec,
          &detail::MemberOf<Member>::template get<Owner>};
}

/// A field that keeps its initialiser if it is not written.
template <auto Member, class Owner = typename detail::MemberOf<Member>::Struct>
constexpr Field optional(std::string_view name, std::string_view help, const detail::LimitsOf<Member>& limits = {}) {
  Field field = required<Member, Owner>(name, help, limits);
  field.is_required = false;
  return field;
}

/// Of the named fields, which must all be optional, exactly one (at most one, at least one) is written.
constexpr Group exactly_one_of(std::span<const std::string_view> names) { return {Group::Rule::exactly_one, names}; }
constexpr Group at_most_one_of(std::span<const std::string_view> names) { return {Group::Rule::at_most_one, names}; }
constexpr Group at_least_one_of(std::span<const std::string_view> names) { return {Group::Rule::at_least_one, names}; }

struct ObjectOptions {
  std::span<const Group> groups{};
  /// The name of a field: `"50ppm"` then stands for `{"offset": "50ppm"}`. No other field may be required.
  std::string_view shorthand{};
};

/// The table of a struct. It must be default-constructible; a member `json::Source where` gets where it was written.
template <class T>
constexpr Object object(std::string_view name, std::string_view help, std::span<const Field> fields,
                        ObjectOptions options = {}) {
  Object table{name,
               help,
               fields,
               options.groups,
               options.shorthand,
               nullptr,
               [](void (*use)(const void*, void*), void* context) {
                 const T prototype{};
                 use(&prototype, context);
               }};
  if constexpr (requires(T & t) {
                  { t.where } -> std::same_as<Source&>;
                })
    table.where = [](void* value) { return &static_cast<T*>(value)->where; };
  return table;
}

/// One name of an enum.
template <class E>
constexpr EnumName name(E value, std::string_view text, std::string_view help) {
  return {static_cast<std::int64_t>(value), text, help};
}

/// The table of an enum: `what` says what it is ("an operating system"). Every value must have a name.
template <class E>
constexpr Enumeration enumeration(std::string_view what, std::span<const EnumName> names) {
  return {what, names, [](const void* value) { return static_cast<std::int64_t>(*static_cast<const E*>(value)); },
          [](void* value, std::int64_t number) { *static_cast<E*>(value) = static_cast<E>(number); }};
}

namespace detail {
template <class Variant, std::size_t... Is>
constexpr std::array<Option, sizeof...(Is)> options(const std::array<std::string_view, sizeof...(Is)>& tags,
                                                    std::index_sequence<Is...>) {
  return {Option{tags[Is], []() -> const Object& { return describe(Type<std::variant_alternative_t<Is, Variant>>{}); },
                 [](void* value) -> void* { return &static_cast<Variant*>(value)->template emplace<Is>(); }}...};
}
}  // namespace detail

/// The options of a variant of described structs: one tag for each, in the order of the variant.
template <class Variant>
constexpr auto options(const std::array<std::string_view, std::variant_size_v<Variant>>& tags) {
  return detail::options<Variant>(tags, std::make_index_sequence<std::variant_size_v<Variant>>{});
}

/// The table of a variant: an object whose member `key` is the tag of one of the options and whose other members are
/// the fields of that option. describe(Type<std::variant<...>>) is found by the namespace of the alternatives.
template <class Variant>
constexpr Tagged tagged(std::string_view name, std::string_view help, std::string_view key,
                        std::span<const Option> options) {
  return {name,
          help,
          key,
          options,
          [](const void* value) { return static_cast<const Variant*>(value)->index(); },
          [](const void* value) {
            return std::visit([](const auto& alternative) -> const void* { return &alternative; },
                              *static_cast<const Variant*>(value));
          }};
}

/// The table of a type with functions of its own: void decode(const Node&, T&, Reader&), Node encode(const T&) and
/// Node schema(SchemaBuilder&). They may call decode_value, encode_value and schema_value for parts.
template <class T, void (*Decode)(const Node&, T&, Reader&), Node (*Encode)(const T&), Node (*Schema)(SchemaBuilder&)>
constexpr Custom custom() {
  return {[](const Node& node, void* value, Reader& reader) { Decode(node, *static_cast<T*>(value), reader); },
          [](const void* value) { return Encode(*static_cast<const T*>(value)); }, Schema};
}

template <class T>
void decode_value(const Node& node, T& value, Reader& reader, const typename CodecOf<T>::Limits& limits = {}) {
  CodecOf<T>::codec.decode(node, &value, bounds_of<T>(limits), reader);
}
template <class T>
Node encode_value(const T& value) {
  return CodecOf<T>::codec.encode(&value);
}
template <class T>
Node schema_value(SchemaBuilder& builder, const typename CodecOf<T>::Limits& limits = {}) {
  return CodecOf<T>::codec.schema(bounds_of<T>(limits), builder);
}

/// Reads a whole document. True if it had no mistake; all mistakes are reported, and what could be read is in `value`.
/// The root object may have a member "$schema" (a string, for editors), which is ignored.
template <Described T>
bool decode(const Document& document, T& value, Diagnostics& diagnostics) {
  const std::size_t errors_before = diagnostics.errors();
  Reader reader(document, diagnostics);
  decode_value(document.root(), value, reader);
  return diagnostics.errors() == errors_before;
}

/// The value as JSON text with all defaults filled in; decode() reads it back.
template <Described T>
std::string encode(const T& value) {
  return pretty(encode_value(value));
}

/// The JSON Schema (draft-07) of a document: accepts all that decode() accepts, and refuses all it can express.
template <Described T>
Node schema_tree(std::string_view title) {
  return root_schema(describe(Type<T>{}), title);
}
template <Described T>
std::string schema(std::string_view title) {
  return pretty(schema_tree<T>(title));
}

}  // namespace takt::json
