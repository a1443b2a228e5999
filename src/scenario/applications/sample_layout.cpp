#include "scenario/applications/sample_layout.hpp"

#include <algorithm>

#include "vocabulary/protocol.hpp"

namespace takt::scenario {
namespace {

using uadp::BuiltInType;

template <class T>
void store(std::byte* at, std::uint64_t value) {
  uadp::store_little_endian(at, static_cast<T>(value));
}

struct Store {
  BuiltInType type;
  void (*store)(std::byte*, std::uint64_t);
};

constexpr Store stores[] = {
    {BuiltInType::Boolean, [](std::byte* at, std::uint64_t value) { *at = static_cast<std::byte>(value & 1); }},
    {BuiltInType::SByte, store<std::int8_t>},
    {BuiltInType::Byte, store<std::uint8_t>},
    {BuiltInType::Int16, store<std::int16_t>},
    {BuiltInType::UInt16, store<std::uint16_t>},
    {BuiltInType::Int32, store<std::int32_t>},
    {BuiltInType::UInt32, store<std::uint32_t>},
    {BuiltInType::Int64, store<std::int64_t>},
    {BuiltInType::UInt64, store<std::uint64_t>},
    {BuiltInType::Float, store<float>},
    {BuiltInType::Double, store<double>},
};

}  // namespace

SampleLayout::SampleLayout(const json::NameMap<vocabulary::DataField>& fields) {
  for (const auto& [name, field] : fields) {
    fields_.push_back({name, vocabulary::built_in_type_of(field.type), field.count, octets_});
    octets_ += fields_.back().octets();
  }
}

void SampleLayout::set_first(std::span<std::byte> sample, std::uint64_t value) const {
  const auto* const found = std::find_if(std::begin(stores), std::end(stores), [&](const Store& each) { return each.type == fields_.front().type; });
  found->store(sample.data(), value);
}

bool SampleLayout::first_is_zero(std::span<const std::byte> sample) const {
  const auto first = sample.first(uadp::fixed_octets(fields_.front().type));
  return std::all_of(first.begin(), first.end(), [](std::byte octet) { return octet == std::byte{0}; });
}

}  // namespace takt::scenario
