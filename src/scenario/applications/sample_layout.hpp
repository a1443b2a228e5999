// A sample of a topic in memory: its fields one behind the other, little-endian, whatever the protocol that carries it.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "scenario/applications/description_applications.hpp"
#include "uadp/builtin_type.hpp"

namespace takt::scenario {

/// The octets of a sample.
using Sample = std::vector<std::byte>;

class SampleLayout {
 public:
  struct Field {
    std::string name;
    uadp::BuiltInType type = uadp::BuiltInType::Double;
    std::uint32_t count = 1;                     ///< above 1: an array
    std::size_t offset = 0;
    std::size_t octets() const { return uadp::fixed_octets(type) * count; }
    bool same_type(const Field& other) const { return type == other.type && count == other.count; }
  };

  SampleLayout() = default;
  explicit SampleLayout(const json::NameMap<plant::DataField>& fields, const std::vector<std::string>& keys = {});

  const std::vector<Field>& fields() const { return fields_; }
  std::size_t octets() const { return octets_; }
  /// All zeros.
  Sample zeros() const { return Sample(octets_); }

  /// Sets the first value of the first field that is no key; integers keep its low bits.
  void set_first(std::span<std::byte> sample, std::uint64_t value) const;
  /// Sets the first value of each key field.
  void set_keys(std::span<std::byte> sample, std::uint64_t value) const;
  bool first_is_zero(std::span<const std::byte> sample) const;

 private:
  std::vector<Field> fields_;
  std::size_t octets_ = 0;
  std::size_t value_ = 0;            // the first field that is no key
  std::vector<std::size_t> keys_;    // fields
};

}  // namespace takt::scenario
