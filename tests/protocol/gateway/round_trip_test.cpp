// SPDX-License-Identifier: Apache-2.0
// Fields -> CDR -> fields for random types and values gives the same octets; random octets never do harm.
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <algorithm>

#include "gateway/type_pairs.hpp"
#include "uadp/value.hpp"

namespace takt::gateway::round_trip_test {
namespace {

using uadp::BuiltInType;

bool is_text(BuiltInType type) { return type == BuiltInType::String || type == BuiltInType::XmlElement; }

DataSetField random_field(std::size_t number) {
  std::vector<BuiltInType> types;
  for (const TypePair& pair : type_pairs) types.push_back(pair.field);
  types.push_back(BuiltInType::ByteString);
  DataSetField field;
  field.name = "f" + std::to_string(number);
  field.type.type = *rc::gen::elementOf(types);
  const bool is_octets = field.type.type == BuiltInType::ByteString;
  field.type.is_array = !is_octets && *rc::gen::arbitrary<bool>();
  if (field.type.is_array) field.type.array_length = *rc::gen::inRange<std::uint32_t>(0, 5);
  if (is_octets || is_text(field.type.type)) field.type.max_string_length = *rc::gen::inRange<std::uint32_t>(0, 7);
  return field;
}

std::vector<std::byte> random_octets(std::size_t count, unsigned least) {
  std::vector<std::byte> result(count);
  for (std::byte& each : result) each = static_cast<std::byte>(*rc::gen::inRange<unsigned>(least, 256));
  return result;
}

void append(std::vector<std::byte>& target, const std::vector<std::byte>& octets) {
  target.insert(target.end(), octets.begin(), octets.end());
}
void append_length(std::vector<std::byte>& target, std::size_t length) {
  target.resize(target.size() + 4);
  uadp::store_little_endian(target.data() + target.size() - 4, static_cast<std::int32_t>(length));
}

/// A value as a Variant: canonical, so Booleans are 0 or 1, and nothing is null.
void append_value(std::vector<std::byte>& target, const uadp::RawField& field, bool lengths_are_fixed) {
  target.push_back(
      static_cast<std::byte>(uadp::index_of(field.type) | (field.is_array ? uadp::detail::array_flag : 0U)));
  std::size_t count = 1;
  if (field.is_array) {
    count = lengths_are_fixed && field.array_length != 0
                ? field.array_length
                : *rc::gen::inRange<std::size_t>(0, field.array_length != 0 ? field.array_length + 1 : 6);
    append_length(target, count);
  }
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t fixed = uadp::fixed_octets(field.type);
    if (fixed == 0) {
      const std::size_t length =
          *rc::gen::inRange<std::size_t>(0, field.max_string_length != 0 ? field.max_string_length + 1 : 9);
      append_length(target, length);
      append(target, random_octets(length, is_text(field.type) ? 1 : 0));
    } else if (field.type == BuiltInType::Boolean) {
      target.push_back(static_cast<std::byte>(*rc::gen::inRange<unsigned>(0, 2)));
    } else {
      append(target, random_octets(fixed, 0));
    }
  }
}

/// As another implementation would declare it: an array may be a sequence, bounds may be wider.
IdlMember random_member(const DataSetField& field) {
  std::string problem;
  IdlMember member = *idl_member_of(field, problem);
  if (member.kind == IdlKind::octet && *rc::gen::arbitrary<bool>()) member.kind = IdlKind::uint8;
  if (field.type.is_array && member.collection == IdlCollection::array && *rc::gen::arbitrary<bool>())
    member.collection = IdlCollection::sequence;
  return member;
}

/// The same CDR in the other byte order, made by going over the members once more.
class Turner {
 public:
  explicit Turner(std::vector<std::byte> payload) : payload_(std::move(payload)) { payload_[1] = std::byte{0}; }
  void turn(const IdlMember& member) {
    std::size_t count = member.collection == IdlCollection::array ? member.length : 1;
    if (member.collection == IdlCollection::sequence) count = turn_number();
    for (std::size_t i = 0; i < count; ++i) turn_element(member.kind);
  }
  const std::vector<std::byte>& payload() const { return payload_; }

 private:
  void turn_element(IdlKind kind) {
    if (kind == IdlKind::string) {
      used_ += turn_number();
    } else if (kind == IdlKind::guid) {
      turn_octets(4);
      turn_octets(2);
      turn_octets(2);
      used_ += 8;
    } else {
      turn_octets(info(kind).octets);
    }
  }
  void turn_octets(std::size_t size) {
    used_ = (used_ + size - 1) / size * size;
    const auto begin = payload_.begin() + 4 + static_cast<std::ptrdiff_t>(used_);
    std::reverse(begin, begin + static_cast<std::ptrdiff_t>(size));
    used_ += size;
  }
  std::size_t turn_number() {
    const std::size_t at = (used_ + 3) / 4 * 4 + 4;
    const auto number = uadp::load_little_endian<std::uint32_t>(payload_.data() + at);
    turn_octets(4);
    return number;
  }
  std::vector<std::byte> payload_;
  std::size_t used_ = 0;
};

RC_GTEST_PROP(RoundTrip, FieldsToCdrAndBack, ()) {
  std::vector<DataSetField> fields;
  const std::size_t count = *rc::gen::inRange<std::size_t>(1, 9);
  for (std::size_t i = 0; i < count; ++i) fields.push_back(random_field(i));
  IdlStruct type{"Sample", {}};
  for (const DataSetField& field : fields) type.members.push_back(random_member(field));
  // The struct has an order of its own.
  const auto turns = *rc::gen::inRange<std::size_t>(0, count);
  std::rotate(type.members.begin(), type.members.begin() + static_cast<std::ptrdiff_t>(turns), type.members.end());

  std::vector<std::string> problems;
  auto there = TypeMapping::make(Direction::to_dds, fields, type, {}, problems);
  auto back = TypeMapping::make(Direction::to_opc_ua, fields, type, {}, problems);
  RC_ASSERT(problems.empty());

  std::vector<std::byte> values;
  for (const DataSetField& field : fields) {
    const auto member = std::find_if(type.members.begin(), type.members.end(),
                                     [&](const IdlMember& each) { return each.name == field.name; });
    append_value(values, field.type, member->collection == IdlCollection::array);
  }
  std::vector<std::byte> payload;
  RC_ASSERT(there->to_cdr(values, payload) == MappingError::none);
  RC_ASSERT(payload.size() % 4 == 0);
  std::vector<std::byte> returned;
  RC_ASSERT(back->to_fields(payload, returned) == MappingError::none);
  RC_ASSERT(returned == values);

  Turner turner(payload);
  for (const IdlMember& member : type.members) turner.turn(member);
  RC_ASSERT(back->to_fields(turner.payload(), returned) == MappingError::none);
  RC_ASSERT(returned == values);

  // Cut or changed anywhere, it is an error or other values, never harm (the sanitizers look).
  if (payload.size() > 4) {
    std::vector<std::byte> cut(
        payload.begin(),
        payload.begin() + static_cast<std::ptrdiff_t>(*rc::gen::inRange<std::size_t>(0, payload.size())));
    back->to_fields(cut, returned);
    payload[*rc::gen::inRange<std::size_t>(4, payload.size())] ^= std::byte{0x81};
    back->to_fields(payload, returned);
  }
  values[*rc::gen::inRange<std::size_t>(0, values.size())] ^= std::byte{0x81};
  there->to_cdr(values, payload);
}

}  // namespace
}  // namespace takt::gateway::round_trip_test
