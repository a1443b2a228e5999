// SPDX-License-Identifier: Apache-2.0
#include "gateway/type_mapping.hpp"

#include <algorithm>
#include <set>

#include "dds/message/cdr_writer.hpp"
#include "gateway/type_pairs.hpp"
#include "sim/check.hpp"
#include "uadp/value.hpp"

namespace takt::gateway {
namespace {

using uadp::BuiltInType;

bool has_room(std::uint32_t room, std::size_t count) { return room == 0 || count <= room; }

/// A sequence, an array or a field with so many elements is what both sides agreed on.
bool is_length_agreed(const uadp::RawField& field, const IdlMember& member, std::size_t count) {
  if (!has_room(field.array_length, count)) return false;
  return member.collection == IdlCollection::array ? count == member.length : has_room(member.length, count);
}

MappingError put_text(const uadp::RawField& field, const IdlMember& member, Octets text, dds::CdrWriter& writer) {
  if (!has_room(member.string_bound, text.size()) || !has_room(field.max_string_length, text.size()))
    return MappingError::wrong_length;
  if (std::find(text.begin(), text.end(), std::byte{0}) != text.end()) return MappingError::text;
  writer.put(std::string_view(reinterpret_cast<const char*>(text.data()), text.size()));
  return MappingError::none;
}

/// Numbers of OPC UA Binary, which stand packed.
template <class T>
void put_numbers(Octets packed, dds::CdrWriter& writer) {
  for (std::size_t at = 0; at < packed.size(); at += sizeof(T))
    writer.put(uadp::load_little_endian<T>(packed.data() + at));
}

void put_guids(Octets packed, dds::CdrWriter& writer) {
  constexpr std::size_t guid_octets = 16;
  for (; !packed.empty(); packed = packed.subspan(guid_octets)) {
    put_numbers<std::uint32_t>(packed.first(4), writer);
    put_numbers<std::uint16_t>(packed.subspan(4, 4), writer);
    put_numbers<std::uint8_t>(packed.subspan(8, 8), writer);
  }
}

void put_fixed(IdlKind kind, Octets packed, dds::CdrWriter& writer) {
  if (kind == IdlKind::guid) return put_guids(packed, writer);
  if (kind == IdlKind::boolean) {  // OPC UA has many octets that are true, CDR one
    for (const std::byte each : packed) writer.put(each != std::byte{0});
    return;
  }
  switch (info(kind).octets) {
    case 1:
      return put_numbers<std::uint8_t>(packed, writer);
    case 2:
      return put_numbers<std::uint16_t>(packed, writer);
    case 4:
      return put_numbers<std::uint32_t>(packed, writer);
    default:
      return put_numbers<std::uint64_t>(packed, writer);
  }
}

MappingError put_elements(const uadp::RawField& field, const IdlMember& member, const uadp::Variant& value,
                          dds::CdrWriter& writer) {
  if (!is_text(field.type)) return put_fixed(member.kind, value.octets, writer), MappingError::none;
  uadp::Reader reader(value.octets);
  for (std::size_t i = 0; i < value.size(); ++i)
    if (const MappingError error = put_text(field, member, uadp::get_length_and_octets(reader), writer);
        error != MappingError::none)
      return error;
  return reader.failed() ? MappingError::malformed : MappingError::none;
}

MappingError put_member(const uadp::RawField& field, const IdlMember& member, const uadp::Variant& value,
                        dds::CdrWriter& writer) {
  if (value.type == BuiltInType::StatusCode && !value.is_array && field.type != BuiltInType::StatusCode)
    return MappingError::bad_status;
  if (value.type != field.type || value.is_array != field.is_array || !value.dimensions.empty())
    return MappingError::malformed;
  if (field.type == BuiltInType::ByteString) {
    const auto octets = value.get<uadp::ByteStringView>();
    if (!octets) return MappingError::malformed;
    if (!has_room(member.length, octets->octets.size()) || !has_room(field.max_string_length, octets->octets.size()))
      return MappingError::wrong_length;
    writer.begin_sequence(octets->octets.size());
    put_numbers<std::uint8_t>(octets->octets, writer);
    return MappingError::none;
  }
  if (field.is_array && !is_length_agreed(field, member, value.size())) return MappingError::wrong_length;
  if (member.collection == IdlCollection::sequence) writer.begin_sequence(value.size());
  return put_elements(field, member, value, writer);
}

/// Appends what OPC UA Binary makes of values.
class FieldWriter {
 public:
  explicit FieldWriter(std::vector<std::byte>& target) : target_(target) { target_.clear(); }
  template <class T>
  void put(T number) {
    target_.resize(target_.size() + sizeof(T));
    uadp::store_little_endian(target_.data() + target_.size() - sizeof(T), number);
  }
  void put_text(std::string_view text) {
    put(static_cast<std::int32_t>(text.size()));
    const Octets octets = std::as_bytes(std::span(text));
    target_.insert(target_.end(), octets.begin(), octets.end());
  }

 private:
  std::vector<std::byte>& target_;
};

/// How many elements a member has that is read next.
std::size_t count_of(const IdlMember& member, dds::CdrReader& reader) {
  constexpr std::size_t length_of_string = 4;
  switch (member.collection) {
    case IdlCollection::none:
      return 1;
    case IdlCollection::array:
      return member.length;
    case IdlCollection::sequence:
      break;
  }
  return reader.begin_sequence(
      std::max<std::size_t>(info(member.kind).octets, member.kind == IdlKind::string ? length_of_string : 1));
}

/// Reads an element and gives it to whoever wants it as OPC UA Binary has it.
template <class Take>
MappingError get_element(const IdlMember& member, dds::CdrReader& reader, Take&& take) {
  if (member.kind == IdlKind::boolean) {
    const bool is_there = reader.left() > 0;
    take(static_cast<std::uint8_t>(reader.get_bool() ? 1 : 0));
    return is_there && reader.failed() ? MappingError::boolean : MappingError::none;
  }
  if (member.kind == IdlKind::guid) {
    take(reader.get<std::uint32_t>());
    for (int i = 0; i < 2; ++i) take(reader.get<std::uint16_t>());
    for (int i = 0; i < 8; ++i) take(reader.get<std::uint8_t>());
    return MappingError::none;
  }
  switch (info(member.kind).octets) {
    case 1:
      take(reader.get<std::uint8_t>());
      break;
    case 2:
      take(reader.get<std::uint16_t>());
      break;
    case 4:
      take(reader.get<std::uint32_t>());
      break;
    default:
      take(reader.get<std::uint64_t>());
  }
  return MappingError::none;
}

/// Steps over a member and checks what does not depend on its field.
MappingError skip_member(const IdlMember& member, dds::CdrReader& reader) {
  const std::size_t count = count_of(member, reader);
  if (!reader.failed() && member.collection == IdlCollection::sequence && !has_room(member.length, count))
    return MappingError::wrong_length;
  for (std::size_t i = 0; i < count && !reader.failed(); ++i) {
    if (member.kind == IdlKind::string) {
      if (!has_room(member.string_bound, reader.get_string().size())) return MappingError::wrong_length;
    } else if (const MappingError error = get_element(member, reader, [](auto) {}); error != MappingError::none) {
      return error;
    }
  }
  return reader.failed() ? MappingError::malformed : MappingError::none;
}

/// The member has been stepped over once, so it is sound.
MappingError get_field(const uadp::RawField& field, const IdlMember& member, dds::CdrReader reader,
                       FieldWriter& writer) {
  const std::size_t count = count_of(member, reader);
  const bool is_octets = field.type == BuiltInType::ByteString;
  if (is_octets ? !has_room(field.max_string_length, count) : field.is_array && !is_length_agreed(field, member, count))
    return MappingError::wrong_length;
  writer.put(static_cast<std::uint8_t>(uadp::index_of(field.type) | (field.is_array ? uadp::detail::array_flag : 0U)));
  if (field.is_array || is_octets) writer.put(static_cast<std::int32_t>(count));
  for (std::size_t i = 0; i < count; ++i) {
    if (member.kind != IdlKind::string) {
      get_element(member, reader, [&writer](auto number) { writer.put(number); });
      continue;
    }
    const std::string_view text = reader.get_string();
    if (!has_room(field.max_string_length, text.size())) return MappingError::wrong_length;
    writer.put_text(text);
  }
  return MappingError::none;
}

/// Octets that a member has at most: its alignment and length, and of strings the octet 0 and its alignment.
std::size_t most_octets(const uadp::Variant& value) { return 16 + 2 * value.octets.size(); }

template <class Named>
std::optional<std::size_t> find(const std::vector<Named>& all, const std::string& name) {
  const auto found = std::find_if(all.begin(), all.end(), [&](const Named& each) { return each.name == name; });
  return found == all.end() ? std::nullopt : std::optional<std::size_t>(static_cast<std::size_t>(found - all.begin()));
}

template <class Named>
void check_names(const std::vector<Named>& all, const char* what, std::vector<std::string>& problems) {
  std::set<std::string> seen;
  for (const Named& each : all)
    if (!seen.insert(each.name).second) problems.push_back(std::string("two ") + what + "s \"" + each.name + "\"");
  if (all.empty()) problems.push_back(std::string("there is no ") + what);
}

}  // namespace

std::optional<TypeMapping> TypeMapping::make(Direction direction, std::vector<DataSetField> fields, IdlStruct type,
                                             const std::vector<Renamed>& renamed, std::vector<std::string>& problems) {
  const std::size_t problems_before = problems.size();
  check_names(fields, "field", problems);
  check_names(type.members, "member", problems);
  for (const Renamed& each : renamed) {
    if (!find(fields, each.field))
      problems.push_back("a name for the field \"" + each.field + "\", which there is not");
    if (!find(type.members, each.member))
      problems.push_back("a field for the member \"" + each.member + "\", which there is not");
  }
  const bool to_dds = direction == Direction::to_dds;
  TypeMapping mapping;
  std::vector<bool> is_taken(to_dds ? fields.size() : type.members.size());
  const auto pair_up = [&](std::size_t field, std::size_t member) {
    const std::string mismatch = mismatch_of(fields[field].type, type.members[member], direction);
    if (!mismatch.empty())
      problems.push_back("field \"" + fields[field].name + "\" and member \"" + type.members[member].name +
                         "\": " + mismatch);
    mapping.sources_.push_back(to_dds ? field : member);
    is_taken[mapping.sources_.back()] = true;
  };
  const auto field_for = [&](const std::string& member) {
    const auto found =
        std::find_if(renamed.begin(), renamed.end(), [&](const Renamed& each) { return each.member == member; });
    return find(fields, found == renamed.end() ? member : found->field);
  };
  const auto member_for = [&](const std::string& field) {
    const auto found =
        std::find_if(renamed.begin(), renamed.end(), [&](const Renamed& each) { return each.field == field; });
    return find(type.members, found == renamed.end() ? field : found->member);
  };
  for (std::size_t i = 0; i < (to_dds ? type.members.size() : fields.size()); ++i) {
    const std::string& name = to_dds ? type.members[i].name : fields[i].name;
    const auto source = to_dds ? field_for(name) : member_for(name);
    if (!source)
      problems.push_back(to_dds ? "no field for the member \"" + name + "\" of " + type.name
                                : "no member of " + type.name + " for the field \"" + name + "\"");
    else
      to_dds ? pair_up(*source, i) : pair_up(i, *source);
  }
  if (problems.size() != problems_before) return std::nullopt;
  for (std::size_t i = 0; i < is_taken.size(); ++i)
    if (!is_taken[i]) mapping.left_out_.push_back(to_dds ? fields[i].name : type.members[i].name);
  mapping.direction_ = direction;
  mapping.fields_ = std::move(fields);
  mapping.type_ = std::move(type);
  return mapping;
}

MappingError TypeMapping::to_cdr(Octets fields, std::vector<std::byte>& payload) {
  uadp::Reader reader(fields);
  given_.clear();
  for (std::size_t i = 0; i < fields_.size(); ++i) given_.push_back(uadp::get_variant(reader));
  if (reader.failed() || reader.left() != 0) return MappingError::malformed;
  std::size_t most = dds::encapsulation_size;
  for (const std::size_t source : sources_)
    most += most_octets(given_[source]);  // a field may be the source of several members
  payload.resize(most);
  dds::CdrWriter writer(payload);
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    const MappingError error = put_member(fields_[sources_[i]].type, type_.members[i], given_[sources_[i]], writer);
    if (error != MappingError::none) return error;
  }
  const std::size_t size = writer.finish().size();
  TAKT_CHECK(size != 0, "a payload has room for its fields");
  payload.resize(size);
  return MappingError::none;
}

MappingError TypeMapping::to_fields(Octets payload, std::vector<std::byte>& fields) {
  dds::CdrReader reader(payload);
  if (reader.failed()) return MappingError::encapsulation;
  members_.clear();
  for (const IdlMember& member : type_.members) {
    members_.push_back(reader);
    if (const MappingError error = skip_member(member, reader); error != MappingError::none) return error;
  }
  if (reader.left() > 3) return MappingError::malformed;  // up to three octets pad the payload
  FieldWriter writer(fields);
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    const MappingError error = get_field(fields_[i].type, type_.members[sources_[i]], members_[sources_[i]], writer);
    if (error != MappingError::none) return error;
  }
  return MappingError::none;
}

}  // namespace takt::gateway
