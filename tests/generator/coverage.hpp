// SPDX-License-Identifier: Apache-2.0
// Which keys and words of the schema a scenario uses.
#pragma once

#include <set>
#include <string>
#include <string_view>

#include "tests/generator/schema.hpp"

namespace takt::generator {

/// "stream.launch" for each key that is there, "stream.encapsulation=udp" for each word of an enumeration,
/// "latency:short" for a short form.
using Keys = std::set<std::string, std::less<>>;

Keys keys_of(const Node& scenario);
/// All that the schema has.
Keys all_keys();

}  // namespace takt::generator
