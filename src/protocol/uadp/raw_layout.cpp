// SPDX-License-Identifier: Apache-2.0
#include "uadp/raw_layout.hpp"

namespace takt::uadp {
namespace {

constexpr std::size_t length_octets = 4;
/// Longer than any NetworkMessage.
constexpr std::uint32_t most_octets = 0xFFFF;

bool is_string(BuiltInType type) {
  return type == BuiltInType::String || type == BuiltInType::ByteString || type == BuiltInType::XmlElement;
}

std::size_t element_octets(const RawField& field) {
  return is_string(field.type) ? length_octets + field.max_string_length : fixed_octets(field.type);
}

std::size_t octets_of(const RawField& field) {
  return field.is_array ? length_octets + field.array_length * element_octets(field) : element_octets(field);
}

/// The strings of a field stay within their room.
bool strings_fit(Octets elements, std::size_t count, const RawField& field) {
  const std::size_t stride = element_octets(field);
  for (std::size_t i = 0; i < count; ++i) {
    const auto length = load_little_endian<std::int32_t>(elements.data() + i * stride);
    if (length < -1 || (length > 0 && static_cast<std::uint32_t>(length) > field.max_string_length)) return false;
  }
  return true;
}

/// Writes packed strings into rooms of fixed length.
bool put_strings(Writer& writer, const Variant& value, const RawField& field) {
  Reader reader(value.octets);
  for (std::size_t i = 0; i < value.size(); ++i) {
    const Octets text = get_length_and_octets(reader);
    if (reader.failed() || text.size() > field.max_string_length) return false;
    put_length_and_octets(writer, text);
    writer.put_zeros(field.max_string_length - text.size());
  }
  return true;
}

}  // namespace

std::string RawLayout::problem_of(const RawField& field) {
  if (field.is_array && (field.array_length == 0 || field.array_length > most_octets))
    return "an array needs ArrayDimensions of 1 to 65535 for RawData";
  if (is_string(field.type)) {
    if (field.max_string_length == 0 || field.max_string_length > most_octets)
      return "a string needs a MaxStringLength of 1 to 65535 for RawData";
    return {};
  }
  if (fixed_octets(field.type) == 0) return std::string(name_of(field.type)) + " has no fixed length in RawData";
  return {};
}

RawLayout::RawLayout(std::vector<RawField> fields) : fields_(std::move(fields)) {
  for (const RawField& field : fields_) {
    TAKT_CHECK(problem_of(field).empty(), "fields of a RawLayout have fixed lengths");
    offsets_.push_back(size_);
    size_ += octets_of(field);
  }
}

std::optional<Variant> RawLayout::at(Octets body, std::size_t index) const {
  const RawField& field = fields_[index];
  if (body.size() < offsets_[index] + octets_of(field)) return std::nullopt;
  Octets octets = body.subspan(offsets_[index], octets_of(field));
  Variant value;
  value.type = field.type;
  value.is_array = field.is_array;
  std::size_t count = 1;
  if (field.is_array) {
    const auto length = load_little_endian<std::uint32_t>(octets.data());
    if (length > field.array_length) return std::nullopt;
    value.length = static_cast<std::int32_t>(length);
    count = length;
    octets = octets.subspan(length_octets);
  }
  value.octets = octets.first(count * element_octets(field));
  if (!is_string(field.type)) return value;
  value.stride = element_octets(field);
  return strings_fit(value.octets, count, field) ? std::optional<Variant>(value) : std::nullopt;
}

bool RawLayout::put(Writer& writer, std::size_t index, const Variant& value) const {
  const RawField& field = fields_[index];
  const std::size_t begin = writer.position();
  const bool shape_fits = value.type == field.type && value.is_array == field.is_array &&
                          (!field.is_array || value.size() <= field.array_length) && value.stride == 0;
  bool fits = shape_fits;
  if (fits && field.is_array) writer.put(static_cast<std::uint32_t>(value.size()));
  if (fits && is_string(field.type)) {
    fits = put_strings(writer, value, field);
  } else if (fits) {
    writer.put_octets(value.octets);
  }
  if (writer.overflowed()) return false;
  if (!fits) writer.rewind_to(begin);
  writer.put_zeros(octets_of(field) - (writer.position() - begin));
  return fits;
}

}  // namespace takt::uadp
