// SPDX-License-Identifier: Apache-2.0
#include "gateway/type_pairs.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace takt::gateway::type_pairs_test {
namespace {

using uadp::BuiltInType;

IdlMember member(IdlKind kind, IdlCollection collection = IdlCollection::none, std::uint32_t length = 0,
                 std::uint32_t bound = 0) {
  return {"m", kind, collection, length, bound};
}
uadp::RawField scalar(BuiltInType type, std::uint32_t max_string_length = 0) {
  return {type, false, 0, max_string_length};
}
uadp::RawField array(BuiltInType type, std::uint32_t length = 0) { return {type, true, length, 0}; }

TEST(TypePairs, EveryBuiltInTypeIsMappedOrRefusedByName) {
  const std::vector<BuiltInType> refused = {
      BuiltInType::Null,          BuiltInType::NodeId,        BuiltInType::ExpandedNodeId,
      BuiltInType::QualifiedName, BuiltInType::LocalizedText, BuiltInType::ExtensionObject,
      BuiltInType::DataValue,     BuiltInType::Variant,       BuiltInType::DiagnosticInfo};
  for (const uadp::BuiltInInfo& info : uadp::built_in_types) {
    std::string problem;
    const auto found = idl_member_of({"f", scalar(info.type)}, problem);
    const bool is_refused = std::find(refused.begin(), refused.end(), info.type) != refused.end();
    EXPECT_EQ(found.has_value(), !is_refused) << info.name;
    if (is_refused) {
      EXPECT_NE(problem.find(info.name), std::string::npos) << problem;
    } else {
      EXPECT_EQ(mismatch_of(scalar(info.type), *found, Direction::to_dds), "");
      EXPECT_EQ(mismatch_of(scalar(info.type), *found, Direction::to_opc_ua), "");
    }
  }
}

TEST(TypePairs, EveryKindOfIdlIsMappedOrRefusedByName) {
  for (const IdlKindInfo& each : idl_kinds) {
    std::vector<std::string> refusals;
    bool is_mapped = false;
    for (const uadp::BuiltInInfo& built_in : uadp::built_in_types) {
      const std::string mismatch = mismatch_of(scalar(built_in.type), member(each.kind), Direction::to_dds);
      if (mismatch.empty()) is_mapped = true;
      if (mismatch.find("is not mapped: OPC UA") != std::string::npos) refusals.push_back(mismatch);
    }
    EXPECT_EQ(is_mapped, each.alignment != 0) << each.name;
    if (!is_mapped) {
      ASSERT_FALSE(refusals.empty()) << each.name;
      EXPECT_NE(refusals.front().find(each.name), std::string::npos);
    }
  }
}

struct Case {
  uadp::RawField field;
  IdlMember member;
  Direction direction;
  const char* mismatch;
};

TEST(TypePairs, WhatDoesNotFitIsNamed) {
  const Case cases[] = {
      {scalar(BuiltInType::Double), member(IdlKind::float32), Direction::to_dds,
       "Double and float are not the same type"},
      {scalar(BuiltInType::Byte), member(IdlKind::int8), Direction::to_dds, "Byte and int8 are not the same type"},
      {scalar(BuiltInType::Byte), member(IdlKind::uint8), Direction::to_dds, ""},
      {scalar(BuiltInType::DateTime), member(IdlKind::int64), Direction::to_opc_ua, ""},
      {scalar(BuiltInType::StatusCode), member(IdlKind::uint32), Direction::to_opc_ua, ""},
      {array(BuiltInType::Int32, 3), member(IdlKind::int32), Direction::to_dds,
       "Int32[3] and long: only one of them is an array"},
      {array(BuiltInType::Int32, 3), member(IdlKind::int32, IdlCollection::array, 4), Direction::to_dds,
       "Int32[3] and long[4] have different lengths"},
      {array(BuiltInType::Int32), member(IdlKind::int32, IdlCollection::array, 4), Direction::to_dds, ""},
      {array(BuiltInType::Int32, 5), member(IdlKind::int32, IdlCollection::sequence, 4), Direction::to_dds,
       "Int32[5] and sequence<long, 4>: there may come more elements than there is room for"},
      {array(BuiltInType::Int32, 5), member(IdlKind::int32, IdlCollection::sequence, 4), Direction::to_opc_ua, ""},
      {array(BuiltInType::Int32, 5), member(IdlKind::int32, IdlCollection::sequence, 6), Direction::to_opc_ua,
       "Int32[5] and sequence<long, 6>: there may come more elements than there is room for"},
      {scalar(BuiltInType::String, 20), member(IdlKind::string, IdlCollection::none, 0, 16), Direction::to_dds,
       "String(20) and string<16>: there may come longer strings than there is room for"},
      {scalar(BuiltInType::String, 20), member(IdlKind::string, IdlCollection::none, 0, 16), Direction::to_opc_ua, ""},
      {scalar(BuiltInType::ByteString), member(IdlKind::string), Direction::to_dds,
       "ByteString and string are not the same type: ByteString is sequence<octet>"},
      {scalar(BuiltInType::ByteString, 9), member(IdlKind::octet, IdlCollection::sequence, 8), Direction::to_dds,
       "ByteString(9) and sequence<octet, 8>: there may come more octets than there is room for"},
      {array(BuiltInType::ByteString), member(IdlKind::octet, IdlCollection::sequence), Direction::to_dds,
       "ByteString[] is not mapped: it would be a sequence of sequences"},
      {scalar(BuiltInType::Int32), member(IdlKind::enumeration), Direction::to_opc_ua,
       "enum is not mapped: OPC UA has no built-in type for enum"},
      {scalar(BuiltInType::Double), member(IdlKind::float128), Direction::to_opc_ua,
       "long double is not mapped: OPC UA has no built-in type for long double"},
      {array(BuiltInType::Int32), member(IdlKind::int32, IdlCollection::array, 0), Direction::to_dds,
       "an array of no elements is not IDL"},
  };
  for (const Case& each : cases) EXPECT_EQ(mismatch_of(each.field, each.member, each.direction), each.mismatch);
}

}  // namespace
}  // namespace takt::gateway::type_pairs_test
