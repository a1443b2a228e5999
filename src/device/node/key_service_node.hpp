// SPDX-License-Identifier: Apache-2.0
// The file of a node that is a key service and no more: it is in no Program, and others pull the keys of their messages
// from its server.
#pragma once

#include "node/config.hpp"

namespace takt::node {

struct KeyServiceNode {
  json::Source where;
  std::string node;
  ClockName clock = ClockName::monotonic;
  std::optional<Duration> duration;
  ServerConfig server;
  bool operator==(const KeyServiceNode&) const = default;
};
const json::Object& describe(json::Type<KeyServiceNode>);

/// It has a "server", and nothing that the server would stand in front of.
bool is_key_service_file(const std::string& path);
/// Without Programs. Null if there was a mistake.
std::unique_ptr<LoadedConfig> load_key_service(const std::string& path, json::Diagnostics& diagnostics);

}  // namespace takt::node
