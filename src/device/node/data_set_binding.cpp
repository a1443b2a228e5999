// SPDX-License-Identifier: Apache-2.0
#include "node/data_set_binding.hpp"

#include <algorithm>
#include <array>

#include "uadp/octets.hpp"

namespace takt::node {
namespace {

/// The octets of a field of a DataSet among the fields of a message: its elements, without a length.
std::size_t octets_of(const uadp::RawField& field) {
  return uadp::fixed_octets(field.type) * (field.is_array ? field.array_length : 1);
}

}  // namespace

DataSetBinding::DataSetBinding(const wire::ProgramShape& shape) {
  for (const wire::DataSetShape& each : shape.data_sets) bound_.push_back({each, nullptr});
}

bool DataSetBinding::bind(std::string_view name, pubsub::AnyDataSet& data_set) {
  const auto found =
      std::find_if(bound_.begin(), bound_.end(), [name](const Bound& each) { return each.shape.name == name; });
  if (found == bound_.end() || found->shape.fields.size() != data_set.field_count()) return false;
  for (std::size_t i = 0; i < data_set.field_count(); ++i) {
    const uadp::RawField field = data_set.field(i);
    const wire::FieldShape& wanted = found->shape.fields[i];
    const bool is_as_long = field.is_array ? field.array_length == wanted.count : wanted.count == 1;
    if (field.type != wanted.type || !is_as_long) return false;
  }
  found->data_set = &data_set;
  return true;
}

void DataSetBinding::produce(std::size_t data_set, std::int64_t, std::span<std::byte> fields) {
  const pubsub::AnyDataSet* const source = bound_[data_set].data_set;
  if (source == nullptr) return;
  std::array<std::byte, 1536> variant;  // the fields of a message fit into a frame
  uadp::Writer writer(fields);
  for (std::size_t i = 0; i < source->field_count(); ++i) {
    uadp::Writer scratch(variant);
    source->put(scratch, i);
    uadp::Reader reader(scratch.finished());
    writer.put_octets(uadp::get_variant(reader).octets);
  }
}

void DataSetBinding::consume(std::size_t data_set, std::int64_t, uadp::Octets fields) {
  pubsub::AnyDataSet* const target = bound_[data_set].data_set;
  if (target == nullptr) return;
  uadp::Reader reader(fields);
  for (std::size_t i = 0; i < target->field_count(); ++i) {
    const uadp::RawField field = target->field(i);
    uadp::Variant value;
    value.type = field.type;
    value.is_array = field.is_array;
    value.length = static_cast<std::int32_t>(field.is_array ? field.array_length : 0);
    value.octets = reader.take(octets_of(field));
    target->take(i, value);
  }
  target->notify();
}

}  // namespace takt::node
