// SPDX-License-Identifier: Apache-2.0
#include "node/server_check.hpp"

namespace takt::node {

void check_server(LoadedConfig& loaded, json::Diagnostics& diagnostics) {
  const ServerConfig& server = *loaded.config.server;
  if (!parse_endpoint(server.endpoint))
    diagnostics.error(
        server.where.at("endpoint"), "no endpoint",
        {json::quote(server.endpoint),
         "\"opc.tcp://\", an IPv4 address or localhost, \":\" and a port, as in \"opc.tcp://127.0.0.1:4840\""});
  if (!server.anonymous && !server.users)
    diagnostics.error(server.where.place(), "a server that lets nobody in",
                      {"neither \"users\" nor \"anonymous\"", "a file of users, or \"anonymous\": true for reading"});
  const ServerLimits limits = server.limits.value_or(ServerLimits());
  const auto check_order = [&](const std::optional<Duration>& least, const std::optional<Duration>& most,
                               const char* key) {
    if (least && most && *most < *least)
      diagnostics.error(limits.where.at(key), "less than the least",
                        {json::to_text(*most), "at least " + json::to_text(*least)});
  };
  check_order(limits.least_session, limits.most_session, "most_session");
  check_order(limits.least_token, limits.most_token, "most_token");
  if (server.key_service) loaded.served = load_groups(server, diagnostics);
}

}  // namespace takt::node
