// SPDX-License-Identifier: Apache-2.0
// The words in which schema.cpp and its parts say what YANG modules have.
#pragma once

#include "interchange/yang/modules.hpp"
#include "interchange/yang/schema.hpp"

namespace takt::interchange::yang {

constexpr Schema leaf(std::string_view module, std::string_view name, Type type, bool mandatory = false,
                      std::uint64_t least = 0, std::uint64_t most = ~std::uint64_t{0}) {
  return {module, name, type, {}, {}, {}, mandatory, least, most};
}
constexpr Schema one_of(std::string_view module, std::string_view name, std::string_view choices,
                        bool mandatory = false) {
  return {module, name, Type::choice, {}, {}, choices, mandatory};
}
constexpr Schema identity_of(std::string_view module, std::string_view name, std::string_view choices,
                             bool mandatory = false) {
  return {module, name, Type::identity, {}, {}, choices, mandatory};
}
constexpr Schema node(std::string_view module, std::string_view name, std::span<const Schema> children) {
  return {module, name, Type::container, children};
}
constexpr Schema entries(std::string_view module, std::string_view name, std::string_view key,
                         std::span<const Schema> children) {
  return {module, name, Type::list, children, key};
}
constexpr Schema state(std::string_view module, std::string_view name) {
  Schema schema{module, name, Type::anything};
  schema.is_state = true;
  return schema;
}
/// What a device can be told and takt has nothing for: read past, with a remark.
constexpr Schema unheard(std::string_view module, std::string_view name) { return {module, name, Type::anything}; }
constexpr Schema leaves(std::string_view module, std::string_view name, Type type) {
  Schema schema{module, name, type};
  schema.is_leaf_list = true;
  return schema;
}

template <const std::string_view& m>
inline constexpr Schema rational[] = {leaf(m, "numerator", Type::uint32),
                                      leaf(m, "denominator", Type::uint32, false, 1)};
template <const std::string_view& m>
inline constexpr Schema rational_of_2018[] = {leaf(m, "numerator", Type::uint32), leaf(m, "denominator", Type::uint32)};
template <const std::string_view& m>
inline constexpr Schema ptp_time[] = {leaf(m, "seconds", Type::uint64), leaf(m, "nanoseconds", Type::uint32)};

}  // namespace takt::interchange::yang
