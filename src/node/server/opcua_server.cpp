#include "node/server/opcua_server.hpp"

#include <poll.h>
#include <time.h>

#include <algorithm>
#include <cstdio>

#include "node/program_reporter.hpp"
#include "node/server/describe_programs.hpp"
#include "node/server/ordinary_thread.hpp"

namespace takt::node {
namespace {

constexpr std::size_t most_octets_at_once = 65'536;
constexpr std::size_t most_told = 256;
constexpr Duration drain = opcua::milliseconds(1000);
constexpr Duration trust_check = opcua::milliseconds(1000);

std::int64_t monotonic_ns() {
  timespec time = {};
  ::clock_gettime(CLOCK_MONOTONIC, &time);
  return static_cast<std::int64_t>(time.tv_sec) * 1'000'000'000 + time.tv_nsec;
}

/// The library's limits with those that the file sets.
opcua::Limits limits_of(const ServerLimits& set) {
  opcua::Limits limits;
  const auto take = [](auto& limit, const auto& value) {
    if (value) limit = static_cast<std::decay_t<decltype(limit)>>(*value);
  };
  take(limits.connections, set.connections);
  take(limits.chunk_octets, set.chunk_octets);
  take(limits.message_octets, set.request_octets);
  take(limits.message_chunks, set.request_chunks);
  take(limits.output_octets, set.output_octets);
  if (set.channels_per_second) limits.private_key_operations = std::size_t{*set.channels_per_second} * 8;
  take(limits.sessions, set.sessions);
  take(limits.subscriptions, set.subscriptions);
  take(limits.subscriptions_of_session, set.subscriptions_of_session);
  take(limits.items, set.items);
  take(limits.queue, set.queue);
  take(limits.event_queue, set.event_queue);
  take(limits.publish_requests, set.publish_requests);
  take(limits.operations, set.operations);
  take(limits.hello_within, set.hello_within);
  take(limits.idle_channel, set.idle_channel);
  take(limits.output_stall, set.output_stall);
  take(limits.call_within, set.call_within);
  take(limits.least_session, set.least_session);
  take(limits.most_session, set.most_session);
  take(limits.tokens.least, set.least_token);
  take(limits.tokens.most, set.most_token);
  take(limits.least_publishing, set.least_publishing);
  return limits;
}

std::vector<opcua::ChannelSecurity> endpoints_of(const ServerConfig& config) {
  std::vector<opcua::ChannelSecurity> endpoints;
  for (const ServerPolicy each : config.policies) {
    const auto policy = static_cast<opcua::SecurityPolicy>(each);
    if (!opcua::is_secured(policy)) {
      endpoints.push_back({policy, opcua::MessageSecurityMode::None});
      continue;
    }
    for (const ServerMode mode : config.modes)
      endpoints.push_back({policy, mode == ServerMode::sign ? opcua::MessageSecurityMode::Sign : opcua::MessageSecurityMode::SignAndEncrypt});
  }
  return endpoints;
}

opcua::StatusCode status_of(program::StatusCode status) { return static_cast<opcua::StatusCode>(status); }

}  // namespace

std::unique_ptr<OpcUaServer> OpcUaServer::make(const LoadedConfig& loaded, std::vector<opcua::User> users, const std::string& folder, HandOver& hand_over, std::string version, std::string& problem) {
  const ServerConfig& config = *loaded.config.server;
  const std::string& node = loaded.config.node;
  const EndpointAddress address = *parse_endpoint(config.endpoint);
  if (!hand_over.is_open()) {
    problem = what_failed("a server");
    return nullptr;
  }
  auto listener = TcpListener::open(address, problem);
  if (!listener) return nullptr;
  std::unique_ptr<OpcUaServer> made(new OpcUaServer(config, Pki(pki_folder(loaded.config, {}, folder)), std::move(listener), hand_over));
  if (!made->stop_.is_open()) {
    problem = what_failed("a server");
    return nullptr;
  }
  opcua::ServerSettings settings;
  settings.application_uri = application_uri_of(loaded.config);
  settings.application_name = "takt node " + node;
  settings.software_version = std::move(version);
  settings.endpoint_url = config.endpoint;
  settings.endpoints = endpoints_of(config);
  settings.anonymous = config.anonymous;
  settings.users = std::move(users);
  settings.calls_without_encryption = config.calls_without_encryption;
  settings.halt_without_encryption = config.halt_without_encryption;
  settings.limits = limits_of(config.limits.value_or(ServerLimits()));

  auto identity = own_identity(loaded.config, {}, folder, made->random_, problem);
  if (!identity) return nullptr;
  for (const LoadedGroup& each : loaded.served) made->groups_.push_back(each.keys.group);
  if (!loaded.served.empty())
    made->keys_ = std::make_unique<ServedKeys>(loaded.served, config.key_service->future_keys, [clock = loaded.config.clock] { return key_time_ns(clock); });
  opcua::ProgramHost& host = *made;
  opcua::ServerLog& log = *made;
  made->server_ = std::make_unique<opcua::Server>(std::move(settings), std::move(*identity), made->random_, host, log, describe_programs(loaded), made->now(), made->keys_.get());
  made->pki_.has_changed(made->trust_stamp_);
  made->server_->trust(made->pki_.trust_list());
  return made;
}

OpcUaServer::OpcUaServer(const ServerConfig& config, Pki pki, std::unique_ptr<TcpListener> listener, HandOver& hand_over)
    : config_(config), pki_(std::move(pki)), listener_(std::move(listener)), hand_over_(hand_over), started_ns_(monotonic_ns()), buffer_(most_octets_at_once) {}

OpcUaServer::~OpcUaServer() {
  is_over_ = true;
  stop_.signal();
}

void OpcUaServer::start() {
  threads_.start([this] { run(); });
}

void OpcUaServer::stop() {
  is_over_ = true;
  stop_.signal();
  threads_.join();
}

std::string OpcUaServer::text() const {
  std::string text;
  for (const opcua::ChannelSecurity& each : endpoints_of(config_)) {
    const char* const mode = each.mode == opcua::MessageSecurityMode::None ? "" : each.mode == opcua::MessageSecurityMode::Sign ? ", Sign" : ", SignAndEncrypt";
    const bool may_call = each.is_encrypted() || config_.calls_without_encryption;
    text += config_.endpoint + " " + std::string(opcua::info(each.policy).name) + mode + ": " + (config_.anonymous ? "everybody may read" : "users may read") +
            (!config_.users ? "" : may_call ? ", operators may call" : config_.halt_without_encryption ? ", operators may call Halt" : "") + "\n";
  }
  for (const std::string& group : groups_) text += config_.endpoint + " encrypted: keys of " + group + " for users with key-access\n";
  return text;
}

bool OpcUaServer::call(std::uint64_t serial, std::size_t program, program::Method method) { return hand_over_.call({serial, static_cast<std::uint16_t>(program), method}); }

/// Once of a host and a reason: who is refused again and again fills no log.
void OpcUaServer::refused(std::string_view source, std::string_view what) {
  const std::string host(source.substr(0, source.rfind(':')));
  if (told_.size() > most_told || !told_.insert(host + " " + std::string(what)).second) return;
  if (told_.size() > most_told)
    std::fprintf(stderr, "takt: server: no more is said of what is refused\n");
  else
    std::fprintf(stderr, "takt: server: refused from %s: %.*s\n", host.c_str(), static_cast<int>(what.size()), what.data());
}

void OpcUaServer::rejected(const security::Certificate& certificate) { pki_.keep_rejected(certificate); }

opcua::Now OpcUaServer::now() const { return {sim::LocalTime::from_ps((monotonic_ns() - started_ns_) * 1000), utc_now()}; }

void OpcUaServer::run() {
  become_ordinary();
  std::vector<pollfd> waiting;
  std::vector<opcua::ConnectionId> whose;
  while (!is_over_) {
    waiting.assign({{stop_.file_descriptor(), POLLIN, 0}, {hand_over_.reports_descriptor(), POLLIN, 0}, {listener_->file_descriptor(), POLLIN, 0}});
    whose.assign(waiting.size(), 0);
    for (const auto& [id, open] : open_) {
      const bool has_output = !server_->output(id).empty();
      waiting.push_back({open.connection.file_descriptor(), static_cast<short>(POLLIN | (has_output ? POLLOUT : 0)), 0});
      whose.push_back(id);
    }
    ::poll(waiting.data(), waiting.size(), wait_ms());
    if (is_over_) return;
    if (waiting[1].revents != 0) take_reports();
    for (std::size_t i = 3; i < waiting.size(); ++i)
      if ((waiting[i].revents & (POLLIN | POLLHUP | POLLERR)) != 0) take_octets(whose[i], open_.at(whose[i]));
    if (waiting[2].revents != 0) take_connections();
    server_->advance(now());
    if (now().local - trust_checked_ >= trust_check) {
      trust_checked_ = now().local;
      if (pki_.has_changed(trust_stamp_)) server_->trust(pki_.trust_list());
    }
    for (auto at = open_.begin(); at != open_.end();) {
      if (give_octets(at->first, at->second)) {
        ++at;
        continue;
      }
      server_->disconnected(at->first);
      at = open_.erase(at);
    }
  }
}

int OpcUaServer::wait_ms() const {
  sim::LocalTime next = server_->next_time();
  for (const auto& [id, open] : open_)
    if (open.has_ended_sending) next = std::min(next, open.drained_until);
  constexpr std::int64_t most_ms = 1000;  // the trust list is looked at now and then
  if (next == sim::LocalTime::never()) return static_cast<int>(most_ms);
  return static_cast<int>(std::clamp<std::int64_t>((next.ps() - now().local.ps() + 999'999'999) / 1'000'000'000, 0, most_ms));
}

void OpcUaServer::take_reports() {
  hand_over_.clear_reports_wake();
  while (const auto report = hand_over_.next_report()) {
    if (report->answered != 0)
      server_->answered(report->answered, status_of(report->status), now());
    else
      server_->news(report->news, now());
  }
  if (const std::uint64_t lost = hand_over_.lost(); lost != lost_told_) {
    lost_told_ = lost;
    std::fprintf(stderr, "takt: server: %llu reports of the cycle were lost: the server did not keep up\n", static_cast<unsigned long long>(lost));
  }
}

void OpcUaServer::take_connections() {
  // Some at a time: whoever connects does not keep those waiting who are there.
  for (int i = 0; i < 16; ++i) {
    auto connection = listener_->accept();
    if (!connection) return;
    const opcua::ConnectionId id = server_->connected(connection->source(), now());
    open_.emplace(id, Open{std::move(*connection), false, {}});
  }
}

void OpcUaServer::take_octets(opcua::ConnectionId id, Open& open) {
  std::size_t octets = 0;
  switch (open.connection.receive(buffer_, octets)) {
    case TcpConnection::Came::nothing: return;
    case TcpConnection::Came::octets:
      if (!server_->is_closing(id)) server_->received(id, opcua::Octets(buffer_).first(octets), now());
      return;
    case TcpConnection::Came::end:
      open.has_ended_sending = true;
      open.drained_until = sim::LocalTime();  // nobody is there any more
  }
}

bool OpcUaServer::give_octets(opcua::ConnectionId id, Open& open) {
  if (open.has_ended_sending) return now().local < open.drained_until;
  while (!server_->output(id).empty()) {
    const auto sent = open.connection.send(server_->output(id));
    if (!sent) return false;
    if (*sent == 0) break;
    server_->sent(id, *sent, now());
  }
  if (!server_->is_closing(id) || !server_->output(id).empty()) return !server_->is_stuck(id, now());
  open.connection.end_sending();
  open.has_ended_sending = true;
  open.drained_until = now().local + drain;
  return true;
}

}  // namespace takt::node
