// SPDX-License-Identifier: Apache-2.0
// A session (OPC 10000-4, 5.6), and the request that a service is asked.
#pragma once

#include <deque>
#include <map>

#include "opcua/server/budget.hpp"
#include "opcua/server/places.hpp"
#include "opcua/server/settings.hpp"
#include "opcua/services/session.hpp"
#include "opcua/services/view.hpp"

namespace takt::opcua {

using ConnectionId = std::uint32_t;

/// A Publish request that waits for something to publish.
struct QueuedPublish {
  std::uint32_t request_id = 0;
  std::uint32_t request_handle = 0;
  sim::LocalTime until;           ///< then it is answered with Bad_Timeout
  List<StatusCode> acknowledged;  ///< of what came with it
  HeldOctets held = {};
};

/// The rest of a node's references.
struct ContinuationPoint {
  List<ReferenceDescription> references;
  std::size_t most = 0;
  HeldOctets held;
};

struct Session {
  NodeId id;     ///< may be told
  NodeId token;  ///< is known to the client only
  Text name;
  Text client_uri;
  ConnectionId connection = 0;  ///< 0: none now
  ChannelSecurity security;     ///< of the channel
  std::optional<security::Certificate> certificate;
  std::vector<std::byte> nonce;  ///< which the next signature and password must have
  bool is_active = false;
  Text user;  ///< empty: anonymous
  Role role = Role::observer;
  std::string host;                       ///< that it was made from
  std::shared_ptr<OctetAccount> buffers;  ///< of its requests, responses and continuation points; as above
  std::shared_ptr<OctetAccount> account;  ///< of what it holds, once it is active
  sim::LocalTime left;                    ///< since when it has had no connection

  /// Whom what it takes counts for: the user, or the host of who has no name.
  std::string holder() const { return user.empty() ? host : "user " + user.value; }
  /// Who moves plants, or gives them keys, comes before who looks, and who has a name before who has none.
  int rank() const { return user.empty() ? 0 : role == Role::observer ? 1 : 2; }
  sim::Duration timeout;
  sim::LocalTime created;
  sim::LocalTime ends;
  std::deque<QueuedPublish> publishes;
  std::map<Bytes, ContinuationPoint> points;
  std::uint32_t last_published = 0;  ///< subscription, for those of one priority take turns
};

/// Where and how a request came.
struct Request {
  ConnectionId connection = 0;
  std::string source;  ///< of the connection, for logs
  std::string url;     ///< that the client used
  ChannelSecurity security;
  const security::Certificate* certificate = nullptr;
  std::uint32_t id = 0;
  RequestHeader header;
  Session* session = nullptr;  ///< null where none is needed
  Now now;
};

/// What a service answers: a response, or the result of a ServiceFault.
template <class Response>
using Answer = std::variant<Response, StatusCode>;

}  // namespace takt::opcua
