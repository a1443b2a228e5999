#include "scenario/applications/sample_data_set.hpp"

#include <algorithm>

namespace takt::scenario {

uadp::RawField SampleDataSet::field(std::size_t index) const {
  const SampleLayout::Field& field = layout_->fields()[index];
  return {field.type, field.count > 1, field.count > 1 ? field.count : 0, 0};
}

/// In memory values are as on the wire, so a Variant is its header and a copy.
void SampleDataSet::put(uadp::Writer& writer, std::size_t index) const {
  const SampleLayout::Field& field = layout_->fields()[index];
  writer.put(static_cast<std::uint8_t>(uadp::index_of(field.type) | (field.count > 1 ? uadp::detail::array_flag : 0)));
  if (field.count > 1) writer.put(static_cast<std::int32_t>(field.count));
  writer.put_octets(uadp::Octets(sample_).subspan(field.offset, field.octets()));
}

bool SampleDataSet::can_take(std::size_t index, const uadp::Variant& value) const {
  const SampleLayout::Field& field = layout_->fields()[index];
  return value.type == field.type && value.is_array == (field.count > 1) && value.size() == field.count && value.stride == 0 && value.octets.size() == field.octets();
}

bool SampleDataSet::take(std::size_t index, const uadp::Variant& value) {
  if (!can_take(index, value)) return false;
  std::copy(value.octets.begin(), value.octets.end(), sample_.begin() + static_cast<std::ptrdiff_t>(layout_->fields()[index].offset));
  return true;
}

void SampleDataSet::set(std::span<const std::byte> sample) {
  std::copy(sample.begin(), sample.end(), sample_.begin());
  changed();
}

}  // namespace takt::scenario
