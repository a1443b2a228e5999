// SPDX-License-Identifier: Apache-2.0
#include "wire/program_shape.hpp"

#include <string_view>

namespace takt::wire {
namespace {

/// FNV-1a with 32 bits.
class Hash {
 public:
  void add(std::string_view text) {
    for (const char c : text) add_octet(static_cast<unsigned char>(c));
    add_octet(0);  // "a", "b" is not "ab"
  }
  void add(std::uint32_t number) {
    for (unsigned shift = 0; shift < 32; shift += 8) add_octet(number >> shift & 0xFF);
  }
  std::uint32_t value() const { return value_; }

 private:
  void add_octet(std::uint32_t octet) { value_ = (value_ ^ octet) * 16'777'619U; }
  std::uint32_t value_ = 2'166'136'261U;
};

}  // namespace

std::uint32_t group_version_of(const ProgramShape& shape) {
  Hash hash;
  hash.add(shape.name);
  hash.add(static_cast<std::uint32_t>(shape.variant));
  hash.add(static_cast<std::uint32_t>(shape.participants.size()));
  for (const std::string& name : shape.participants) hash.add(name);
  for (const DataSetShape& data_set : shape.data_sets) {
    hash.add(data_set.name);
    hash.add(std::uint32_t{data_set.from});
    hash.add(static_cast<std::uint32_t>(data_set.fields.size()));
    for (const FieldShape& field : data_set.fields) {
      hash.add(field.name);
      hash.add(static_cast<std::uint32_t>(field.type));
      hash.add(std::uint32_t{field.count});
    }
  }
  return hash.value() == 0 ? 1 : hash.value();
}

std::uint32_t octets_of(const DataSetShape& data_set) {
  std::uint32_t octets = 0;
  for (const FieldShape& field : data_set.fields)
    octets += static_cast<std::uint32_t>(uadp::fixed_octets(field.type)) * field.count;
  return octets;
}

}  // namespace takt::wire
