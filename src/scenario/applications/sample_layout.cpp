#include "scenario/applications/sample_layout.hpp"

#include <algorithm>

#include "sim/check.hpp"
#include "uadp/store_number.hpp"
#include "vocabulary/protocol.hpp"

namespace takt::scenario {

SampleLayout::SampleLayout(const json::NameMap<vocabulary::DataField>& fields) {
  for (const auto& [name, field] : fields) {
    fields_.push_back({name, vocabulary::built_in_type_of(field.type), field.count, octets_});
    octets_ += fields_.back().octets();
  }
}

void SampleLayout::set_first(std::span<std::byte> sample, std::uint64_t value) const {
  const bool is_number = uadp::store_number(fields_.front().type, sample.data(), value);
  TAKT_CHECK(is_number, "fields of topics are numbers");
}

bool SampleLayout::first_is_zero(std::span<const std::byte> sample) const {
  const auto first = sample.first(uadp::fixed_octets(fields_.front().type));
  return std::all_of(first.begin(), first.end(), [](std::byte octet) { return octet == std::byte{0}; });
}

}  // namespace takt::scenario
