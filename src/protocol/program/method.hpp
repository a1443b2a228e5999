// SPDX-License-Identifier: Apache-2.0
// The five Program control methods (OPC 10000-10, 5.2.7).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace takt::program {

enum class Method : std::uint8_t { Start, Suspend, Resume, Halt, Reset };

struct MethodInfo {
  Method method;
  std::string_view name;  ///< BrowseName
  std::uint16_t node_id;  ///< i=... in namespace 0
};

inline constexpr std::array<MethodInfo, 5> methods{{
    {Method::Start, "Start", 2426},
    {Method::Suspend, "Suspend", 2427},
    {Method::Resume, "Resume", 2428},
    {Method::Halt, "Halt", 2429},
    {Method::Reset, "Reset", 2430},
}};

constexpr std::size_t index_of(Method method) { return static_cast<std::size_t>(method); }
constexpr const MethodInfo& info(Method method) { return methods[index_of(method)]; }
constexpr std::string_view name_of(Method method) { return info(method).name; }

/// The method with this BrowseName (exact case); nothing if there is none.
constexpr std::optional<Method> method_from_name(std::string_view name) {
  for (const MethodInfo& each : methods)
    if (each.name == name) return each.method;
  return std::nullopt;
}

/// A set of methods, one bit each.
struct MethodSet {
  std::uint8_t bits = 0;
  constexpr MethodSet() = default;
  template <class... Methods>
  constexpr explicit MethodSet(Method first, Methods... rest) {
    for (Method each : {first, rest...}) bits = static_cast<std::uint8_t>(bits | (1U << index_of(each)));
  }
  constexpr bool contains(Method method) const { return ((bits >> index_of(method)) & 1U) != 0; }
  constexpr bool operator==(const MethodSet&) const = default;
};

namespace detail {
constexpr bool methods_are_complete() {
  for (std::size_t i = 0; i < methods.size(); ++i)
    if (index_of(methods[i].method) != i || methods[i].name.empty()) return false;
  return index_of(Method::Reset) + 1 == methods.size();
}
static_assert(methods_are_complete(), "methods holds every Method, in order");
}  // namespace detail

}  // namespace takt::program
