// SPDX-License-Identifier: Apache-2.0
// The built-in types of OPC UA (OPC 10000-6, 5.1.2) and the C++ types that stand for those with a value of their own.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "uadp/octets.hpp"

namespace takt::uadp {

/// The value is the type id of OPC UA Binary; Null is the id of an empty Variant.
enum class BuiltInType : std::uint8_t {
  Null,
  Boolean,
  SByte,
  Byte,
  Int16,
  UInt16,
  Int32,
  UInt32,
  Int64,
  UInt64,
  Float,
  Double,
  String,
  DateTime,
  Guid,
  ByteString,
  XmlElement,
  NodeId,
  ExpandedNodeId,
  StatusCode,
  QualifiedName,
  LocalizedText,
  ExtensionObject,
  DataValue,
  Variant,
  DiagnosticInfo
};

struct BuiltInInfo {
  BuiltInType type;
  std::string_view name;
  std::uint8_t octets;  ///< of a value; 0 if they vary
};

inline constexpr std::array<BuiltInInfo, 26> built_in_types{{
    {BuiltInType::Null, "Null", 0},
    {BuiltInType::Boolean, "Boolean", 1},
    {BuiltInType::SByte, "SByte", 1},
    {BuiltInType::Byte, "Byte", 1},
    {BuiltInType::Int16, "Int16", 2},
    {BuiltInType::UInt16, "UInt16", 2},
    {BuiltInType::Int32, "Int32", 4},
    {BuiltInType::UInt32, "UInt32", 4},
    {BuiltInType::Int64, "Int64", 8},
    {BuiltInType::UInt64, "UInt64", 8},
    {BuiltInType::Float, "Float", 4},
    {BuiltInType::Double, "Double", 8},
    {BuiltInType::String, "String", 0},
    {BuiltInType::DateTime, "DateTime", 8},
    {BuiltInType::Guid, "Guid", 16},
    {BuiltInType::ByteString, "ByteString", 0},
    {BuiltInType::XmlElement, "XmlElement", 0},
    {BuiltInType::NodeId, "NodeId", 0},
    {BuiltInType::ExpandedNodeId, "ExpandedNodeId", 0},
    {BuiltInType::StatusCode, "StatusCode", 4},
    {BuiltInType::QualifiedName, "QualifiedName", 0},
    {BuiltInType::LocalizedText, "LocalizedText", 0},
    {BuiltInType::ExtensionObject, "ExtensionObject", 0},
    {BuiltInType::DataValue, "DataValue", 0},
    {BuiltInType::Variant, "Variant", 0},
    {BuiltInType::DiagnosticInfo, "DiagnosticInfo", 0},
}};

constexpr std::size_t index_of(BuiltInType type) { return static_cast<std::size_t>(type); }
constexpr const BuiltInInfo& info(BuiltInType type) { return built_in_types[index_of(type)]; }
constexpr std::string_view name_of(BuiltInType type) { return info(type).name; }
/// Octets of one value, 0 if they vary.
constexpr std::size_t fixed_octets(BuiltInType type) { return info(type).octets; }

/// The type with this id; nothing for an id that there is not.
constexpr std::optional<BuiltInType> built_in_type_from_id(unsigned id) {
  if (id >= built_in_types.size()) return std::nullopt;
  return static_cast<BuiltInType>(id);
}

namespace detail {
constexpr bool built_in_types_are_complete() {
  for (std::size_t i = 0; i < built_in_types.size(); ++i)
    if (index_of(built_in_types[i].type) != i || built_in_types[i].name.empty()) return false;
  return index_of(BuiltInType::DiagnosticInfo) + 1 == built_in_types.size();
}
static_assert(built_in_types_are_complete(), "built_in_types holds every type, in the order of the ids");
}  // namespace detail

/// 100 ns since 1601-01-01 UTC (OPC 10000-6, 5.2.2.5).
struct DateTime {
  std::int64_t ticks = 0;
  constexpr auto operator<=>(const DateTime&) const = default;
};

/// The 16 octets as they stand on the wire: Data1 to Data3 are little-endian (OPC 10000-6, 5.2.2.6).
struct Guid {
  std::array<std::byte, 16> octets{};
  constexpr bool operator==(const Guid&) const = default;
};

/// A StatusCode as a value (OPC 10000-4, 7.39); 0 is Good. Its two upper bits are the severity.
struct Status {
  std::uint32_t code = 0;
  constexpr bool is_good() const { return code >> 30 == 0; }
  /// There is a value, but it is not as good as it should be.
  constexpr bool is_uncertain() const { return code >> 30 == 1; }
  /// There is no value. (The severity that is reserved is taken for Bad.)
  constexpr bool is_bad() const { return code >> 30 >= 2; }
  constexpr bool operator==(const Status&) const = default;
};

/// A ByteString that somebody else owns.
struct ByteStringView {
  Octets octets;
};

/// Which built-in type a C++ type stands for. A String is a view of UTF-8 text; null and empty strings are one.
template <class T>
struct BuiltIn;
template <BuiltInType Type>
struct BuiltInIs {
  static constexpr BuiltInType type = Type;
};
template <>
struct BuiltIn<bool> : BuiltInIs<BuiltInType::Boolean> {};
template <>
struct BuiltIn<std::int8_t> : BuiltInIs<BuiltInType::SByte> {};
template <>
struct BuiltIn<std::uint8_t> : BuiltInIs<BuiltInType::Byte> {};
template <>
struct BuiltIn<std::int16_t> : BuiltInIs<BuiltInType::Int16> {};
template <>
struct BuiltIn<std::uint16_t> : BuiltInIs<BuiltInType::UInt16> {};
template <>
struct BuiltIn<std::int32_t> : BuiltInIs<BuiltInType::Int32> {};
template <>
struct BuiltIn<std::uint32_t> : BuiltInIs<BuiltInType::UInt32> {};
template <>
struct BuiltIn<std::int64_t> : BuiltInIs<BuiltInType::Int64> {};
template <>
struct BuiltIn<std::uint64_t> : BuiltInIs<BuiltInType::UInt64> {};
template <>
struct BuiltIn<float> : BuiltInIs<BuiltInType::Float> {};
template <>
struct BuiltIn<double> : BuiltInIs<BuiltInType::Double> {};
template <>
struct BuiltIn<std::string_view> : BuiltInIs<BuiltInType::String> {};
template <>
struct BuiltIn<DateTime> : BuiltInIs<BuiltInType::DateTime> {};
template <>
struct BuiltIn<Guid> : BuiltInIs<BuiltInType::Guid> {};
template <>
struct BuiltIn<ByteStringView> : BuiltInIs<BuiltInType::ByteString> {};
template <>
struct BuiltIn<Status> : BuiltInIs<BuiltInType::StatusCode> {};

template <class T>
concept Scalar = requires {
  BuiltIn<T>::type;
};
/// Scalars whose encoding has one length.
template <class T>
concept FixedScalar = Scalar<T> &&(fixed_octets(BuiltIn<T>::type) != 0);

}  // namespace takt::uadp
