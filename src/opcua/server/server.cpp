#include "opcua/server/server.hpp"

#include <algorithm>

namespace takt::opcua {

Server::Server(ServerSettings settings, Identity identity, security::RandomOctets& random, ProgramHost& host, ServerLog& log, const std::vector<ProgramDescription>& programs, Now now,
               KeyService* keys)
    : settings_(std::move(settings)),
      identity_(std::move(identity)),
      random_(random),
      log_(log),
      now_(now),
      services_(settings_, identity_, random, host, log, *this, programs, keys, now) {
  std::array<std::byte, 4> first{};
  random_.fill(first);
  last_channel_ = uadp::load_little_endian<std::uint32_t>(first.data()) & 0x7FFF'FFFFU;  // not those of before a restart
}

Connection* Server::find(ConnectionId connection) {
  const auto found = connections_.find(connection);
  return found == connections_.end() ? nullptr : &found->second;
}
const Connection* Server::find(ConnectionId connection) const {
  const auto found = connections_.find(connection);
  return found == connections_.end() ? nullptr : &found->second;
}

/// The oldest that has no session goes, if there is one.
bool Server::make_room() {
  if (connections_.size() < settings_.limits.connections) return true;
  const auto oldest = std::find_if(connections_.begin(), connections_.end(),
                                   [&](const auto& each) { return each.second.stage != Connection::Stage::closing && !services_.has_session(each.first); });
  if (oldest == connections_.end()) return false;
  refuse(oldest->second, StatusCode::BadTcpNotEnoughResources, "idle while others want to connect");
  return true;
}

ConnectionId Server::connected(std::string source, Now now) {
  const bool has_room = make_room();
  Connection connection;
  connection.id = ++last_connection_;
  connection.source = std::move(source);
  connection.opened = now.local;
  connection.progress = now.local;
  connection.deadline = now.local + settings_.limits.hello_within;
  // A HEL is short; the buffers that it agrees on are those of what follows.
  connection.splitter = MessageSplitter(std::max<std::size_t>(settings_.limits.chunk_octets, least_buffer_octets));
  Connection& added = connections_.emplace(connection.id, std::move(connection)).first->second;
  if (!has_room) refuse(added, StatusCode::BadTcpNotEnoughResources, "too many connections");
  return added.id;
}

void Server::received(ConnectionId id, Octets octets, Now now) {
  now_ = now;
  Connection* const connection = find(id);
  if (connection == nullptr || connection->stage == Connection::Stage::closing) return;
  connection->splitter.feed(octets);
  while (connection->stage != Connection::Stage::closing) {
    const auto message = connection->splitter.next();
    if (!message) break;
    take(*connection, *message, now);
  }
  if (connection->stage != Connection::Stage::closing && connection->splitter.failure() != StatusCode::Good)
    refuse(*connection, connection->splitter.failure(), "what is no message of UA-TCP, or one that is too long");
}

void Server::disconnected(ConnectionId connection) {
  services_.disconnected(connection);
  connections_.erase(connection);
}

Octets Server::output(ConnectionId connection) const {
  const Connection* const found = find(connection);
  return found == nullptr ? Octets() : Octets(found->output).subspan(found->taken);
}

void Server::sent(ConnectionId id, std::size_t octets, Now now) {
  Connection* const connection = find(id);
  if (connection == nullptr || octets == 0) return;
  connection->taken += octets;
  connection->progress = now.local;
  if (connection->waiting() == 0) {
    connection->output.clear();
    connection->taken = 0;
  } else if (connection->taken > connection->output.size() / 2) {
    connection->output.erase(connection->output.begin(), connection->output.begin() + static_cast<std::ptrdiff_t>(connection->taken));
    connection->taken = 0;
  }
}

bool Server::is_closing(ConnectionId connection) const {
  const Connection* const found = find(connection);
  return found == nullptr || found->stage == Connection::Stage::closing;
}

bool Server::is_stuck(ConnectionId connection, Now now) const {
  const Connection* const found = find(connection);
  return found != nullptr && found->stage == Connection::Stage::closing && found->deadline <= now.local;
}

void Server::close(Connection& connection) {
  connection.stage = Connection::Stage::closing;
  connection.deadline = now_.local + settings_.limits.hello_within;
  connection.channel.reset();
  services_.disconnected(connection.id);
}

void Server::refuse(Connection& connection, StatusCode why, std::string_view what) {
  log_.refused(connection.source, std::string(what) + ": " + std::string(short_name_of(why)));
  connection.put(framed(MessageType::Error, ErrorMessage{why, Text(short_name_of(why))}));
  close(connection);
}

void Server::respond(ConnectionId id, std::uint32_t request_id, Octets body) {
  Connection* const connection = find(id);
  if (connection == nullptr || connection->channel == nullptr) return;
  if (connection->waiting() == 0) connection->progress = now_.local;
  if (!connection->channel->seal_message(request_id, body, connection->send, connection->output)) {
    // What was to be said is too long for this client; that it is, fits.
    ServiceFault fault;
    fault.response_header.timestamp = now_.utc;
    Decoder decoder(body);
    NodeId type;
    ResponseHeader header;
    decode(decoder, type);
    decode(decoder, header);
    fault.response_header.request_handle = header.request_handle;
    fault.response_header.service_result = StatusCode::BadResponseTooLarge;
    Encoder encoder;
    encode_message(encoder, fault);
    if (!connection->channel->seal_message(request_id, encoder.octets(), connection->send, connection->output)) return drop(*connection, "a client that takes no message of any length");
  }
  if (connection->waiting() > settings_.limits.output_octets) drop(*connection, "a client that does not read what it asks for");
}

/// What else the service says to this connection goes nowhere, for it has no channel any more.
void Server::drop(Connection& connection, std::string_view what) {
  log_.refused(connection.source, what);
  connection.output.clear();
  connection.taken = 0;
  connection.stage = Connection::Stage::closing;
  connection.deadline = now_.local;
  connection.channel.reset();
}

void Server::news(const ProgramNews& news, Now now) {
  now_ = now;
  services_.news(news);
}

void Server::advance(Now now) {
  now_ = now;
  services_.advance(now);
  for (auto& [id, connection] : connections_) {
    if (connection.stage == Connection::Stage::closing) continue;
    if (connection.stage == Connection::Stage::open && services_.has_session(id)) connection.deadline = now.local + settings_.limits.idle_channel;
    if (connection.deadline <= now.local) refuse(connection, StatusCode::BadTimeout, connection.stage == Connection::Stage::open ? "a channel without a session" : "no HEL or no channel");
    else if (connection.channel && connection.channel->ends() <= now.local) refuse(connection, StatusCode::BadSecureChannelTokenUnknown, "a channel that was not renewed");
    else if (connection.waiting() > 0 && connection.progress + settings_.limits.output_stall <= now.local) refuse(connection, StatusCode::BadTimeout, "a client that does not read");
  }
}

sim::LocalTime Server::next_time() const {
  sim::LocalTime next = services_.next_time();
  for (const auto& [id, connection] : connections_) {
    if (connection.stage == Connection::Stage::closing) continue;  // its host is about to close it
    next = std::min(next, connection.deadline);
    if (connection.channel) next = std::min(next, connection.channel->ends());
    if (connection.waiting() > 0) next = std::min(next, connection.progress + settings_.limits.output_stall);
  }
  return next;
}

}  // namespace takt::opcua
