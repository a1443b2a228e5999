// SPDX-License-Identifier: Apache-2.0
#include "json/reader.hpp"

#include <utility>

namespace takt::json {

void Reader::error(const Node& node, std::string message, Details details) {
  diagnostics_.unreadable(place_of(*document_.tree(), node), std::move(message), std::move(details));
}

void Reader::error_at_key(const Member& member, std::string message, Details details) {
  diagnostics_.unreadable(place_of(*document_.tree(), member.key_position, pointer_of(member.value)),
                          std::move(message), std::move(details));
}

void Reader::wrong_type(const Node& node, std::string expected) {
  error(node, "wrong type", {excerpt(node), std::move(expected), ""});
}

}  // namespace takt::json
