// SPDX-License-Identifier: Apache-2.0
#include "gateway/field_values.hpp"

#include <array>

#include "sim/check.hpp"
#include "uadp/variant.hpp"

namespace takt::gateway {
namespace {

using uadp::BuiltInType;

/// Octets of a Variant: what `put_variant` writes.
std::size_t octets_of(const uadp::Variant& value) {
  return 1 + (value.is_array ? 4 : 0) + value.octets.size() + value.dimensions.size();
}

void store(const uadp::Variant& value, std::vector<std::byte>& target) {
  target.resize(octets_of(value));
  uadp::Writer writer(target);
  put_variant(writer, value);
  TAKT_CHECK(!writer.overflowed(), "a Variant fits into its own length");
  target.resize(writer.position());  // strings of RawData are packed
}

/// Whether no string is longer than the field's; any is where it has no greatest length.
bool strings_fit(const uadp::RawField& field, const uadp::Variant& value) {
  if (field.max_string_length == 0) return true;
  uadp::Reader reader(value.octets);
  for (std::size_t i = 0; i < value.size(); ++i) {
    const std::size_t begin = reader.position();
    if (uadp::get_length_and_octets(reader).size() > field.max_string_length || reader.failed()) return false;
    if (value.stride != 0) reader.take(value.stride - (reader.position() - begin));  // RawData pads
  }
  return true;
}

std::vector<std::byte> zero_of(const uadp::RawField& field) {
  const std::size_t fixed = uadp::fixed_octets(field.type);
  const std::size_t of_one = fixed != 0 ? fixed : 4;  // a string of length 0
  std::vector<std::byte> octets(1 + (field.is_array ? 4 + field.array_length * of_one : of_one));
  octets[0] = static_cast<std::byte>(uadp::index_of(field.type) | (field.is_array ? uadp::detail::array_flag : 0U));
  if (field.is_array) uadp::store_little_endian(octets.data() + 1, static_cast<std::int32_t>(field.array_length));
  return octets;
}

}  // namespace

FieldValues::FieldValues(std::vector<DataSetField> fields) : fields_(std::move(fields)) {
  for (const DataSetField& field : fields_) values_.push_back(zero_of(field.type));
}

Octets FieldValues::octets() const {
  joined_.clear();
  for (std::size_t i = 0; i < values_.size(); ++i) {
    if (!status(i).is_bad() || fields_[i].type.type == BuiltInType::StatusCode) {
      joined_.insert(joined_.end(), values_[i].begin(), values_[i].end());
      continue;
    }
    std::array<std::byte, 5> bad{};
    uadp::Writer writer(bad);
    uadp::put_variant(writer, status(i));
    joined_.insert(joined_.end(), bad.begin(), bad.end());
  }
  return joined_;
}

bool FieldValues::can_take(std::size_t index, const uadp::Variant& value) const {
  const uadp::RawField& field = fields_[index].type;
  if (value.type != field.type || value.is_array != field.is_array || !value.dimensions.empty())
    return false;  // arrays have one dimension, which is not said
  return (!field.is_array || field.array_length == 0 || value.size() <= field.array_length) &&
         strings_fit(field, value);
}

bool FieldValues::take(std::size_t index, const uadp::Variant& value) {
  if (!can_take(index, value)) return false;
  store(value, values_[index]);
  changed();
  return true;
}

bool FieldValues::assign(Octets octets) {
  uadp::Reader reader(octets);
  for (std::size_t i = 0; i < fields_.size(); ++i)
    if (!can_take(i, uadp::get_variant(reader)) || reader.failed()) return false;
  if (reader.left() != 0) return false;
  reader = uadp::Reader(octets);
  for (auto& value : values_) {
    const std::size_t begin = reader.position();
    uadp::get_variant(reader);
    const Octets variant = reader.since(begin);
    value.assign(variant.begin(), variant.end());
  }
  changed();
  return true;
}

}  // namespace takt::gateway
