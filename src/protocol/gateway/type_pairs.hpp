// SPDX-License-Identifier: Apache-2.0
// Which types stand for each other (OMG DDS-OPCUA 1.0, 8.2), and whether a field and a member fit.
#pragma once

#include "gateway/type_mapping.hpp"

namespace takt::gateway {

struct TypePair {
  uadp::BuiltInType field;
  IdlKind member;
};

/// The first pair of a built-in type is what `idl_member_of` chooses. ByteString is a sequence of octets and not here.
inline constexpr TypePair type_pairs[] = {
    {uadp::BuiltInType::Boolean, IdlKind::boolean},   {uadp::BuiltInType::SByte, IdlKind::int8},
    {uadp::BuiltInType::Byte, IdlKind::octet},        {uadp::BuiltInType::Byte, IdlKind::uint8},
    {uadp::BuiltInType::Int16, IdlKind::int16},       {uadp::BuiltInType::UInt16, IdlKind::uint16},
    {uadp::BuiltInType::Int32, IdlKind::int32},       {uadp::BuiltInType::UInt32, IdlKind::uint32},
    {uadp::BuiltInType::Int64, IdlKind::int64},       {uadp::BuiltInType::UInt64, IdlKind::uint64},
    {uadp::BuiltInType::Float, IdlKind::float32},     {uadp::BuiltInType::Double, IdlKind::float64},
    {uadp::BuiltInType::String, IdlKind::string},     {uadp::BuiltInType::DateTime, IdlKind::int64},
    {uadp::BuiltInType::Guid, IdlKind::guid},         {uadp::BuiltInType::XmlElement, IdlKind::string},
    {uadp::BuiltInType::StatusCode, IdlKind::uint32},
};

/// Why the values of one cannot become those of the other; empty if they can. Lengths that only a value shows are
/// looked at then.
std::string mismatch_of(const uadp::RawField& field, const IdlMember& member, Direction direction);

}  // namespace takt::gateway
