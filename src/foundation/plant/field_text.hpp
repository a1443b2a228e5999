// SPDX-License-Identifier: Apache-2.0
// Values of fields that are no numbers, as files write them.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "plant/uadp.hpp"

namespace takt::plant {

/// How a value of the type is written; empty for numbers.
std::string_view spelling_of(TopicType type);

/// The octets of a value in OPC UA Binary (OPC 10000-6, 5.2.2), of text with its length; nothing if the text is none of
/// the type.
std::optional<std::vector<std::byte>> octets_of_text(TopicType type, std::string_view text);

}  // namespace takt::plant
