// The OPC UA server, sans-IO: its host gives it octets of connections, times and news of Programs, and takes octets from it.
//
// It reads no clock and opens no socket. Whatever a client sends, it takes bounded memory and time; what is refused is told to the log once a source.
#pragma once

#include "opcua/channel/trust_list.hpp"
#include "opcua/server/connection.hpp"
#include "opcua/server/services.hpp"

namespace takt::opcua {

class Server final : private Responder {
 public:
  /// What is given by reference outlives it. `keys` is null unless it is a key service, too.
  Server(ServerSettings settings, Identity identity, security::RandomOctets& random, ProgramHost& host, ServerLog& log, const std::vector<ProgramDescription>& programs, Now now,
         KeyService* keys = nullptr);
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  void trust(TrustList list) { trust_ = std::move(list); }

  /// A client has connected. It may be that its connection is to be closed at once, with what is to be sent before.
  ConnectionId connected(std::string source, Now now);
  /// Octets of it have come, in whatever pieces.
  void received(ConnectionId connection, Octets octets, Now now);
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

  /// Whatever is due by now.
  void advance(Now now);
  /// When `advance` is wanted next.
  sim::LocalTime next_time() const;

  void news(const ProgramNews& news, Now now);
  void answered(std::uint64_t serial, StatusCode status, Now now) { services_.answered(serial, status, now); }

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
  void close(Connection& connection);
  /// Ends it without a word, in the middle of a service, which must not lose its session under its hands: the host tells of the end.
  void drop(Connection& connection, std::string_view what);
  bool make_room();

  // channel_messages.cpp
  void take(Connection& connection, Octets message, Now now);
  void take_hello(Connection& connection, Octets message, Now now);
  void take_open(Connection& connection, Octets message, Now now);
  void answer_open(Connection& connection, const SequenceHeader& sequence, Octets body, const ChannelSecurity& asked, std::optional<security::Certificate> client, Now now);
  void send_open(Connection& connection, std::uint32_t request_id, const OpenSecureChannelResponse& response);
  void take_message(Connection& connection, Octets message, Now now);
  StatusCode check_client(Connection& connection, const AsymmetricHeader& header, std::optional<security::Certificate>& client, Now now);
  bool may_use_key(Now now);

  // dispatch.cpp
  void dispatch(Connection& connection, std::uint32_t request_id, Octets message, Now now);
  template <Structure Body, Structure Response, auto Function>
  void serve(Request& request, Decoder& body);
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
  std::size_t key_operations_ = 0;         ///< in this second
  sim::LocalTime key_operations_since_;
  Now now_;
  Services services_;
};

}  // namespace takt::opcua
