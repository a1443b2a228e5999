// SPDX-License-Identifier: Apache-2.0
// What stands between $(( and )) of a shell.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace takt::interchange::linux_tc {

/// The value by + - * / %, signs and parentheses; `lookup` gives the text of a variable. Null if it is none, is not
/// known or does not fit.
std::optional<std::int64_t> shell_arithmetic(std::string_view text,
                                             const std::function<std::string(const std::string&)>& lookup);

}  // namespace takt::interchange::linux_tc
