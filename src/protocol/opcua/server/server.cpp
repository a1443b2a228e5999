// SPDX-License-Identifier: Apache-2.0
#include "opcua/server/server.hpp"

#include <algorithm>
#include <tuple>

namespace takt::opcua {
namespace {

constexpr std::uint64_t steps_of_requests = 50'000;  // in a turn: some milliseconds; a request that is longer ends it
constexpr std::uint64_t steps_of_request = 100;
constexpr std::size_t octets_of_step = 16;
constexpr std::size_t most_requests = 100;  // of a connection that wait: then its octets wait, too
constexpr std::size_t most_request_octets = 256 << 10;
constexpr std::size_t most_unread_octets = 64 << 10;  // of responses; then requests wait
constexpr std::size_t most_output_of_strangers = 128 << 10;

}  // namespace

Server::Server(ServerSettings settings, Identity identity, security::RandomOctets& random, ProgramHost& host,
               ServerLog& log, const std::vector<ProgramDescription>& programs, Now now, KeyService* keys)
    : settings_(std::move(settings)),
      identity_(std::move(identity)),
      random_(random),
      log_(log),
      opens_(settings_.limits.private_key_operations),
      renewals_(settings_.limits.private_key_operations),
      now_(now),
      services_(settings_, identity_, random, host, log, *this, programs, keys, now) {
  std::array<std::byte, 4> first{};
  random_.fill(first);
  last_channel_ =
      uadp::load_little_endian<std::uint32_t>(first.data()) & 0x7FFF'FFFFU;  // not those of before a restart
}

Connection* Server::find(ConnectionId connection) {
  const auto found = connections_.find(connection);
  return found == connections_.end() ? nullptr : &found->second;
}
const Connection* Server::find(ConnectionId connection) const {
  const auto found = connections_.find(connection);
  return found == connections_.end() ? nullptr : &found->second;
}

/// Of those without a session, of the host that has most of them, the one that has come least far, and of these the
/// oldest.
void Server::make_room(const std::string& host) {
  const auto open = std::count_if(connections_.begin(), connections_.end(),
                                  [](const auto& each) { return each.second.stage != Connection::Stage::closing; });
  if (static_cast<std::size_t>(open) < settings_.limits.connections) return;
  std::vector<Place> places;
  std::vector<ConnectionId> numbers;
  for (const auto& [id, each] : connections_) {
    if (each.stage == Connection::Stage::closing || services_.has_session(id)) continue;
    places.push_back(
        {host_of(each.source), 0, 2 * static_cast<int>(each.stage) + (each.opening ? 1 : 0), false, each.opened});
    numbers.push_back(id);
  }
  if (const auto given = place_to_give(places, {host, 1}))
    refuse(connections_.at(numbers[*given]), StatusCode::BadTcpNotEnoughResources, "idle while others want to connect");
}

ConnectionId Server::connected(std::string source, Now now) {
  make_room(host_of(source));
  const auto open = std::count_if(connections_.begin(), connections_.end(),
                                  [](const auto& each) { return each.second.stage != Connection::Stage::closing; });
  const bool has_room = static_cast<std::size_t>(open) < settings_.limits.connections;
  Connection connection;
  connection.id = ++last_connection_;
  connection.source = std::move(source);
  connection.account = host_of(connection.source);
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
  take_in(id, octets, now);
  work(now);
}

void Server::take_in(ConnectionId id, Octets octets, Now now) {
  now_ = now;
  Connection* const connection = find(id);
  if (connection == nullptr || connection->stage == Connection::Stage::closing) return;
  connection->splitter.feed(octets);
  take_messages(*connection, now);
}

/// What has come behind an OPN waits with it: its sequence numbers follow those of the OPN.
void Server::take_messages(Connection& connection, Now now) {
  while (connection.stage != Connection::Stage::closing && !connection.opening) {
    const auto message = connection.splitter.next();
    if (!message) break;
    take(connection, *message, now);
  }
  if (connection.stage != Connection::Stage::closing && connection.splitter.failure() != StatusCode::Good)
    refuse(connection, connection.splitter.failure(), "what is no message of UA-TCP, or one that is too long");
  if (connection.stage != Connection::Stage::closing) count(connection);
}

bool Server::takes_octets(ConnectionId id) const {
  const Connection* const connection = find(id);
  if (connection == nullptr || connection->stage == Connection::Stage::closing)
    return true;  // what still comes is dropped
  return !connection->opening && connection->requests.size() < most_requests &&
         connection->waiting_octets < most_request_octets;
}

std::size_t Server::most_output(const Connection& connection) const {
  return services_.has_session(connection.id) ? settings_.limits.output_octets
                                              : std::min(settings_.limits.output_octets, most_output_of_strangers);
}

bool Server::count(Connection& connection) {
  const Session* const session = services_.session_on(connection.id);
  const auto account = session != nullptr ? session->buffers : nullptr;
  if (connection.counts_for != account) {
    connection.counts_for = account;
    connection.held = HeldOctets(account);
    connection.account = session != nullptr ? session->holder() : host_of(connection.source);
  }
  if (connection.held.set(connection.output.size() + connection.waiting_octets + connection.assembler.held()))
    return true;
  drop(connection, "a session that wants more memory than it may have");
  return false;
}

void Server::work(Now now) {
  now_ = now;
  serve_calls(now);
  serve_opens(now);
  serve_calls(now);  // those that came behind an OPN
  serve_requests(now);
}

/// Before all else: they cost little, and somebody waits for what they move. In their order: who starts and then halts
/// means that.
void Server::serve_calls(Now now) {
  while (!calls_.empty()) {
    Urgent next = std::move(calls_.front());
    calls_.pop_front();
    Connection* const connection = find(next.connection);
    if (connection != nullptr && connection->channel) serve(*connection, std::move(next.request), now);
  }
}

/// In the order in which they came, but each host as often as the others.
Connection* Server::next_open(bool renewals) {
  Connection* next = nullptr;
  std::pair<std::uint64_t, std::uint64_t> least;
  for (auto& [id, each] : connections_) {
    if (!each.opening || is_renewal(each) != renewals) continue;
    const std::pair order(open_shares_.spent(host_of(each.source)), each.opening->number);
    if (next == nullptr || order < least) std::tie(next, least) = std::tuple(&each, order);
  }
  return next;
}

void Server::serve_opens(Now now) {
  for (const bool renewals : {true, false}) {
    Rate& rate = renewals ? renewals_ : opens_;
    while (Connection* const next = next_open(renewals)) {
      const std::uint64_t operations = key_operations_of(*next->opening);
      if (!rate.try_spend(operations, now.local)) break;
      open_shares_.serve(host_of(next->source), operations);
      WaitingOpen open = std::move(*next->opening);
      next->opening.reset();
      open_channel(*next, std::move(open), now);
      take_messages(*next, now);
    }
  }
}

/// Of whoever has cost least; of the connections of one account each in its turn. Who does not read is not served.
Connection* Server::next_request() {
  Connection* next = nullptr;
  std::pair<std::uint64_t, std::uint64_t> least;
  for (auto& [id, each] : connections_) {
    if (each.requests.empty() || each.stage != Connection::Stage::open || each.waiting() > most_unread_octets) continue;
    const std::pair order(shares_.spent(each.account), each.served);
    if (next == nullptr || order < least) std::tie(next, least) = std::tuple(&each, order);
  }
  return next;
}

void Server::serve_requests(Now now) {
  const std::uint64_t until = services_.steps() + steps_of_requests;
  while (services_.steps() < until) {
    Connection* const next = next_request();
    if (next == nullptr) return;
    WaitingRequest request = std::move(next->requests.front());
    next->requests.pop_front();
    next->waiting_octets -= request.message.size();
    next->served = ++served_;
    const std::string account = next->account;
    const std::uint64_t before = services_.steps();
    if (request.is_close)
      close(*next);
    else
      serve(*next, std::move(request), now);
    shares_.serve(account, services_.steps() - before + 1);
  }
}

void Server::serve(Connection& connection, WaitingRequest request, Now now) {
  services_.spend(steps_of_request + request.message.size() / octets_of_step);
  dispatch(connection, request.id, request.message, now);
  if (connection.stage != Connection::Stage::closing) count(connection);
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
    connection->output.erase(connection->output.begin(),
                             connection->output.begin() + static_cast<std::ptrdiff_t>(connection->taken));
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
  connection.requests.clear();
  connection.waiting_octets = 0;
  connection.opening.reset();
  connection.held = HeldOctets();
  services_.disconnected(connection.id);
}

void Server::refuse(Connection& connection, StatusCode why, std::string_view what) {
  log_.refused(connection.source, what, short_name_of(why));
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
    if (!connection->channel->seal_message(request_id, encoder.octets(), connection->send, connection->output))
      return drop(*connection, "a client that takes no message of any length");
  }
  if (connection->waiting() > most_output(*connection))
    return drop(*connection, "a client that does not read what it asks for");
  count(*connection);
}

/// What else the service says to this connection goes nowhere, for it has no channel any more.
void Server::drop(Connection& connection, std::string_view what) {
  log_.refused(connection.source, what, "");
  connection.output.clear();
  connection.taken = 0;
  connection.stage = Connection::Stage::closing;
  connection.deadline = now_.local;
  connection.channel.reset();
  connection.requests.clear();
  connection.waiting_octets = 0;
  connection.opening.reset();
  connection.held = HeldOctets();
}

void Server::check_trust(Now now) {
  now_ = now;
  const auto is_trusted = [&](const security::Certificate& certificate) {
    return is_good(check_certificate(certificate, trust_, seconds_since_1970(now.utc)).status);
  };
  for (auto& [id, connection] : connections_) {
    const security::Certificate* const client = connection.channel ? connection.channel->client_certificate() : nullptr;
    if (client != nullptr && !is_trusted(*client))
      refuse(connection, StatusCode::BadSecurityChecksFailed, "a certificate that is trusted no more");
  }
  services_.end_sessions(
      [&](const Session& session) { return session.certificate && !is_trusted(*session.certificate); }, now);
}

void Server::news(const ProgramNews& news, Now now) {
  now_ = now;
  services_.news(news);
}

void Server::advance(Now now) {
  work(now);
  services_.advance(now);
  for (auto& [id, connection] : connections_) {
    if (connection.stage == Connection::Stage::closing) continue;
    if (connection.stage == Connection::Stage::open && services_.has_session(id))
      connection.deadline = now.local + settings_.limits.idle_channel;
    if (connection.deadline <= now.local && !connection.opening)
      refuse(connection, StatusCode::BadTimeout,
             connection.stage == Connection::Stage::open ? "a channel without a session" : "no HEL or no channel");
    else if (connection.channel && connection.channel->ends() <= now.local)
      refuse(connection, StatusCode::BadSecureChannelTokenUnknown, "a channel that was not renewed");
    else if (connection.waiting() > 0 && connection.progress + settings_.limits.output_stall <= now.local)
      refuse(connection, StatusCode::BadTimeout, "a client that does not read");
  }
}

sim::LocalTime Server::next_time() const {
  sim::LocalTime next = services_.next_time();
  for (const auto& [id, connection] : connections_) {
    if (connection.stage == Connection::Stage::closing) continue;  // its host is about to close it
    if (!connection.requests.empty() && connection.waiting() <= most_unread_octets) return now_.local;
    if (connection.opening)
      next =
          std::min(next, (is_renewal(connection) ? renewals_ : opens_).ready(key_operations_of(*connection.opening)));
    else
      next = std::min(next, connection.deadline);
    if (connection.channel) next = std::min(next, connection.channel->ends());
    if (connection.waiting() > 0) next = std::min(next, connection.progress + settings_.limits.output_stall);
  }
  return next;
}

}  // namespace takt::opcua
