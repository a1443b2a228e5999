// SPDX-License-Identifier: Apache-2.0
// What a gateway knows of an IDL struct: its members and their types (OMG IDL 4.2, 7.4; DDS-XTypes 1.3, 7.2.2).
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace takt::gateway {

/// Kinds of IDL types. `guid` is the struct { uint32 data1; uint16 data2; uint16 data3; octet data4[8]; }. Those from
/// `char8` on have no counterpart among the built-in types of OPC UA, or none that a mapping knows without their
/// declaration.
enum class IdlKind : std::uint8_t {
  boolean,
  octet,
  int8,
  uint8,
  int16,
  uint16,
  int32,
  uint32,
  int64,
  uint64,
  float32,
  float64,
  string,
  guid,
  char8,
  char16,
  float128,
  wstring,
  enumeration,
  bitmask,
  structure,
  union_of_members,
  map,
  any
};

struct IdlKindInfo {
  IdlKind kind;
  std::string_view name;   ///< as IDL writes it
  std::uint8_t octets;     ///< of a value in XCDR1; 0 if they vary or it is refused
  std::uint8_t alignment;  ///< in XCDR1; 0 if it is refused
};

inline constexpr std::array<IdlKindInfo, 24> idl_kinds{{
    {IdlKind::boolean, "boolean", 1, 1},
    {IdlKind::octet, "octet", 1, 1},
    {IdlKind::int8, "int8", 1, 1},
    {IdlKind::uint8, "uint8", 1, 1},
    {IdlKind::int16, "short", 2, 2},
    {IdlKind::uint16, "unsigned short", 2, 2},
    {IdlKind::int32, "long", 4, 4},
    {IdlKind::uint32, "unsigned long", 4, 4},
    {IdlKind::int64, "long long", 8, 8},
    {IdlKind::uint64, "unsigned long long", 8, 8},
    {IdlKind::float32, "float", 4, 4},
    {IdlKind::float64, "double", 8, 8},
    {IdlKind::string, "string", 0, 4},
    {IdlKind::guid, "Guid", 16, 4},
    {IdlKind::char8, "char", 0, 0},
    {IdlKind::char16, "wchar", 0, 0},
    {IdlKind::float128, "long double", 0, 0},
    {IdlKind::wstring, "wstring", 0, 0},
    {IdlKind::enumeration, "enum", 0, 0},
    {IdlKind::bitmask, "bitmask", 0, 0},
    {IdlKind::structure, "struct", 0, 0},
    {IdlKind::union_of_members, "union", 0, 0},
    {IdlKind::map, "map", 0, 0},
    {IdlKind::any, "any", 0, 0},
}};

constexpr std::size_t index_of(IdlKind kind) { return static_cast<std::size_t>(kind); }
constexpr const IdlKindInfo& info(IdlKind kind) { return idl_kinds[index_of(kind)]; }

namespace detail {
constexpr bool idl_kinds_are_complete() {
  for (std::size_t i = 0; i < idl_kinds.size(); ++i)
    if (index_of(idl_kinds[i].kind) != i || idl_kinds[i].name.empty()) return false;
  return index_of(IdlKind::any) + 1 == idl_kinds.size();
}
static_assert(idl_kinds_are_complete(), "idl_kinds holds every kind, in its order");
}  // namespace detail

enum class IdlCollection : std::uint8_t { none, array, sequence };

/// A member of a struct. Arrays have one dimension; sequences hold no sequences.
struct IdlMember {
  std::string name;
  IdlKind kind = IdlKind::float64;
  IdlCollection collection = IdlCollection::none;
  std::uint32_t length = 0;        ///< of an array; of a sequence the bound, 0: none
  std::uint32_t string_bound = 0;  ///< octets without the terminating one; 0: none
  bool operator==(const IdlMember&) const = default;
};

/// As IDL writes it: "sequence<double, 8>", "string<16>", "long a[3]" without the name: "long[3]".
std::string text_of(const IdlMember& member);

/// A final struct: its members in the order of their declaration.
struct IdlStruct {
  std::string name;
  std::vector<IdlMember> members;
  bool operator==(const IdlStruct&) const = default;
};

}  // namespace takt::gateway
