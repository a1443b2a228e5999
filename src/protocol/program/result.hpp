// SPDX-License-Identifier: Apache-2.0
// Values that a Program produces: intermediate results and FinalResultData (OPC 10000-10, 4.2.8 and 5.2.2).
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace takt::program {

/// A value of any type that a method or a result may have; monostate is none.
using Value = std::variant<std::monostate, bool, std::int64_t, double, std::string>;

struct NamedValue {
  std::string name;
  Value value;
  bool operator==(const NamedValue&) const = default;
};

/// Transient: belongs to one transition and is delivered with its event only.
using IntermediateResult = std::vector<NamedValue>;
/// Of an execution that has ended: readable until the next one ends or the Program is deleted.
using FinalResultData = std::vector<NamedValue>;

}  // namespace takt::program
