// SPDX-License-Identifier: Apache-2.0
// The OPC UA server, sans-IO: its host gives it octets of connections, times and news of Programs, and takes octets
// from it.
//
// It reads no clock and opens no socket. Whatever a client sends, it takes bounded memory, and bounded time in a turn.
// In a turn calls of operators come first; then channels are opened and renewed; then requests are served,
// those of whoever has cost least first; then come events and subscriptions. The rest waits for the next turn.
#pragma once

#include "opcua/channel/trust_list.hpp"
#include "opcua/server/connection.hpp"
#include "opcua/server/services.hpp"

namespace takt::opcua {

class Server final : private Responder {
 public:
  /// What is given by reference outlives it. `keys` is null unless it is a key service, too.
  Server(ServerSettings settings, Identity identity, security::RandomOctets& random, ProgramHost& host, ServerLog& log,
         const std::vector<ProgramDescription>& programs, Now now, KeyService* keys = nullptr);
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  void trust(TrustList list) { trust_ = std::move(list); }
  /// Ends channels and sessions of clients who are trusted no more: the list is another one, or a certificate has
  /// expired.
  void check_trust(Now now);

  /// A client has connected. It may be that its connection is to be closed at once, with what is to be sent before.
  ConnectionId connected(std::string source, Now now);
  /// Octets of it have come, in whatever pieces. What they ask for is done by `advance`.
  void take_in(ConnectionId connection, Octets octets, Now now);
  /// The same, and a turn of what they and others ask for.
  void received(ConnectionId connection, Octets octets, Now now);
  /// False: it has asked for so much that its octets are to wait where they are.
  bool takes_octets(ConnectionId connection) const;
  /// It is gone, or is about to be: by its own doing or its host's.
  void disconnected(ConnectionId connection);

  /// What waits to be sent on a connection.
  Octets output(ConnectionId connection) const;
  /// So much of it has been taken by the operating system.
  void sent(ConnectionId connection, std::size_t octets, Now now);
  /// The host closes it when nothing waits any more.
  bool is_closing(ConnectionId connection) const;
  /// It is to be closed, and has not taken for long what should be sent before.
  bool is_stuck(ConnectionId connection, Now now) const;

  /// The calls of operators that have come, in their order: the first part of a turn.
  void serve_calls(Now now);
  /// A turn: whatever is due by now, up to its budget.
  void advance(Now now);
  /// When `advance` is wanted next.
  sim::LocalTime next_time() const;

  void news(const ProgramNews& news, Now now);
  void answered(std::uint64_t serial, StatusCode status, Now now) { services_.answered(serial, status, now); }

  std::size_t connections() const { return connections_.size(); }

  const Services& services() const { return services_; }

 private:
  using Service = void (Server::*)(Request& request, Decoder& body);
  struct ServiceEntry {
    std::uint32_t encoding_id;
    Service service;
    bool needs_session;
    bool needs_activation;
  };
  static const ServiceEntry services_table[];
  static const ServiceEntry* service_with(const NodeId& type);

  void respond(ConnectionId connection, std::uint32_t request_id, Octets body) override;
  Connection* find(ConnectionId connection);
  const Connection* find(ConnectionId connection) const;
  /// Ends a connection with an ERR.
  void refuse(Connection& connection, StatusCode why, std::string_view what);
  void work(Now now);
  void serve_opens(Now now);
  void serve_requests(Now now);
  void serve(Connection& connection, WaitingRequest request, Now now);
  /// The next connection whose OPN is due, of those that renew a channel with a session or of the others; null: none
  /// waits.
  Connection* next_open(bool renewals);
  Connection* next_request();
  bool is_renewal(const Connection& connection) const {
    return connection.channel && services_.has_session(connection.id);
  }
  /// Counts what it holds; false: there is no room, and it goes.
  bool count(Connection& connection);
  std::size_t most_output(const Connection& connection) const;
  void close(Connection& connection);
  /// Ends it without a word, in the middle of a service, which must not lose its session under its hands: the host
  /// tells of the end.
  void drop(Connection& connection, std::string_view what);
  void make_room(const std::string& host);

  // channel_messages.cpp
  void take_messages(Connection& connection, Now now);
  void take(Connection& connection, Octets message, Now now);
  void accept_hello(Connection& connection, Octets message, Now now);
  void accept_open(Connection& connection, Octets message, Now now);
  void answer_open(Connection& connection, Octets clear, const ChannelSecurity& asked,
                   std::optional<security::Certificate> client, Now now);
  void send_open(Connection& connection, std::uint32_t request_id, const OpenSecureChannelResponse& response);
  void accept_message(Connection& connection, Octets message, Now now);
  StatusCode check_client(Connection& connection, const AsymmetricHeader& header,
                          std::optional<security::Certificate>& client, Now now);
  void open_channel(Connection& connection, WaitingOpen open, Now now);
  std::uint64_t key_operations_of(const WaitingOpen& open) const;
  void queue_request(Connection& connection, std::uint32_t id, std::vector<std::byte> message);

  // dispatch.cpp
  void dispatch(Connection& connection, std::uint32_t request_id, Octets message, Now now);
  template <Structure Body, Structure Response, auto Function>
  void serve_now(Request& request, Decoder& body);
  template <Structure Body, auto Function>
  void serve_later(Request& request, Decoder& body);

  ServerSettings settings_;
  Identity identity_;
  security::RandomOctets& random_;
  ServerLog& log_;
  TrustList trust_;
  std::map<ConnectionId, Connection> connections_;
  ConnectionId last_connection_ = 0;
  std::uint32_t last_channel_ = 0;
  Rate opens_;  ///< operations with the private key
  Rate renewals_;
  FairShares open_shares_;  ///< of hosts
  FairShares shares_;       ///< of users, or hosts of those without a name
  struct Urgent {
    ConnectionId connection = 0;
    WaitingRequest request;
  };
  std::deque<Urgent> calls_;
  std::uint64_t waited_ = 0;  ///< OPNs so far
  std::uint64_t served_ = 0;  ///< requests so far
  Now now_;
  Services services_;
};

}  // namespace takt::opcua
