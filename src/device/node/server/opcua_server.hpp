// SPDX-License-Identifier: Apache-2.0
// Hosts an OPC UA server (src/protocol/opcua) in a thread of its own beside the cycle of a node: sockets, clocks, the folder of
// certificates. To the cycle it speaks by a hand-over only.
#pragma once

#include <atomic>
#include <map>
#include <memory>

#include "node/applications/thread_group.hpp"
#include "node/config.hpp"
#include "node/hand_over.hpp"
#include "node/notices.hpp"
#include "node/server/pki.hpp"
#include "node/server/refusals.hpp"
#include "node/server/served_keys.hpp"
#include "node/server/tcp_listener.hpp"
#include "node/server/users.hpp"
#include "opcua/server/server.hpp"

namespace takt::node {

class OpcUaServer final : private opcua::ProgramHost, private opcua::ServerLog {
 public:
  /// Null, and `problem` says why, if the machine does not give what the file asks for. `hand_over` and `notices`
  /// outlive it. `folder` is where the node's file is.
  static std::unique_ptr<OpcUaServer> make(const LoadedConfig& loaded, std::vector<opcua::User> users,
                                           const std::string& folder, HandOver& hand_over, Notices& notices,
                                           std::string version, std::string& problem);
  ~OpcUaServer();

  /// Begins to serve. Throws std::system_error if the machine gives no thread.
  void start();
  /// Ends.
  void stop();
  /// Who may do what, and over which security: a line for each endpoint.
  std::string text() const;

 private:
  struct Open {
    TcpConnection connection;
    bool has_ended_sending = false;
    sim::LocalTime drained_until;  ///< an ERR arrives only if what the client still sends is taken
  };
  OpcUaServer(const ServerConfig& config, Pki pki, std::unique_ptr<TcpListener> listener, HandOver& hand_over,
              Notices& notices);

  bool call(std::uint64_t serial, std::size_t program, program::Method method) override;
  void refused(std::string_view source, std::string_view what, std::string_view detail) override;
  void rejected(std::string_view source, const security::Certificate& certificate) override;

  void run();
  /// The library's server as at the start, with what is known of the Programs.
  void build();
  /// Until the end, or until something is thrown.
  void serve();
  void begin_anew(const std::string& failure);
  void keep(const opcua::ProgramNews& news);
  void publish_state(bool is_running);
  void look_around();
  void take_trust_list();
  void read_reports();
  void read_connections();
  void receive_octets(opcua::ConnectionId id, Open& open);
  /// Sends what waits; false if the connection is over.
  bool give_octets(opcua::ConnectionId id, Open& open);
  opcua::Now now() const;
  int wait_ms() const;

  ServerConfig config_;
  Pki pki_;
  std::unique_ptr<TcpListener> listener_;
  HandOver& hand_over_;
  Notices& notices_;
  opcua::ServerSettings settings_;
  std::optional<opcua::Identity> identity_;
  std::vector<opcua::ProgramDescription> programs_;
  std::vector<opcua::ProgramNews> known_;  ///< the last of each kind, Program and peer
  security::SystemRandom random_;
  std::unique_ptr<ServedKeys> keys_;  ///< null: it is no key service
  std::vector<std::string> groups_;   ///< whose keys it gives
  std::unique_ptr<opcua::Server> server_;
  std::map<opcua::ConnectionId, Open> open_;
  Refusals refusals_;
  ServerState state_;
  std::int64_t trust_stamp_ = 0;
  sim::LocalTime looked_around_;  ///< at what changes outside
  sim::LocalTime trust_checked_;
  std::int64_t started_ns_ = 0;
  std::uint64_t lost_told_ = 0;
  std::atomic<bool> is_over_{false};
  Wake stop_;
  std::vector<std::byte> buffer_;
  ThreadGroup threads_{is_over_};
};

}  // namespace takt::node
