// SPDX-License-Identifier: Apache-2.0
// How a participant finds others: by which kind of discovery, and when it announces itself.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "dds/discovery/data.hpp"
#include "dds/message/locator.hpp"

namespace takt::dds {

enum class DiscoveryKind : std::uint8_t {
  simple,   ///< SPDP and SEDP, everybody with everybody (DDSI-RTPS 8.5)
  static_,  ///< SPDP finds participants; what endpoints they have is configured
  client,   ///< of a discovery server: announces to the servers only
  server,   ///< tells each client what it needs for its matches
};

/// When participants announce themselves. The standard leaves it open; implementations differ.
struct DiscoveryProfile {
  std::string_view name;
  sim::Duration lease_duration;
  sim::Duration announcement_period;
  std::uint32_t initial_announcements = 1;  ///< the first one at the start ...
  sim::Duration initial_period;             ///< ... and so long between them
  bool answers_new_participants = true;     ///< at once and to them alone
  sim::Duration client_period;              ///< of a client, until a server has answered
};

namespace discovery_profile {
using namespace sim::literals;
/// The defaults of the standard's text; 1 s until the answer of a server is ours.
inline constexpr DiscoveryProfile rtps{"rtps", 100_s, 30_s, 1, 30_s, true, 1_s};
inline constexpr DiscoveryProfile fast_dds{"fast-dds", 20_s, 3_s, 5, 100_ms, true, 450_ms};
/// It repeats its first announcement after 100 ms; then 80 % of the lease.
inline constexpr DiscoveryProfile cyclone{"cyclone", 10_s, 8_s, 2, 100_ms, true, 1_s};
inline constexpr std::array all{rtps, fast_dds, cyclone};
}  // namespace discovery_profile

/// UDP port of a discovery server, unless configured otherwise.
inline constexpr std::uint32_t discovery_server_port = 11811;

/// A participant whose endpoints are known beforehand, by the entity name that it announces. Of their GUIDs only the
/// entity counts; locators that are not given are the participant's default ones.
struct StaticParticipant {
  std::string name;
  std::vector<PublicationData> publications;
  std::vector<SubscriptionData> subscriptions;
};

struct DiscoverySettings {
  DiscoveryKind kind = DiscoveryKind::simple;
  DiscoveryProfile profile = discovery_profile::fast_dds;
  std::vector<Locator> announce_to;             ///< simple and static: group and peers
  std::vector<Locator> servers;                 ///< client: their metatraffic locators
  std::vector<StaticParticipant> participants;  ///< static
};

}  // namespace takt::dds
