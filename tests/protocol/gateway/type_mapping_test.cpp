// SPDX-License-Identifier: Apache-2.0
// A mapping is checked when it is made; octets by hand; octets that are not what was agreed.
#include "gateway/type_mapping.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>

#include "uadp/variant.hpp"

namespace takt::gateway::type_mapping_test {
namespace {

using uadp::BuiltInType;

DataSetField field(const std::string& name, BuiltInType type, bool is_array = false, std::uint32_t length = 0,
                   std::uint32_t most = 0) {
  return {name, {type, is_array, length, most}};
}
IdlMember member(const std::string& name, IdlKind kind, IdlCollection collection = IdlCollection::none,
                 std::uint32_t length = 0) {
  return {name, kind, collection, length, 0};
}

/// Hex digits, spaces between them as one likes.
std::vector<std::byte> octets(const std::string& hex) {
  std::string digits;
  std::copy_if(hex.begin(), hex.end(), std::back_inserter(digits),
               [](unsigned char c) { return std::isxdigit(c) != 0; });
  std::vector<std::byte> result;
  for (std::size_t i = 0; i + 1 < digits.size(); i += 2)
    result.push_back(static_cast<std::byte>(std::stoi(digits.substr(i, 2), nullptr, 16)));
  return result;
}

TypeMapping made(Direction direction, std::vector<DataSetField> fields, std::vector<IdlMember> members,
                 const std::vector<Renamed>& renamed = {}) {
  std::vector<std::string> problems;
  auto mapping = TypeMapping::make(direction, std::move(fields), {"Sample", std::move(members)}, renamed, problems);
  for (const std::string& each : problems) ADD_FAILURE() << each;
  if (!mapping) throw std::runtime_error("no mapping");
  return *mapping;
}

std::vector<std::string> problems_of(Direction direction, std::vector<DataSetField> fields,
                                     std::vector<IdlMember> members, const std::vector<Renamed>& renamed = {}) {
  std::vector<std::string> problems;
  const bool is_made =
      TypeMapping::make(direction, std::move(fields), {"Sample", std::move(members)}, renamed, problems).has_value();
  EXPECT_EQ(is_made, problems.empty());
  return problems;
}

using Problems = std::vector<std::string>;

TEST(TypeMapping, AllProblemsAreNamedAtOnce) {
  EXPECT_EQ(problems_of(Direction::to_dds, {field("a", BuiltInType::Double), field("b", BuiltInType::NodeId)},
                        {member("a", IdlKind::int32), member("b", IdlKind::int32), member("c", IdlKind::int32)},
                        {{"x", "a"}, {"a", "y"}}),
            (Problems{"a name for the field \"x\", which there is not",
                      "a field for the member \"y\", which there is not", "no field for the member \"a\" of Sample",
                      "field \"b\" and member \"b\": NodeId is not mapped: it has no counterpart among the types of "
                      "IDL that is one value",
                      "no field for the member \"c\" of Sample"}));
  EXPECT_EQ(
      problems_of(Direction::to_opc_ua,
                  {field("a", BuiltInType::Int32), field("a", BuiltInType::Int32), field("b", BuiltInType::Int32)},
                  {member("a", IdlKind::int32)}),
      (Problems{"two fields \"a\"", "no member of Sample for the field \"b\""}));
  EXPECT_EQ(problems_of(Direction::to_dds, {}, {}), (Problems{"there is no field", "there is no member"}));
}

TEST(TypeMapping, WhatTheOtherSideDoesNotTakeIsLeftOut) {
  EXPECT_EQ(made(Direction::to_dds, {field("a", BuiltInType::Int32), field("b", BuiltInType::Int32)},
                 {member("a", IdlKind::int32)})
                .left_out(),
            Problems{"b"});
  EXPECT_EQ(made(Direction::to_opc_ua, {field("a", BuiltInType::Int32)},
                 {member("z", IdlKind::int32), member("a", IdlKind::int32)})
                .left_out(),
            Problems{"z"});
}

// By hand. Fields: Boolean true (an octet other than 1), Double 1.0, String "ab", Int16[2] {1, -2}.
const char* const fields_hex = "01 05  0b 000000000000f03f  0c 02000000 6162  84 02000000 0100 feff";
// CDR_LE: boolean 1, 7 octets to the multiple of 8, the double, length 3 with the NUL, "ab\0", one octet to the
// multiple of 2 (offset 24 of the CDR is one already: 8 + 8 + 4 + 3 = 23), two shorts: 28 octets, a multiple of 4.
const char* const cdr_hex = "0001 0000  01 00000000000000 000000000000f03f 03000000 616200 00 0100 feff";
const std::vector<DataSetField> sample_fields = {field("on", BuiltInType::Boolean), field("speed", BuiltInType::Double),
                                                 field("name", BuiltInType::String),
                                                 field("pair", BuiltInType::Int16, true, 2)};
const std::vector<IdlMember> sample_members = {member("on", IdlKind::boolean), member("speed", IdlKind::float64),
                                               member("name", IdlKind::string),
                                               member("pair", IdlKind::int16, IdlCollection::array, 2)};

TEST(TypeMapping, ToCdrByHand) {
  TypeMapping mapping = made(Direction::to_dds, sample_fields, sample_members);
  std::vector<std::byte> payload;
  ASSERT_EQ(mapping.to_cdr(octets(fields_hex), payload), MappingError::none);
  EXPECT_EQ(payload, octets(cdr_hex));
}

TEST(TypeMapping, ToFieldsByHandInBothByteOrders) {
  TypeMapping mapping = made(Direction::to_opc_ua, sample_fields, sample_members);
  const auto expected = octets("01 01  0b 000000000000f03f  0c 02000000 6162  84 02000000 0100 feff");
  std::vector<std::byte> fields;
  ASSERT_EQ(mapping.to_fields(octets(cdr_hex), fields), MappingError::none);
  EXPECT_EQ(fields, expected);
  ASSERT_EQ(
      mapping.to_fields(octets("0000 0000  01 00000000000000 3ff0000000000000 00000003 616200 00 0001 fffe"), fields),
      MappingError::none);
  EXPECT_EQ(fields, expected);
}

// The order of the struct is that of its members; fields follow by name, here crossed and one renamed.
TEST(TypeMapping, NamesDecideNotTheOrder) {
  TypeMapping mapping = made(Direction::to_dds, {field("b", BuiltInType::Byte), field("Speed", BuiltInType::UInt16)},
                             {member("speed", IdlKind::uint16), member("b", IdlKind::octet)}, {{"Speed", "speed"}});
  std::vector<std::byte> payload;
  ASSERT_EQ(mapping.to_cdr(octets("03 07  05 3412"), payload), MappingError::none);
  EXPECT_EQ(payload, octets("0001 0001 3412 07 00")) << "one octet of padding, said in the options";
}

// Data1 to Data3 are numbers, so they turn with the byte order; Data4 is octets.
TEST(TypeMapping, AGuidTurnsWithTheByteOrder) {
  TypeMapping mapping = made(Direction::to_opc_ua, {field("g", BuiltInType::Guid)}, {member("g", IdlKind::guid)});
  std::vector<std::byte> fields;
  ASSERT_EQ(mapping.to_fields(octets("0000 0000 00112233 4455 6677 8899aabbccddeeff"), fields), MappingError::none);
  EXPECT_EQ(fields, octets("0e 33221100 5544 7766 8899aabbccddeeff"));
}

TEST(TypeMapping, AnEmptySequenceHasNoAlignmentOfItsElements) {
  TypeMapping mapping = made(Direction::to_dds, {field("q", BuiltInType::Double, true), field("n", BuiltInType::Byte)},
                             {member("q", IdlKind::float64, IdlCollection::sequence), member("n", IdlKind::octet)});
  std::vector<std::byte> payload;
  ASSERT_EQ(mapping.to_cdr(octets("8b ffffffff 03 09"), payload), MappingError::none);
  EXPECT_EQ(payload, octets("0001 0003 00000000 09 000000"));
}

// The room for a payload was reckoned from the octets of all fields, each once.
TEST(TypeMapping, AFieldMayBeTheSourceOfSeveralMembers) {
  const std::vector<IdlMember> members = {member("a", IdlKind::string), member("b", IdlKind::string),
                                          member("c", IdlKind::string), member("d", IdlKind::string)};
  TypeMapping mapping = made(Direction::to_dds, {field("s", BuiltInType::String)}, members,
                             {{"s", "a"}, {"s", "b"}, {"s", "c"}, {"s", "d"}});
  std::vector<std::byte> given = octets("0c c8000000");
  given.insert(given.end(), 200, std::byte{'x'});
  std::vector<std::byte> payload;
  ASSERT_EQ(mapping.to_cdr(given, payload), MappingError::none);
  EXPECT_EQ(payload.size(),
            4u + 4 * (4 + 204));  // 200 octets, the octet 0 and three to the next length; padded the last time
}

struct Wrong {
  const char* hex;
  MappingError error;
};

TEST(TypeMapping, FieldsThatAreNotTheAgreedOnes) {
  TypeMapping mapping =
      made(Direction::to_dds, {field("name", BuiltInType::String, false, 0, 3), field("q", BuiltInType::Int16, true)},
           {member("name", IdlKind::string), member("q", IdlKind::int16, IdlCollection::array, 2)});
  const Wrong cases[] = {
      {"0c 02000000 6162  84 02000000 0100 0200", MappingError::none},
      {"0c 02000000 6162  84 03000000 0100 0200 0300", MappingError::wrong_length},
      {"0c 04000000 61626364  84 02000000 0100 0200", MappingError::wrong_length},
      {"0c 02000000 6100  84 02000000 0100 0200", MappingError::text},
      {"0c 02000000 6162  85 02000000 0100 0200", MappingError::malformed},
      {"0c 02000000 6162  04 0100", MappingError::malformed},
      {"0c 02000000 6162", MappingError::malformed},
      {"0c 02000000 6162  84 02000000 0100 0200 00", MappingError::malformed},
      {"", MappingError::malformed},
  };
  std::vector<std::byte> payload;
  for (const Wrong& each : cases) EXPECT_EQ(mapping.to_cdr(octets(each.hex), payload), each.error) << each.hex;
}

TEST(TypeMapping, PayloadsThatAreNotTheAgreedOnes) {
  TypeMapping mapping = made(Direction::to_opc_ua,
                             {field("on", BuiltInType::Boolean), field("name", BuiltInType::String, false, 0, 3),
                              field("q", BuiltInType::Byte, true, 2)},
                             {member("on", IdlKind::boolean), member("name", IdlKind::string),
                              member("q", IdlKind::octet, IdlCollection::sequence)});
  const Wrong cases[] = {
      {"00010000 01 000000 03000000 616200 00 01000000 07", MappingError::none},
      {"00010000 01 000000 03000000 616200 00 01000000 07 000000", MappingError::none},
      {"00010000 01 000000 03000000 616200 00 01000000 07 00000000", MappingError::malformed},
      {"00010000 02 000000 03000000 616200 00 01000000 07", MappingError::boolean},
      {"00010000 01 000000 03000000 616263 00 01000000 07", MappingError::malformed},
      {"00010000 01 000000 03000000 610000 00 01000000 07", MappingError::malformed},
      {"00010000 01 000000 00000000 01000000 07", MappingError::none},
      {"00010000 01 000000 05000000 6162636400 000000 01000000 07", MappingError::wrong_length},
      {"00010000 01 000000 03000000 616200 00 03000000 070707", MappingError::wrong_length},
      {"00010000 01 000000 03000000 616200 00 ffffffff 07", MappingError::malformed},
      {"00010000 01 000000 ff000000 6162", MappingError::malformed},
      {"00030000 01 000000 03000000 616200 00 01000000 07", MappingError::encapsulation},
      {"00070000 01 000000 03000000 616200 00 01000000 07", MappingError::none},
      {"00090000 01 000000 03000000 616200 00 01000000 07", MappingError::encapsulation},
      {"0001", MappingError::encapsulation},
  };
  std::vector<std::byte> fields;
  for (const Wrong& each : cases) EXPECT_EQ(mapping.to_fields(octets(each.hex), fields), each.error) << each.hex;
}

}  // namespace
}  // namespace takt::gateway::type_mapping_test
