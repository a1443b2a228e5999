// SPDX-License-Identifier: Apache-2.0
// What a server is told: who it is, whom it lets do what, and how much it takes. Every limit can be set, and clients
// are told of those that they can read.
#pragma once

#include "opcua/channel/policy.hpp"
#include "opcua/channel/secure_channel.hpp"
#include "security/key_derivation.hpp"

namespace takt::opcua {

/// A point in time by both clocks: one that never steps, for what lasts, and UTC, for what is told.
struct Now {
  sim::LocalTime local;
  DateTime utc;
};
/// Seconds between 1601 and 1970.
inline constexpr std::int64_t epoch_1970_s = 11'644'473'600;
inline std::int64_t seconds_since_1970(DateTime time) { return time.ticks / 10'000'000 - epoch_1970_s; }

constexpr sim::Duration milliseconds(std::int64_t count) { return sim::Duration::from_ps(count * 1'000'000'000); }

/// All see. Operators call methods of Programs, and so do engineers, who also configure whom to trust; nodes with key
/// access get keys and call nothing else.
enum class Role : std::uint8_t { observer, operator_, engineer, key_access };

struct User {
  std::string name;
  security::PasswordHash password;
  Role role = Role::observer;
};

struct Limits {
  std::size_t connections = 100;
  std::uint32_t chunk_octets = 65'536;   ///< at least 8192
  std::size_t message_octets = 1 << 20;  ///< of a request
  std::size_t message_chunks = 64;
  std::size_t output_octets = 4 << 20;  ///< waiting for a slow client
  sim::Duration output_stall = milliseconds(30'000);
  sim::Duration hello_within = milliseconds(10'000);  ///< and then the channel within the same
  sim::Duration idle_channel = milliseconds(60'000);  ///< without a session
  std::size_t private_key_operations =
      100;  ///< a second, for all who want to open channels; as many for those who renew one with a session
  std::size_t sessions = 50;
  sim::Duration session_grace =
      milliseconds(10'000);  ///< a session without a connection keeps its place so long while others want it
  sim::Duration least_session = milliseconds(10'000);
  sim::Duration most_session = milliseconds(3'600'000);
  TokenLifetimes tokens;
  std::size_t subscriptions = 200;
  std::size_t subscriptions_of_session = 20;
  std::size_t items = 1000;  ///< of a subscription
  std::size_t queue = 100;   ///< values of an item
  std::size_t event_queue = 1000;
  std::size_t publish_requests = 40;                          ///< of a session
  std::size_t operations = 1000;                              ///< of a request
  std::size_t continuation_points = 10;                       ///< of a session
  std::size_t references = 1000;                              ///< of a node at once
  std::size_t retransmissions = 20;                           ///< kept by a subscription
  sim::Duration most_subscription = milliseconds(3'600'000);  ///< longest lifetime
  sim::Duration orphan_subscription = milliseconds(120'000);  ///< of one whose session is gone
  std::size_t session_octets =
      4 << 20;  ///< that it may hold: filters, queues, messages that are not acknowledged, requests and responses
  std::size_t user_octets = 8 << 20;            ///< the same of all sessions of a user, or of a host without a name
  std::size_t all_octets = 16 << 20;            ///< the same of all
  std::size_t select_clauses = 1000;            ///< of a filter
  std::size_t where_operands = 4096;            ///< of a filter
  std::size_t notification_octets = 256 << 10;  ///< of a message of a subscription, about
  sim::Duration least_publishing = milliseconds(10);
  sim::Duration most_publishing = milliseconds(3'600'000);
  std::size_t failed_sign_ins = 5;  ///< then each further one waits longer
  sim::Duration call_within = milliseconds(5'000);
};

struct ServerSettings {
  std::string application_uri;
  std::string application_name;
  std::string software_version;
  std::string endpoint_url;                ///< "opc.tcp://host:port"
  std::vector<ChannelSecurity> endpoints;  ///< at least one; without None, None is good for discovery only
  bool anonymous = false;                  ///< sessions without a name are let in, as observers
  std::vector<User> users;
  bool calls_without_encryption = false;  ///< operators may call over None and Sign, too
  bool halt_without_encryption = false;   ///< they may call Halt there
  Limits limits;
};

}  // namespace takt::opcua
