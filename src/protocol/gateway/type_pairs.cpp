// SPDX-License-Identifier: Apache-2.0
#include "gateway/type_pairs.hpp"

#include <algorithm>

namespace takt::gateway {
namespace {

using uadp::BuiltInType;

/// More may come than there is room for. 0 stands for any number, which a value shows.
bool may_be_too_long(std::uint32_t given, std::uint32_t room) { return given != 0 && room != 0 && given > room; }

std::string refusal_of(const uadp::RawField& field) {
  const bool is_known = field.type == BuiltInType::ByteString ||
                        std::any_of(std::begin(type_pairs), std::end(type_pairs),
                                    [&](const TypePair& pair) { return pair.field == field.type; });
  if (!is_known)
    return text_of(field) + " is not mapped: it has no counterpart among the types of IDL that is one value";
  if (field.type == BuiltInType::ByteString && field.is_array)
    return text_of(field) + " is not mapped: it would be a sequence of sequences";
  return {};
}

std::string refusal_of(const IdlMember& member) {
  if (info(member.kind).alignment == 0)
    return text_of(member) + " is not mapped: OPC UA has no built-in type for " + std::string(info(member.kind).name);
  if (member.collection == IdlCollection::array && member.length == 0) return "an array of no elements is not IDL";
  if (member.string_bound != 0 && member.kind != IdlKind::string) return "only a string has a bound of its own";
  return {};
}

}  // namespace

std::string text_of(const uadp::RawField& type) {
  std::string text(uadp::name_of(type.type));
  if (type.max_string_length != 0) text += "(" + std::to_string(type.max_string_length) + ")";
  if (type.is_array) text += "[" + (type.array_length != 0 ? std::to_string(type.array_length) : std::string()) + "]";
  return text;
}

std::optional<IdlMember> idl_member_of(const DataSetField& field, std::string& problem) {
  problem = refusal_of(field.type);
  if (!problem.empty()) return std::nullopt;
  IdlMember member;
  member.name = field.name;
  if (field.type.type == BuiltInType::ByteString) {
    member.kind = IdlKind::octet;
    member.collection = IdlCollection::sequence;
    member.length = field.type.max_string_length;
    return member;
  }
  member.kind = std::find_if(std::begin(type_pairs), std::end(type_pairs), [&](const TypePair& pair) {
                  return pair.field == field.type.type;
                })->member;
  member.string_bound = field.type.max_string_length;
  if (field.type.is_array) {
    member.collection = field.type.array_length != 0 ? IdlCollection::array : IdlCollection::sequence;
    member.length = field.type.array_length;
  }
  return member;
}

std::string mismatch_of(const uadp::RawField& field, const IdlMember& member, Direction direction) {
  if (std::string refusal = refusal_of(field); !refusal.empty()) return refusal;
  if (std::string refusal = refusal_of(member); !refusal.empty()) return refusal;
  const bool to_dds = direction == Direction::to_dds;
  const std::string both = text_of(field) + " and " + text_of(member);
  if (field.type == BuiltInType::ByteString) {
    const bool is_octets = member.collection == IdlCollection::sequence &&
                           (member.kind == IdlKind::octet || member.kind == IdlKind::uint8);
    if (!is_octets) return both + " are not the same type: ByteString is sequence<octet>";
    const bool too_long = to_dds ? may_be_too_long(field.max_string_length, member.length)
                                 : may_be_too_long(member.length, field.max_string_length);
    return too_long ? both + ": there may come more octets than there is room for" : "";
  }
  const bool is_pair = std::any_of(std::begin(type_pairs), std::end(type_pairs), [&](const TypePair& pair) {
    return pair.field == field.type && pair.member == member.kind;
  });
  if (!is_pair) return both + " are not the same type";
  if (field.is_array != (member.collection != IdlCollection::none)) return both + ": only one of them is an array";
  if (member.collection == IdlCollection::array && field.array_length != 0 && field.array_length != member.length)
    return both + " have different lengths";
  const bool too_many =
      to_dds ? may_be_too_long(field.array_length, member.length) : may_be_too_long(member.length, field.array_length);
  if (member.collection == IdlCollection::sequence && too_many)
    return both + ": there may come more elements than there is room for";
  const bool too_long = to_dds ? may_be_too_long(field.max_string_length, member.string_bound)
                               : may_be_too_long(member.string_bound, field.max_string_length);
  return is_text(field.type) && too_long ? both + ": there may come longer strings than there is room for" : "";
}

}  // namespace takt::gateway
