// SPDX-License-Identifier: Apache-2.0
// The vocabulary of figures. See tables.cpp.
#include "scenario/description/figures.hpp"

namespace takt::scenario {

using json::name;

const json::Enumeration& describe(json::Type<Take>) {
  static constexpr json::EnumName names[] = {
      name(Take::max, "max", "the greatest"),     name(Take::min, "min", "the least"),
      name(Take::mean, "mean", "the mean"),       name(Take::sum, "sum", "the sum"),
      name(Take::count, "count", "their number"),
  };
  static constexpr json::Enumeration table = json::enumeration<Take>("what is taken of several values", names);
  return table;
}

}  // namespace takt::scenario
