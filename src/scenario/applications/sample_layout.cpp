#include "scenario/applications/sample_layout.hpp"

#include <algorithm>

#include "sim/check.hpp"
#include "uadp/store_number.hpp"
#include "plant/keys.hpp"
#include "plant/protocol.hpp"

namespace takt::scenario {

SampleLayout::SampleLayout(const json::NameMap<plant::DataField>& fields, const std::vector<std::string>& keys) : value_(plant::value_field(fields, keys)) {
  for (const auto& [name, field] : fields) {
    fields_.push_back({name, plant::built_in_type_of(field.type), field.count, octets_});
    octets_ += fields_.back().octets();
    if (std::find(keys.begin(), keys.end(), name) != keys.end()) keys_.push_back(fields_.size() - 1);
  }
}

void SampleLayout::set_first(std::span<std::byte> sample, std::uint64_t value) const {
  const bool is_number = uadp::store_number(fields_[value_].type, sample.data() + fields_[value_].offset, value);
  TAKT_CHECK(is_number, "fields of topics are numbers");
}

void SampleLayout::set_keys(std::span<std::byte> sample, std::uint64_t value) const {
  for (const std::size_t key : keys_) {
    const bool is_number = uadp::store_number(fields_[key].type, sample.data() + fields_[key].offset, value);
    TAKT_CHECK(is_number, "fields of topics are numbers");
  }
}

bool SampleLayout::first_is_zero(std::span<const std::byte> sample) const {
  const auto first = sample.subspan(fields_[value_].offset, uadp::fixed_octets(fields_[value_].type));
  return std::all_of(first.begin(), first.end(), [](std::byte octet) { return octet == std::byte{0}; });
}

}  // namespace takt::scenario
