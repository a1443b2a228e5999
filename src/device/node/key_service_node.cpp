// SPDX-License-Identifier: Apache-2.0
#include "node/key_service_node.hpp"

#include <algorithm>
#include <array>

#include "node/server_check.hpp"

namespace takt::node {

using namespace sim::literals;  // NOLINT: units in limits

const json::Object& describe(json::Type<KeyServiceNode>) {
  using json::optional;
  using json::required;
  static constexpr json::Field fields[] = {
      required<&KeyServiceNode::node>("node", "The name of this node.", {.min_length = 1, .max_length = 64}),
      optional<&KeyServiceNode::clock>(
          "clock", "The clock that the nodes share: keys change by the time of day, or with \"tai\" by CLOCK_TAI."),
      optional<&KeyServiceNode::duration>("duration", "How long it runs; until a signal if absent.",
                                          {.min = 1_ms, .max = 3600_s}),
      required<&KeyServiceNode::server>("server", "Its OPC UA server, with \"key_service\"."),
  };
  static constexpr json::Object table =
      json::object<KeyServiceNode>("key_service_node", "A node that is a key service and no more.", fields);
  return table;
}

bool is_key_service_file(const std::string& path) {
  json::Diagnostics unheard;
  const auto document = json::parse_file(path, unheard);
  if (!document) return false;
  const auto has = [&](const char* key) { return document->root().find(key) != nullptr; };
  constexpr std::array others = {"program", "programs", "applications", "gateways", "topics", "transport"};
  return has("server") && std::none_of(others.begin(), others.end(), has);
}

std::unique_ptr<LoadedConfig> load_key_service(const std::string& path, json::Diagnostics& diagnostics) {
  const auto document = json::parse_file(path, diagnostics);
  if (!document) return nullptr;
  KeyServiceNode file;
  json::decode(*document, file, diagnostics);
  if (diagnostics.has_errors()) return nullptr;
  auto loaded = std::make_unique<LoadedConfig>();
  loaded->config.node = file.node;
  loaded->config.clock = file.clock;
  loaded->config.duration = file.duration;
  loaded->config.server = file.server;
  if (!file.server.key_service)
    diagnostics.error(file.server.where.place(), "a server of nothing",
                      {"neither a program nor \"key_service\"", "\"key_service\", or a \"program\" beside \"server\""});
  check_server(*loaded, diagnostics);
  return diagnostics.has_errors() ? nullptr : std::move(loaded);
}

}  // namespace takt::node
