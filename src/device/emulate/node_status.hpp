// SPDX-License-Identifier: Apache-2.0
// What a running node says of itself when it is asked for its status.
#pragma once

#include <string>
#include <string_view>

#include "json/node.hpp"

namespace takt::emulate {

/// A member that is a text; "" if there is none.
std::string text_of(const json::Node& object, std::string_view key);

/// A node of several Programs tells them in a list.
template <class Visit>
void for_each_program(const json::Node& status, const Visit& visit) {
  const json::Node* const programs = status.find("programs");
  if (programs == nullptr) return visit(status);
  for (const json::Node& program : programs->items) visit(program);
}

/// Whether the node with this control socket answers and has heard each peer that there is. If not, `not_yet` says why.
bool has_heard_all(const std::string& socket, std::string& not_yet);

}  // namespace takt::emulate
