// SPDX-License-Identifier: Apache-2.0
// Which field of a DataSet is which member of an IDL struct, and how the values of one become those of the other.
//
// Built-in types and IDL types stand for each other as in OMG DDS-OPCUA 1.0, 8.2, which also gives Guid its struct:
//
//   Boolean boolean | SByte int8 | Byte octet, uint8 | Int16 short | UInt16 unsigned short | Int32 long | UInt32,
//   StatusCode unsigned long Int64, DateTime long long | UInt64 unsigned long long | Float float | Double double |
//   String, XmlElement string | ByteString sequence<octet> Guid Guid | an array of one of them (but ByteString): an
//   array or a sequence
//
// A value is never changed on the way, but that null strings and arrays arrive empty, which CDR cannot tell apart.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dds/message/cdr_reader.hpp"
#include "gateway/idl_type.hpp"
#include "uadp/raw_layout.hpp"

namespace takt::gateway {

/// Whether values are strings, with their length before them.
constexpr bool is_text(uadp::BuiltInType type) {
  return type == uadp::BuiltInType::String || type == uadp::BuiltInType::XmlElement;
}

using uadp::Octets;

/// A field of a DataSet, as its DataSetMetaData describes it. `array_length` and `max_string_length` 0: any.
struct DataSetField {
  std::string name;
  uadp::RawField type;
  bool operator==(const DataSetField&) const = default;
};

/// As the standard writes it: "Double", "Int32[3]", "String[]".
std::string text_of(const uadp::RawField& type);

/// The IDL type that stands for a field; nothing, and `problem` says why, if none does.
std::optional<IdlMember> idl_member_of(const DataSetField& field, std::string& problem);

enum class Direction : std::uint8_t { to_dds, to_opc_ua };
constexpr std::string_view name_of(Direction direction) {
  return direction == Direction::to_dds ? "to DDS" : "to OPC UA";
}

/// A field and a member with different names.
struct Renamed {
  std::string field;
  std::string member;
};

enum class MappingError : std::uint8_t {
  none,
  malformed,      ///< the octets are not the fields, or not the members, that were agreed
  encapsulation,  ///< not plain CDR: parameter lists, XCDR2 of types that are not final
  wrong_length,   ///< an array of another length, or a sequence or string beyond its bound
  text,           ///< a string with an octet 0, which would end it in CDR
  boolean,        ///< a CDR boolean that is neither 0 nor 1
  bad_status,     ///< a field without a value, where a member needs one: CDR has no status
};
inline constexpr std::size_t mapping_error_count = 7;
inline constexpr std::array<std::string_view, mapping_error_count> mapping_error_names{
    "none", "malformed", "encapsulation", "wrong length", "text", "boolean", "bad status"};
constexpr std::string_view name_of(MappingError error) { return mapping_error_names[static_cast<std::size_t>(error)]; }

class TypeMapping {
 public:
  /// Checks all and makes the mapping. To DDS every member needs a field, to OPC UA every field a member; what is more
  /// on the side that gives is left out. Nothing if there is a problem; each is a line that names field, member and
  /// types.
  static std::optional<TypeMapping> make(Direction direction, std::vector<DataSetField> fields, IdlStruct type,
                                         const std::vector<Renamed>& renamed, std::vector<std::string>& problems);

  Direction direction() const { return direction_; }
  const std::vector<DataSetField>& fields() const { return fields_; }
  const IdlStruct& type() const { return type_; }
  /// Fields or members of the giving side that nobody takes.
  const std::vector<std::string>& left_out() const { return left_out_; }

  /// `fields`: all fields as Variants, one behind the other. `payload`: an encapsulation header and little-endian CDR
  /// of version 1. What an error leaves in the target means nothing. Nothing allocates once the target has held a
  /// payload of full length.
  MappingError to_cdr(Octets fields, std::vector<std::byte>& payload);
  /// `payload`: CDR of either byte order, of version 1 or of version 2 of a final type, with its encapsulation header.
  MappingError to_fields(Octets payload, std::vector<std::byte>& fields);
  /// By the direction.
  MappingError convert(Octets from, std::vector<std::byte>& to) {
    return direction_ == Direction::to_dds ? to_cdr(from, to) : to_fields(from, to);
  }

 private:
  TypeMapping() = default;

  Direction direction_ = Direction::to_dds;
  std::vector<DataSetField> fields_;
  IdlStruct type_;
  /// For each element of the taking side, in its order, where it comes from on the giving side.
  std::vector<std::size_t> sources_;
  std::vector<std::string> left_out_;
  std::vector<uadp::Variant> given_;     ///< room for the fields of one message
  std::vector<dds::CdrReader> members_;  ///< room for where the members of one payload begin
};

}  // namespace takt::gateway
