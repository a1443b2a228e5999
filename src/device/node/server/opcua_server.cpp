// SPDX-License-Identifier: Apache-2.0
#include "node/server/opcua_server.hpp"

#include <poll.h>
#include <time.h>

#include <algorithm>

#include "node/program_reporter.hpp"
#include "node/server/describe_programs.hpp"
#include "node/server/ordinary_thread.hpp"

namespace takt::node {
namespace {

constexpr std::size_t most_octets_at_once = 65'536;
constexpr std::size_t most_draining = 100;
constexpr Duration drain = opcua::milliseconds(1000);
constexpr Duration look_every = opcua::milliseconds(1000);
constexpr Duration check_trust_every = opcua::milliseconds(30'000);  // certificates expire
constexpr int begin_anew_after_ms = 500;

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
  take(limits.session_grace, set.session_grace);
  take(limits.most_subscription, set.most_subscription);
  take(limits.orphan_subscription, set.orphan_subscription);
  take(limits.session_octets, set.session_octets);
  take(limits.user_octets, set.user_octets);
  take(limits.all_octets, set.all_octets);
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
      endpoints.push_back({policy, mode == ServerMode::sign ? opcua::MessageSecurityMode::Sign
                                                            : opcua::MessageSecurityMode::SignAndEncrypt});
  }
  return endpoints;
}

opcua::StatusCode status_of(program::StatusCode status) { return static_cast<opcua::StatusCode>(status); }

}  // namespace

std::unique_ptr<OpcUaServer> OpcUaServer::make(const LoadedConfig& loaded, std::vector<opcua::User> users,
                                               const std::string& folder, HandOver& hand_over, Notices& notices,
                                               std::string version, std::string& problem) {
  const ServerConfig& config = *loaded.config.server;
  const std::string& node = loaded.config.node;
  const EndpointAddress address = *parse_endpoint(config.endpoint);
  if (!hand_over.is_open()) {
    problem = what_failed("a server");
    return nullptr;
  }
  auto listener = TcpListener::open(address, problem);
  if (!listener) return nullptr;
  std::unique_ptr<OpcUaServer> made(
      new OpcUaServer(config, Pki(pki_folder(loaded.config, {}, folder)), std::move(listener), hand_over, notices));
  if (!made->stop_.is_open()) {
    problem = what_failed("a server");
    return nullptr;
  }
  opcua::ServerSettings& settings = made->settings_;
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

  made->identity_ = own_identity(loaded.config, {}, folder, made->random_, problem);
  if (!made->identity_) return nullptr;
  for (const LoadedGroup& each : loaded.served) made->groups_.push_back(each.keys.group);
  if (!loaded.served.empty())
    made->keys_ = std::make_unique<ServedKeys>(loaded.served, config.key_service->future_keys,
                                               [clock = loaded.config.clock] { return key_time_ns(clock); });
  made->programs_ = describe_programs(loaded);
  made->build();
  return made;
}

OpcUaServer::OpcUaServer(const ServerConfig& config, Pki pki, std::unique_ptr<TcpListener> listener,
                         HandOver& hand_over, Notices& notices)
    : config_(config),
      pki_(std::move(pki)),
      listener_(std::move(listener)),
      hand_over_(hand_over),
      notices_(notices),
      started_ns_(monotonic_ns()),
      buffer_(most_octets_at_once) {}

void OpcUaServer::build() {
  server_ = std::make_unique<opcua::Server>(settings_, *identity_, random_, static_cast<opcua::ProgramHost&>(*this),
                                            static_cast<opcua::ServerLog&>(*this), programs_, now(), keys_.get());
  for (const opcua::ProgramNews& each : known_) server_->news(each, now());
  pki_.has_changed(trust_stamp_);
  take_trust_list();
}

void OpcUaServer::take_trust_list() {
  std::vector<std::string> passed_over;
  opcua::TrustList list = pki_.trust_list(passed_over);
  for (const std::string& each : passed_over) notices_.say("server: not in the trust list: " + each);
  for (const std::string& each : opcua::authorities_without_list(list))
    notices_.say("server: no revocation list of " + cut_text(each) + ": what it has revoked is not known");
  server_->trust(std::move(list));
}

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
    const char* const mode = each.mode == opcua::MessageSecurityMode::None   ? ""
                             : each.mode == opcua::MessageSecurityMode::Sign ? ", Sign"
                                                                             : ", SignAndEncrypt";
    const bool may_call = each.is_encrypted() || config_.calls_without_encryption;
    text += config_.endpoint + " " + std::string(opcua::info(each.policy).name) + mode + ": " +
            (config_.anonymous ? "everybody may read" : "users may read") +
            (!config_.users                    ? ""
             : may_call                        ? ", operators may call"
             : config_.halt_without_encryption ? ", operators may call Halt"
                                               : "") +
            "\n";
  }
  for (const std::string& group : groups_)
    text += config_.endpoint + " encrypted: keys of " + group + " for users with key-access\n";
  return text;
}

bool OpcUaServer::call(std::uint64_t serial, std::size_t program, program::Method method) {
  return hand_over_.call({serial, static_cast<std::uint16_t>(program), method});
}

void OpcUaServer::refused(std::string_view source, std::string_view what, std::string_view detail) {
  if (const auto line = refusals_.take(opcua::host_of(source), std::string(what), cut_text(detail), now().local))
    notices_.say(*line);
}

void OpcUaServer::rejected(std::string_view source, const security::Certificate& certificate) {
  ++state_.rejected;
  pki_.keep_rejected(certificate, opcua::host_of(source));
}

opcua::Now OpcUaServer::now() const {
  return {sim::LocalTime::from_ps((monotonic_ns() - started_ns_) * 1000), utc_now()};
}

/// Whatever fails, the server comes back: its clients must connect anew, the cycle has noticed nothing.
void OpcUaServer::run() {
  become_ordinary();
  while (!is_over_) {
    try {
      if (server_ == nullptr) build();
      serve();
    } catch (const std::exception& failure) {
      begin_anew(failure.what());
    }
  }
}

/// First everything is freed: what fails is memory more often than not.
void OpcUaServer::begin_anew(const std::string& failure) {
  open_.clear();
  server_.reset();
  ++state_.restarts;
  state_.failure = failure;
  try {
    notices_.say("server: it has failed and begins anew: " + failure);
    publish_state(false);
  } catch (const std::bad_alloc&) {  // nothing can be said now; the count can
  }
  pollfd stopped{stop_.file_descriptor(), POLLIN, 0};
  ::poll(&stopped, 1, begin_anew_after_ms);
}

void OpcUaServer::serve() {
  std::vector<pollfd> waiting;
  std::vector<opcua::ConnectionId> whose;
  while (!is_over_) {
    waiting.assign({{stop_.file_descriptor(), POLLIN, 0},
                    {hand_over_.reports_descriptor(), POLLIN, 0},
                    {listener_->file_descriptor(), POLLIN, 0}});
    whose.assign(waiting.size(), 0);
    for (const auto& [id, open] : open_) {
      const bool has_output = !server_->output(id).empty();
      const bool takes = server_->takes_octets(id);
      waiting.push_back({takes || has_output ? open.connection.file_descriptor() : -1,
                         static_cast<short>((takes ? POLLIN : 0) | (has_output ? POLLOUT : 0)), 0});
      whose.push_back(id);
    }
    ::poll(waiting.data(), waiting.size(), wait_ms());
    if (is_over_) return;
    for (std::size_t i = 3; i < waiting.size(); ++i)
      if ((waiting[i].revents & (POLLIN | POLLHUP | POLLERR)) != 0) receive_octets(whose[i], open_.at(whose[i]));
    server_->serve_calls(now());  // before what the cycle reports, and all that follows from it
    if (waiting[1].revents != 0) read_reports();
    if (waiting[2].revents != 0) read_connections();
    server_->advance(now());
    if (now().local - looked_around_ >= look_every) look_around();
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

/// Once a second.
void OpcUaServer::look_around() {
  looked_around_ = now().local;
  const bool is_other = pki_.has_changed(trust_stamp_);
  if (is_other) take_trust_list();
  if (is_other || now().local - trust_checked_ >= check_trust_every) {
    trust_checked_ = now().local;
    server_->check_trust(now());
  }
  while (const auto line = refusals_.due(now().local)) notices_.say(*line);
  notices_.flush();
  publish_state(true);
}

void OpcUaServer::publish_state(bool is_running) {
  state_.is_running = is_running;
  state_.connections = server_ ? server_->connections() : 0;
  state_.sessions = server_ ? server_->services().sessions() : 0;
  state_.subscriptions = server_ ? server_->services().subscriptions() : 0;
  state_.octets = server_ ? server_->services().octets() : 0;
  state_.refused = refusals_.count();
  hand_over_.tell(state_);
}

int OpcUaServer::wait_ms() const {
  sim::LocalTime next = server_->next_time();
  for (const auto& [id, open] : open_)
    if (open.has_ended_sending) next = std::min(next, open.drained_until);
  constexpr std::int64_t most_ms = 1000;  // the trust list is looked at now and then
  if (next == sim::LocalTime::never()) return static_cast<int>(most_ms);
  return static_cast<int>(
      std::clamp<std::int64_t>((next.ps() - now().local.ps() + 999'999'999) / 1'000'000'000, 0, most_ms));
}

void OpcUaServer::read_reports() {
  hand_over_.clear_reports_wake();
  while (const auto report = hand_over_.next_report()) {
    if (report->answered != 0) {
      server_->answered(report->answered, status_of(report->status), now());
    } else {
      keep(report->news);
      server_->news(report->news, now());
    }
  }
  if (const std::uint64_t lost = hand_over_.lost(); lost != lost_told_) {
    lost_told_ = lost;
    notices_.say("server: " + std::to_string(lost) + " reports of the cycle were lost: the server did not keep up");
  }
}

/// What a server that begins anew must know: the last of each kind, in the order in which they came.
void OpcUaServer::keep(const opcua::ProgramNews& news) {
  std::erase_if(known_, [&](const opcua::ProgramNews& each) {
    return each.program == news.program && each.kind == news.kind && each.peer == news.peer;
  });
  known_.push_back(news);
}

void OpcUaServer::read_connections() {
  // Some at a time: whoever connects does not keep those waiting who are there.
  for (int i = 0; i < 16; ++i) {
    auto connection = listener_->accept();
    if (!connection) return;
    const opcua::ConnectionId id = server_->connected(connection->source(), now());
    open_.emplace(id, Open{std::move(*connection), false, {}});
  }
}

void OpcUaServer::receive_octets(opcua::ConnectionId id, Open& open) {
  std::size_t octets = 0;
  switch (open.connection.receive(buffer_, octets)) {
    case TcpConnection::Came::nothing:
      return;
    case TcpConnection::Came::octets:
      if (!server_->is_closing(id)) server_->take_in(id, opcua::Octets(buffer_).first(octets), now());
      return;
    case TcpConnection::Came::end:
      open.has_ended_sending = true;
      open.drained_until = sim::LocalTime();  // nobody is there any more
  }
}

bool OpcUaServer::give_octets(opcua::ConnectionId id, Open& open) {
  // Who is refused in crowds is not waited for: descriptors are few.
  if (open.has_ended_sending)
    return now().local < open.drained_until && open_.size() <= settings_.limits.connections + most_draining;
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
