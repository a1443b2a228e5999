// SPDX-License-Identifier: Apache-2.0
// Pulls the keys of a node's messages from a key service, in a thread of its own beside the cycle: a client of
// src/protocol/opcua behind a socket. To the cycle it speaks by a mailbox only.
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "node/applications/thread_group.hpp"
#include "node/config.hpp"
#include "node/hand_over.hpp"
#include "node/key_mailbox.hpp"
#include "node/notices.hpp"
#include "node/server/name_lookup.hpp"
#include "node/server/pki.hpp"
#include "node/server/tcp_listener.hpp"
#include "opcua/client/call_client.hpp"
#include "security/pull_plan.hpp"
#include "security/pulled_keys.hpp"

namespace takt::node {

class KeyPuller {
 public:
  /// Null, and `problem` says why, if the machine does not give what it needs. `mailbox` and `notices` outlive it.
  /// `folder` is where the node's file is.
  static std::unique_ptr<KeyPuller> make(const LoadedConfig& loaded, const std::string& folder, KeyMailbox& mailbox,
                                         Notices& notices, std::string& problem);
  ~KeyPuller();

  /// Throws std::system_error if the machine gives no thread.
  void start();
  /// Ends, in the middle of a pull too; throws what the thread has thrown.
  void stop();

 private:
  KeyPuller(const LoadedConfig& loaded, opcua::Identity identity, KeyMailbox& mailbox, Notices& notices);

  void run();
  /// "", or what went wrong.
  std::string pull();
  std::string pull_from(const EndpointAddress& address);
  /// Of the service, by its name if it has one; none, and `problem` says why.
  std::vector<std::string> addresses(std::string& problem);
  std::string connected_call(TcpConnection& connection, opcua::CallClient& client);
  std::string take(const opcua::CallMethodResult& result);
  void tell(const std::string& problem);
  void log_if_none_are_left();
  /// Until the plan has a pull, or until it is to end.
  void wait();

  LoadedKeyAccess access_;
  std::string endpoint_;
  opcua::Identity identity_;
  KeyMailbox& mailbox_;
  Notices& notices_;
  security::SystemRandom random_;
  opcua::CallClientSettings settings_;
  security::PulledKeys keys_;
  security::PullPlan plan_;
  KeyServiceState state_;
  std::optional<NameLookup> lookup_;
  std::string told_;  ///< the last problem
  bool has_told_keys_ = false;
  bool has_told_none_ = false;
  std::atomic<bool> is_over_{false};
  Wake stop_;
  std::vector<std::byte> buffer_;
  ThreadGroup threads_{is_over_};
};

}  // namespace takt::node
