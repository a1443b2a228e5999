// SPDX-License-Identifier: Apache-2.0
// A mapping of the gateway and a value for it: neither crash nor hang; what is mapped survives the way there and back;
// of its key the hash is found, and filters know what is a sample.
//
// The first octets describe the mapping: direction and number of fields, then five octets for each field; what is left
// is the value.
#include <vector>

#include "gateway/content_filter.hpp"
#include "gateway/field_values.hpp"
#include "gateway/key_layout.hpp"
#include "gateway/type_mapping.hpp"
#include "gateway/type_pairs.hpp"
#include "sim/check.hpp"

namespace {

using namespace takt;
using gateway::Direction;
using gateway::IdlCollection;
using gateway::MappingError;
using gateway::TypeMapping;

class Input {
 public:
  explicit Input(uadp::Octets octets) : octets_(octets) {}
  std::uint32_t next() {
    if (octets_.empty()) return 0;
    const auto value = std::to_integer<std::uint32_t>(octets_.front());
    octets_ = octets_.subspan(1);
    return value;
  }
  uadp::Octets rest() const { return octets_; }

 private:
  uadp::Octets octets_;
};

struct Agreement {
  Direction direction = Direction::to_dds;
  std::vector<gateway::DataSetField> fields;
  gateway::IdlStruct type{"Fuzz", {}};
  std::vector<gateway::Renamed> renamed;
};

enum Wish : std::uint32_t {
  is_array = 1,
  other_kind = 2,
  other_collection = 4,
  without_member = 8,
  without_field = 16,
  another_field = 32
};

/// Field and member as the standard pairs them, and changed as the flags wish: what does not fit, `make` has to refuse.
void add_pair(Input& input, Agreement& agreed) {
  const auto type = static_cast<uadp::BuiltInType>(1 + input.next() % 25);
  const std::uint32_t wishes = input.next();
  const std::uint32_t array_length = input.next() % 16;
  const std::uint32_t max_string_length = input.next() % 32;
  const std::uint32_t bound = input.next() % 64;
  const std::string name = "f" + std::to_string(agreed.fields.size() + agreed.type.members.size());
  const gateway::DataSetField field{name, {type, (wishes & is_array) != 0, array_length, max_string_length}};
  std::string problem;
  gateway::IdlMember member = gateway::idl_member_of(field, problem)
                                  .value_or(gateway::IdlMember{name, gateway::IdlKind::any, IdlCollection::none, 0, 0});
  if ((wishes & other_kind) != 0) {
    for (const gateway::TypePair& pair : gateway::type_pairs)
      if (pair.field == type) member.kind = pair.member;
    member.string_bound = bound;
  }
  if ((wishes & other_collection) != 0) {
    member.collection = member.collection == IdlCollection::array ? IdlCollection::sequence : IdlCollection::array;
    member.length = bound;
  }
  if ((wishes & without_field) == 0) agreed.fields.push_back(field);
  if ((wishes & without_member) == 0) {
    agreed.type.members.push_back(member);
    if ((wishes & another_field) != 0 && !agreed.fields.empty())
      agreed.renamed.push_back({agreed.fields[bound % agreed.fields.size()].name, name});
  }
}

Agreement agreement_of(Input& input) {
  Agreement agreed;
  const std::uint32_t head = input.next();
  agreed.direction = head % 2 == 0 ? Direction::to_dds : Direction::to_opc_ua;
  for (std::uint32_t left = 1 + head / 2 % 8; left > 0; --left) add_pair(input, agreed);
  return agreed;
}

std::optional<TypeMapping> mapping_of(const Agreement& agreed, Direction direction) {
  std::vector<std::string> problems;
  auto mapping = TypeMapping::make(direction, agreed.fields, agreed.type, agreed.renamed, problems);
  TAKT_CHECK(mapping.has_value() == problems.empty(), "what is refused is told, and nothing else");
  return mapping;
}

/// Every second member is the key, where members have places that do not change: the key of a sample, sent alone, has
/// the hash of the sample.
void check_key(const Agreement& agreed, const std::vector<std::byte>& payload) {
  std::vector<std::string> keys;
  for (std::size_t m = 0; m < agreed.type.members.size(); ++m) {
    const gateway::IdlMember& member = agreed.type.members[m];
    if (gateway::info(member.kind).octets == 0 || member.collection == IdlCollection::sequence) return;
    if (m % 2 == 0) keys.push_back(member.name);
  }
  const gateway::KeyLayout layout(agreed.type, keys);
  static_cast<void>(layout.of_key(payload));
  const std::vector<std::uint8_t> key = layout.key_in_data(payload);
  std::vector<std::byte> alone(4);  // big-endian CDR
  for (const std::uint8_t octet : key) alone.push_back(std::byte{octet});
  if (key.size() == layout.octets())
    TAKT_CHECK(layout.of_data(payload) == layout.of_key(alone), "a key alone is the same instance");
}

/// Of members that have places: a sample passes either a comparison or its opposite, and what is no sample neither. The
/// octets as an expression are refused or are one.
void check_filter(const Agreement& agreed, const std::vector<std::byte>& payload) {
  for (const gateway::IdlMember& member : agreed.type.members)
    if (gateway::info(member.kind).octets == 0 || member.collection == IdlCollection::sequence) return;
  gateway::FilterMistake mistake;
  const std::string text(reinterpret_cast<const char*>(payload.data()), payload.size());
  if (const auto any = gateway::ContentFilter::parse(text, agreed.type, mistake))
    static_cast<void>(any->passes(payload));
  for (const gateway::IdlMember& member : agreed.type.members) {
    if (member.collection == IdlCollection::array || gateway::info(member.kind).octets > 8) continue;
    const auto passes = [&](const std::string& expression) {
      const auto filter = gateway::ContentFilter::parse(expression, agreed.type, mistake);
      TAKT_CHECK(filter.has_value(), "a comparison of a number");
      return filter->passes(payload);
    };
    const bool is_one = passes(member.name + " = 1"), is_other = passes(member.name + " <> 1");
    TAKT_CHECK(!(is_one && is_other), "a number is 1 or it is not");
    TAKT_CHECK(passes("NOT " + member.name + " = 1 OR " + member.name + " = 1") == (is_one || is_other),
               "what passes neither is no sample");
  }
}

/// Of what was mapped: mapped back and again it is what it was.
void check_return(const Agreement& agreed, TypeMapping& there, const std::vector<std::byte>& mapped) {
  auto back = mapping_of(agreed, agreed.direction == Direction::to_dds ? Direction::to_opc_ua : Direction::to_dds);
  if (!back || !there.left_out().empty() || !back->left_out().empty() || !agreed.renamed.empty()) return;
  std::vector<std::byte> given;
  std::vector<std::byte> again;
  TAKT_CHECK(back->convert(mapped, given) == MappingError::none, "what was mapped can be mapped back");
  TAKT_CHECK(there.convert(given, again) == MappingError::none && again == mapped, "a value survives the way back");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Input input(std::as_bytes(std::span(data, size)));
  const Agreement agreed = agreement_of(input);
  auto mapping = mapping_of(agreed, agreed.direction);
  if (!mapping) return 0;
  const std::vector<std::byte> value(input.rest().begin(),
                                     input.rest().end());  // of its exact size, so that reads behind it are seen
  check_key(agreed, value);
  check_filter(agreed, value);
  std::vector<std::byte> mapped;
  if (mapping->convert(value, mapped) != MappingError::none) return 0;
  check_return(agreed, *mapping, mapped);
  if (agreed.direction == Direction::to_dds) return 0;
  gateway::FieldValues published(agreed.fields);
  if (published.assign(mapped))
    TAKT_CHECK(std::ranges::equal(published.octets(), mapped), "what is published is what was mapped");
  return 0;
}
