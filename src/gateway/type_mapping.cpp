#include "gateway/type_mapping.hpp"

#include <algorithm>
#include <set>

#include "gateway/cdr.hpp"
#include "gateway/type_pairs.hpp"
#include "uadp/value.hpp"

namespace takt::gateway {
namespace {

using uadp::BuiltInType;

bool is_text(BuiltInType type) { return type == BuiltInType::String || type == BuiltInType::XmlElement; }
bool has_room(std::uint32_t room, std::size_t count) { return room == 0 || count <= room; }

/// A sequence, an array or a field with so many elements is what both sides agreed on.
bool is_length_agreed(const uadp::RawField& field, const IdlMember& member, std::size_t count) {
  if (!has_room(field.array_length, count)) return false;
  return member.collection == IdlCollection::array ? count == member.length : has_room(member.length, count);
}

MappingError put_text(const uadp::RawField& field, const IdlMember& member, Octets text, CdrWriter& writer) {
  if (!has_room(member.string_bound, text.size()) || !has_room(field.max_string_length, text.size())) return MappingError::wrong_length;
  if (std::find(text.begin(), text.end(), std::byte{0}) != text.end()) return MappingError::text;
  writer.put(static_cast<std::uint32_t>(text.size() + 1));
  writer.put_octets(text);
  writer.put(std::uint8_t{0});
  return MappingError::none;
}

MappingError put_elements(const uadp::RawField& field, const IdlMember& member, const uadp::Variant& value, CdrWriter& writer) {
  if (is_text(field.type)) {
    uadp::Reader reader(value.octets);
    for (std::size_t i = 0; i < value.size(); ++i)
      if (const MappingError error = put_text(field, member, uadp::get_length_and_octets(reader), writer); error != MappingError::none) return error;
    return reader.failed() ? MappingError::malformed : MappingError::none;
  }
  if (value.size() == 0) return MappingError::none;
  writer.align(info(member.kind).alignment);
  // Both encodings are little-endian and pack equal numbers. OPC UA has many octets that are true, CDR one.
  if (field.type != BuiltInType::Boolean) return writer.put_octets(value.octets), MappingError::none;
  for (const std::byte each : value.octets) writer.put(static_cast<std::uint8_t>(each != std::byte{0} ? 1 : 0));
  return MappingError::none;
}

MappingError put_member(const uadp::RawField& field, const IdlMember& member, const uadp::Variant& value, CdrWriter& writer) {
  if (value.type != field.type || value.is_array != field.is_array || !value.dimensions.empty()) return MappingError::malformed;
  if (field.type == BuiltInType::ByteString) {
    const auto octets = value.get<uadp::ByteStringView>();
    if (!octets) return MappingError::malformed;
    if (!has_room(member.length, octets->octets.size()) || !has_room(field.max_string_length, octets->octets.size())) return MappingError::wrong_length;
    writer.put(static_cast<std::uint32_t>(octets->octets.size()));
    writer.put_octets(octets->octets);
    return MappingError::none;
  }
  if (field.is_array && !is_length_agreed(field, member, value.size())) return MappingError::wrong_length;
  if (member.collection == IdlCollection::sequence) writer.put(static_cast<std::uint32_t>(value.size()));
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
  void put_octets(Octets octets) { target_.insert(target_.end(), octets.begin(), octets.end()); }

 private:
  std::vector<std::byte>& target_;
};

/// The text of a CDR string without the NUL at its end.
MappingError get_text(CdrReader& reader, Octets& text) {
  const auto octets = reader.get<std::uint32_t>();
  if (octets == 0) return reader.failed() ? MappingError::malformed : MappingError::text;
  const Octets all = reader.take(octets);
  if (reader.failed()) return MappingError::malformed;
  text = all.first(all.size() - 1);
  const bool ends_once = all.back() == std::byte{0} && std::find(text.begin(), text.end(), std::byte{0}) == text.end();
  return ends_once ? MappingError::none : MappingError::text;
}

/// How many elements a member has that is read next.
std::size_t count_of(const IdlMember& member, CdrReader& reader) {
  switch (member.collection) {
    case IdlCollection::none: return 1;
    case IdlCollection::array: return member.length;
    case IdlCollection::sequence: break;
  }
  const auto count = reader.get<std::uint32_t>();
  if (count > reader.left()) reader.fail();  // an element is at least an octet
  return reader.failed() ? 0 : count;
}

/// Steps over a member and checks what does not depend on its field.
MappingError skip_member(const IdlMember& member, CdrReader& reader) {
  const std::size_t count = count_of(member, reader);
  if (reader.failed()) return MappingError::malformed;
  if (member.collection == IdlCollection::sequence && !has_room(member.length, count)) return MappingError::wrong_length;
  if (member.kind == IdlKind::string) {
    for (std::size_t i = 0; i < count; ++i) {
      Octets text;
      if (const MappingError error = get_text(reader, text); error != MappingError::none) return error;
      if (!has_room(member.string_bound, text.size())) return MappingError::wrong_length;
    }
    return MappingError::none;
  }
  if (count > 0) reader.align(info(member.kind).alignment);
  const Octets octets = reader.take(count * info(member.kind).octets);
  if (reader.failed()) return MappingError::malformed;
  if (member.kind != IdlKind::boolean) return MappingError::none;
  return std::any_of(octets.begin(), octets.end(), [](std::byte each) { return each > std::byte{1}; }) ? MappingError::boolean : MappingError::none;
}

void get_element(IdlKind kind, CdrReader& reader, FieldWriter& writer) {
  if (kind == IdlKind::guid) {
    writer.put(reader.get<std::uint32_t>());
    writer.put(reader.get<std::uint16_t>());
    writer.put(reader.get<std::uint16_t>());
    writer.put_octets(reader.take(8));
    return;
  }
  switch (info(kind).octets) {
    case 1: return writer.put(reader.get<std::uint8_t>());
    case 2: return writer.put(reader.get<std::uint16_t>());
    case 4: return writer.put(reader.get<std::uint32_t>());
    default: return writer.put(reader.get<std::uint64_t>());
  }
}

/// The member has been stepped over once, so it is sound.
MappingError get_field(const uadp::RawField& field, const IdlMember& member, CdrReader& reader, FieldWriter& writer) {
  const std::size_t count = count_of(member, reader);
  if (field.type == BuiltInType::ByteString) {
    if (!has_room(field.max_string_length, count)) return MappingError::wrong_length;
    writer.put(static_cast<std::uint8_t>(field.type));
    writer.put(static_cast<std::int32_t>(count));
    writer.put_octets(reader.take(count));
    return MappingError::none;
  }
  if (field.is_array && !is_length_agreed(field, member, count)) return MappingError::wrong_length;
  writer.put(static_cast<std::uint8_t>(uadp::index_of(field.type) | (field.is_array ? uadp::detail::array_flag : 0U)));
  if (field.is_array) writer.put(static_cast<std::int32_t>(count));
  for (std::size_t i = 0; i < count; ++i) {
    if (!is_text(field.type)) {
      get_element(member.kind, reader, writer);
      continue;
    }
    Octets text;
    if (const MappingError error = get_text(reader, text); error != MappingError::none) return error;
    if (!has_room(field.max_string_length, text.size())) return MappingError::wrong_length;
    writer.put(static_cast<std::int32_t>(text.size()));
    writer.put_octets(text);
  }
  return MappingError::none;
}

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

std::optional<TypeMapping> TypeMapping::make(Direction direction, std::vector<DataSetField> fields, IdlStruct type, const std::vector<Renamed>& renamed,
                                             std::vector<std::string>& problems) {
  const std::size_t problems_before = problems.size();
  check_names(fields, "field", problems);
  check_names(type.members, "member", problems);
  for (const Renamed& each : renamed) {
    if (!find(fields, each.field)) problems.push_back("a name for the field \"" + each.field + "\", which there is not");
    if (!find(type.members, each.member)) problems.push_back("a field for the member \"" + each.member + "\", which there is not");
  }
  const bool to_dds = direction == Direction::to_dds;
  TypeMapping mapping;
  std::vector<bool> is_taken(to_dds ? fields.size() : type.members.size());
  const auto pair_up = [&](std::size_t field, std::size_t member) {
    const std::string mismatch = mismatch_of(fields[field].type, type.members[member], direction);
    if (!mismatch.empty()) problems.push_back("field \"" + fields[field].name + "\" and member \"" + type.members[member].name + "\": " + mismatch);
    mapping.sources_.push_back(to_dds ? field : member);
    is_taken[mapping.sources_.back()] = true;
  };
  const auto field_for = [&](const std::string& member) {
    const auto found = std::find_if(renamed.begin(), renamed.end(), [&](const Renamed& each) { return each.member == member; });
    return find(fields, found == renamed.end() ? member : found->field);
  };
  const auto member_for = [&](const std::string& field) {
    const auto found = std::find_if(renamed.begin(), renamed.end(), [&](const Renamed& each) { return each.field == field; });
    return find(type.members, found == renamed.end() ? field : found->member);
  };
  for (std::size_t i = 0; i < (to_dds ? type.members.size() : fields.size()); ++i) {
    const std::string& name = to_dds ? type.members[i].name : fields[i].name;
    const auto source = to_dds ? field_for(name) : member_for(name);
    if (!source)
      problems.push_back(to_dds ? "no field for the member \"" + name + "\" of " + type.name : "no member of " + type.name + " for the field \"" + name + "\"");
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
  CdrWriter writer(payload);
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    const MappingError error = put_member(fields_[sources_[i]].type, type_.members[i], given_[sources_[i]], writer);
    if (error != MappingError::none) return error;
  }
  writer.finish();
  return MappingError::none;
}

MappingError TypeMapping::to_fields(Octets payload, std::vector<std::byte>& fields) {
  CdrReader reader(payload);
  if (reader.failed()) return MappingError::encapsulation;
  positions_.clear();
  for (const IdlMember& member : type_.members) {
    positions_.push_back(reader.position());
    if (const MappingError error = skip_member(member, reader); error != MappingError::none) return error;
  }
  if (reader.left() > 3) return MappingError::malformed;  // up to three octets pad the payload
  FieldWriter writer(fields);
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    reader.return_to(positions_[sources_[i]]);
    const MappingError error = get_field(fields_[i].type, type_.members[sources_[i]], reader, writer);
    if (error != MappingError::none) return error;
  }
  return MappingError::none;
}

}  // namespace takt::gateway
