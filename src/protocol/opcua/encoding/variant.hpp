// SPDX-License-Identifier: Apache-2.0
// Variant and DataValue as values that own what they hold (OPC 10000-6, 5.2.2.16 and 5.2.2.17). src/protocol/uadp has the views.
#pragma once

#include <memory>
#include <optional>
#include <span>

#include "opcua/encoding/node_id.hpp"
#include "opcua/encoding/status.hpp"

namespace takt::opcua {

struct Variant;
struct DataValue;

/// A value in a value.
template <class T>
struct Boxed {
  std::shared_ptr<const T> value;
  friend bool operator==(const Boxed& a, const Boxed& b) {
    return a.value == b.value || (a.value && b.value && *a.value == *b.value);
  }
};

/// XML is carried as octets and never looked at.
struct XmlElement {
  Bytes octets;
  bool operator==(const XmlElement&) const = default;
};

/// One value of a built-in type; its position is the id of the type.
using Scalar = std::variant<std::monostate, bool, std::int8_t, std::uint8_t, std::int16_t, std::uint16_t, std::int32_t,
                            std::uint32_t, std::int64_t, std::uint64_t, float, double, Text, DateTime, Guid, Bytes,
                            XmlElement, NodeId, ExpandedNodeId, StatusCode, QualifiedName, LocalizedText,
                            ExtensionObject, Boxed<DataValue>, Boxed<Variant>, DiagnosticInfo>;
static_assert(std::variant_size_v<Scalar> == uadp::built_in_types.size());

/// The type of a C++ type in a Variant.
template <class T>
constexpr BuiltInType type_of() {
  return static_cast<BuiltInType>([]<std::size_t... I>(std::index_sequence<I...>) {
    return ((std::is_same_v<T, std::variant_alternative_t<I, Scalar>> ? I : 0) + ...);
  }(std::make_index_sequence<std::variant_size_v<Scalar>>()));
}

struct Variant {
  BuiltInType type = BuiltInType::Null;
  bool is_array = false;
  bool is_null_array = false;
  std::vector<Scalar> values;            ///< one of a scalar, none of Null
  std::vector<std::int32_t> dimensions;  ///< of a matrix

  Variant() = default;
  template <class T>
  requires(type_of<T>() != BuiltInType::Null) Variant(T scalar)
      : type(type_of<T>()), values{Scalar(std::move(scalar))} {}  // NOLINT: any value is a value
  template <class T>
  static Variant array(const std::vector<T>& elements) {
    Variant made;
    made.type = type_of<T>();
    made.is_array = true;
    for (const T& each : elements) made.values.emplace_back(each);
    return made;
  }
  /// A null one of an array type or of no type at all.
  bool is_null() const { return type == BuiltInType::Null || is_null_array; }
  /// The scalar of this type; null if it is something else.
  template <class T>
  const T* get() const {
    return is_array || values.empty() ? nullptr : std::get_if<T>(&values.front());
  }
  bool operator==(const Variant&) const = default;
};

struct DataValue {
  std::optional<Variant> value;
  std::optional<StatusCode> status;
  std::optional<DateTime> source_time;
  std::optional<DateTime> server_time;
  std::optional<std::uint16_t> source_picoseconds;
  std::optional<std::uint16_t> server_picoseconds;

  StatusCode result() const { return status.value_or(StatusCode::Good); }
  bool operator==(const DataValue&) const = default;
};

/// A number, or a Boolean, as a double; nothing for the rest.
std::optional<double> number_in(const Variant& value);

/// That it takes in memory, about: what is counted against a budget.
std::size_t octets_of(const Variant& value);
std::size_t octets_of(const DataValue& value);

}  // namespace takt::opcua
