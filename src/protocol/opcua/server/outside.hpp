// SPDX-License-Identifier: Apache-2.0
// What a server needs of its host.
#pragma once

#include <string_view>

#include "opcua/channel/open_message.hpp"
#include "opcua/server/session.hpp"
#include "opcua/services/security_keys.hpp"
#include "program/method.hpp"
#include "security/certificate.hpp"

namespace takt::opcua {

/// Calls of methods go out here, and are answered by Services::answered.
class ProgramHost {
 public:
  virtual ~ProgramHost() = default;
  /// False: it cannot be handed over now.
  virtual bool call(std::uint64_t serial, std::size_t program, program::Method method) = 0;
};

/// Has the keys of SecurityGroups. Asked only for who may have keys, over channels that encrypt.
class KeyService {
 public:
  virtual ~KeyService() = default;
  /// Bad_NotFound: no such group; Bad_UserAccessDenied: not for this user.
  virtual Answer<SecurityKeys> keys(const SecurityKeysRequest& request, std::string_view user) = 0;
};

/// What people should know.
class ServerLog {
 public:
  virtual ~ServerLog() = default;
  /// `what` is one of few texts; `detail` may be a stranger's.
  virtual void refused(std::string_view source, std::string_view what, std::string_view detail) = 0;
  /// A certificate that is not trusted; it is kept, so that it can be.
  virtual void rejected(std::string_view source, const security::Certificate& certificate) = 0;
};

/// Carries the body of a response to where its request came from.
class Responder {
 public:
  virtual ~Responder() = default;
  virtual void respond(ConnectionId connection, std::uint32_t request_id, Octets body) = 0;
};

}  // namespace takt::opcua
