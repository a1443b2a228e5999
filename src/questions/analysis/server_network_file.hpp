// SPDX-License-Identifier: Apache-2.0
// Files of textbook networks: servers, flows, which analysis. What `takt bound` takes beside scenarios; docs/bounds.md
// shows the format.
#pragma once

#include <optional>
#include <string>

#include "analysis/server_network.hpp"
#include "json/document.hpp"

namespace takt::analysis {

enum class NetworkAnalysis : std::uint8_t { both, tfa, sfa };

struct ServerNetworkFile {
  std::string name;
  ServerNetwork network;
  NetworkAnalysis analysis = NetworkAnalysis::both;
};

/// True for a document of this format: an object with "servers".
bool is_server_network(const json::Document& document);

/// Reads and checks a document; mistakes go to `diagnostics`, and then there is no result.
std::optional<ServerNetworkFile> read_server_network(const json::Document& document, json::Diagnostics& diagnostics);

/// What the analyses say, as a page or as JSON. Throws RationalOverflow.
std::string server_network_report(const ServerNetworkFile& file, bool as_json);

}  // namespace takt::analysis
