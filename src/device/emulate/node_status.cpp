// SPDX-License-Identifier: Apache-2.0
#include "emulate/node_status.hpp"

#include <algorithm>

#include "json/document.hpp"
#include "node/control_socket.hpp"

namespace takt::emulate {
namespace {

/// Who has such a role is not to be heard.
bool nobody_has(const json::Node& program, const std::string& role) {
  const json::Node* const roles = program.find("roles");
  return roles != nullptr && std::any_of(roles->items.begin(), roles->items.end(), [&](const json::Node& each) {
           return text_of(each, "name") == role && text_of(each, "node").empty();
         });
}

bool has_heard_all_of(const json::Node& program, std::string& not_yet) {
  const json::Node* const peers = program.find("peers");
  if (peers == nullptr) return false;
  for (const json::Node& peer : peers->items) {
    if (!text_of(peer, "state").empty() || nobody_has(program, text_of(peer, "name"))) continue;
    not_yet = "it does not hear " + text_of(peer, "name");
    return false;
  }
  return true;
}

}  // namespace

std::string text_of(const json::Node& object, std::string_view key) {
  const json::Node* const node = object.find(key);
  return node == nullptr ? std::string() : node->text;
}

bool has_heard_all(const std::string& socket, std::string& not_yet) {
  const auto status = node::ask_node(socket, "status", not_yet);
  if (!status) return false;
  json::Diagnostics diagnostics;
  const auto document = json::parse(*status, "status", diagnostics);
  if (!document) return false;
  bool has_heard = true;
  for_each_program(document->root(),
                   [&](const json::Node& program) { has_heard = has_heard && has_heard_all_of(program, not_yet); });
  return has_heard;
}

}  // namespace takt::emulate
