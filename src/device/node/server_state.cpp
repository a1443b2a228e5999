// SPDX-License-Identifier: Apache-2.0
#include "node/server_state.hpp"

#include "json/record.hpp"

namespace takt::node {

const json::Record& describe(json::Type<ServerState>) {
  static constexpr json::Output outputs[] = {
      json::output<&ServerState::is_running>("running", "False: it has failed, and begins anew within a second."),
      json::output<&ServerState::restarts>("restarts", "How often it had to begin anew."),
      json::output<&ServerState::failure>("failure", "Why it had to last; null: it never had to."),
      json::output<&ServerState::connections>("connections", "Of clients."),
      json::output<&ServerState::sessions>("sessions", "Of clients; those that have not signed in yet as well."),
      json::output<&ServerState::subscriptions>("subscriptions", "Of sessions, and of those that are gone."),
      json::output<&ServerState::octets>(
          "octets", "That sessions hold: filters, queues, messages that are not acknowledged, requests and responses.",
          {.unit = "octets"}),
      json::output<&ServerState::refused>("refused", "Connections, requests and sign-ins that were refused."),
      json::output<&ServerState::rejected>("rejected", "Of these: certificates that are not trusted."),
  };
  static constexpr json::Record record{"server_status", "The OPC UA server of the node.", outputs};
  return record;
}

}  // namespace takt::node
