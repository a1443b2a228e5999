// SPDX-License-Identifier: Apache-2.0
#include "node/server/key_puller.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <time.h>

#include <algorithm>
#include <system_error>

#include "node/program_reporter.hpp"
#include "node/server/ordinary_thread.hpp"
#include "opcua/services/security_keys.hpp"

namespace takt::node {
namespace {

constexpr std::size_t most_octets_of_answer = 65'536;
constexpr std::int64_t longest_lookup_ns = 10'000'000'000;
constexpr std::int64_t last_key_goes_on_for = 2;  // lifetimes, as security::KeyRing has it
constexpr int most_wait_ms = 1000;

std::int64_t boot_ns() {
  timespec time = {};
  ::clock_gettime(CLOCK_BOOTTIME, &time);
  return static_cast<std::int64_t>(time.tv_sec) * 1'000'000'000 + time.tv_nsec;
}

opcua::Now now() { return {sim::LocalTime::from_ps(boot_ns() * 1000), utc_now()}; }

std::uint8_t chance_of(security::RandomOctets& random) {
  std::array<std::byte, 1> octet{};
  random.fill(octet);
  return std::to_integer<std::uint8_t>(octet[0]);
}

}  // namespace

std::unique_ptr<KeyPuller> KeyPuller::make(const LoadedConfig& loaded, const std::string& folder, KeyMailbox& mailbox,
                                           Notices& notices, std::string& problem) {
  const KeyServiceAccess& access = *loaded.config.security->key_service;
  security::SystemRandom random;
  auto identity = own_identity(loaded.config, access.pki, folder, random, problem);
  if (!identity) return nullptr;
  std::unique_ptr<KeyPuller> made(new KeyPuller(loaded, std::move(*identity), mailbox, notices));
  if (made->stop_.is_open() && mailbox.is_open()) return made;
  problem = what_failed("keys of a key service");
  return nullptr;
}

KeyPuller::KeyPuller(const LoadedConfig& loaded, opcua::Identity identity, KeyMailbox& mailbox, Notices& notices)
    : access_(*loaded.key_access),
      endpoint_(loaded.config.security->key_service->endpoint),
      identity_(std::move(identity)),
      mailbox_(mailbox),
      notices_(notices),
      keys_(loaded.config.security->policy),
      buffer_(most_octets_of_answer) {
  settings_.endpoint_url = endpoint_;
  settings_.application_uri = identity_.certificate.application_uri();
  settings_.application_name = "takt node " + loaded.config.node;
  settings_.user = loaded.config.security->key_service->user;
  settings_.password = access_.password;
  state_.endpoint = endpoint_;
  mailbox_.tell(std::make_unique<KeyServiceState>(state_));
}

KeyPuller::~KeyPuller() {
  is_over_ = true;
  stop_.signal();
}

void KeyPuller::start() {
  threads_.start([this] { run(); });
}

void KeyPuller::stop() {
  is_over_ = true;
  stop_.signal();
  threads_.join();
}

void KeyPuller::run() {
  become_ordinary();
  while (!is_over_) {
    const bool is_wished = plan_.is_wished();
    mailbox_.clear_wishes();
    const std::string problem = pull();
    if (is_over_) return;
    state_.pulls += 1;
    state_.wished += is_wished ? 1 : 0;
    state_.failures += problem.empty() ? 0 : 1;
    state_.problem = problem.empty() ? std::nullopt : std::optional(problem);
    mailbox_.tell(std::make_unique<KeyServiceState>(state_));
    tell(problem);
    if (problem.empty()) {
      mailbox_.clear_wishes();  // of what was heard before the cycle had them
      plan_.gave(boot_ns(), keys_.next_pull_ns(boot_ns()), keys_.has_news());
    } else {
      plan_.failed(boot_ns(), chance_of(random_));
    }
    wait();
  }
}

/// Wishes wake it only when they count, so that a flood of messages with keys that nobody has costs nothing here.
void KeyPuller::wait() {
  while (!is_over_) {
    log_if_none_are_left();
    notices_.flush();
    const std::int64_t now_ns = boot_ns();
    const bool hears_wishes = now_ns >= plan_.wishes_from_ns();
    const std::int64_t until_ns = hears_wishes ? plan_.next_ns() : std::min(plan_.next_ns(), plan_.wishes_from_ns());
    if (plan_.next_ns() <= now_ns) return;
    const std::int64_t left_ms = (until_ns - now_ns + 999'999) / 1'000'000;
    pollfd waiting[] = {{stop_.file_descriptor(), POLLIN, 0},
                        {hears_wishes ? mailbox_.wishes_descriptor() : -1, POLLIN, 0}};
    ::poll(waiting, 2, static_cast<int>(std::clamp<std::int64_t>(left_ms, 0, most_wait_ms)));
    if (waiting[1].revents != 0) plan_.wished(boot_ns());
  }
}

/// Where a name has several addresses, the first one that can be reached counts.
std::string KeyPuller::pull() {
  std::string problem;
  for (const std::string& each : addresses(problem)) {
    problem = pull_from({each, access_.address.port});
    if (problem.empty() || is_over_) return problem;
  }
  return problem;
}

std::vector<std::string> KeyPuller::addresses(std::string& problem) {
  const std::string& name = access_.address.address;
  if (is_ipv4_address(name)) return {name};
  try {
    if (!lookup_) lookup_.emplace(name);  // or one that began before, and is not done
  } catch (const std::system_error& error) {
    problem = "no address of " + name + ": " + error.code().message();
    return {};
  }
  const std::int64_t until_ns = boot_ns() + longest_lookup_ns;
  while (!lookup_->is_done()) {
    const std::int64_t left_ms = (until_ns - boot_ns()) / 1'000'000;
    if (is_over_ || left_ms <= 0) {
      problem = "no address of " + name + ": no answer of the resolver within 10 s";
      return {};
    }
    pollfd waiting[] = {{stop_.file_descriptor(), POLLIN, 0}, {lookup_->file_descriptor(), POLLIN, 0}};
    ::poll(waiting, 2, static_cast<int>(std::min<std::int64_t>(left_ms, most_wait_ms)));
  }
  std::vector<std::string> found = lookup_->addresses();
  problem = lookup_->problem();
  lookup_.reset();
  return found;
}

std::string KeyPuller::pull_from(const EndpointAddress& address) {
  std::string problem;
  auto connection = TcpConnection::connect(address, problem);
  if (!connection) return problem;
  opcua::SecurityKeysRequest request;
  request.group = opcua::Text(access_.group);
  request.count = security::PulledKeys::future_keys;
  opcua::CallClient client(settings_, identity_, access_.certificate, random_, opcua::call_of(request), now());
  problem = connected_call(*connection, client);
  if (problem.empty()) problem = take(client.result());
  if (!problem.empty()) return problem;
  state_.answered_by = connection->source();
  state_.answered_ns = boot_ns();
  return "";
}

/// Neither side waits for the other for ever: the client has a deadline.
std::string KeyPuller::connected_call(TcpConnection& connection, opcua::CallClient& client) {
  while (!is_over_) {
    while (!client.output().empty()) {
      const auto sent = connection.send(client.output());
      if (!sent && !client.is_over()) return connection.problem();
      if (!sent || *sent == 0) break;
      client.sent(*sent);
    }
    if (client.is_over()) break;
    const auto left_ms = (client.deadline() - now().local).ps() / 1'000'000'000 + 1;
    pollfd waiting[] = {
        {stop_.file_descriptor(), POLLIN, 0},
        {connection.file_descriptor(), static_cast<short>(POLLIN | (client.output().empty() ? 0 : POLLOUT)), 0}};
    ::poll(waiting, 2, static_cast<int>(std::clamp<std::int64_t>(left_ms, 0, most_wait_ms)));
    if ((waiting[1].revents & (POLLERR | POLLHUP)) != 0 && (waiting[1].revents & POLLIN) == 0)
      return connection.problem();
    if ((waiting[1].revents & POLLIN) != 0) {
      std::size_t octets = 0;
      const TcpConnection::Came came = connection.receive(buffer_, octets);
      if (came == TcpConnection::Came::octets) client.received(security::Octets(buffer_).first(octets), now());
      if (came == TcpConnection::Came::end) client.ended();
    }
    client.advance(now());
  }
  return client.problem();
}

std::string KeyPuller::take(const opcua::CallMethodResult& result) {
  if (!opcua::is_good(result.status_code))
    return fmt::format("it gives no keys of {} to {}: {}", access_.group, settings_.user,
                       opcua::short_name_of(result.status_code));
  auto answer = opcua::keys_in(result);
  if (!answer) return "what it gives is not what GetSecurityKeys gives";
  const security::GivenKeys given{std::move(answer->policy_uri.value), answer->first_token, std::move(answer->keys),
                                  answer->time_to_next_ms, answer->lifetime_ms};
  if (const std::string problem = keys_.take(given, boot_ns()); !problem.empty()) return "it gives " + problem;
  state_.schedule = keys_.schedule();
  state_.keys = keys_.size();
  mailbox_.give(std::make_unique<KeyDelivery>(KeyDelivery{keys_.schedule(), keys_.source()}));
  return "";
}

/// What goes on as before is not told again.
void KeyPuller::tell(const std::string& problem) {
  if (problem.empty()) {
    if (!has_told_keys_ || !told_.empty())
      notices_.say(fmt::format("keys of {}: pulled from {}", access_.group, endpoint_));
    has_told_keys_ = true;
    has_told_none_ = false;
  } else if (problem != told_) {
    const std::string until = keys_.is_empty()
                                  ? "nothing is sent without keys"
                                  : fmt::format("those that are there last for {} s",
                                                std::max<std::int64_t>(keys_.ends_ns() - boot_ns(), 0) / 1'000'000'000);
    notices_.say(fmt::format("keys of {}: {}: {}; {}", access_.group, endpoint_, problem, until));
  }
  told_ = problem;
}

void KeyPuller::log_if_none_are_left() {
  if (has_told_none_ || keys_.is_empty() ||
      boot_ns() < keys_.ends_ns() + last_key_goes_on_for * keys_.schedule().lifetime_ns)
    return;
  has_told_none_ = true;
  notices_.say(fmt::format("keys of {}: the last one has ended; nothing is sent without keys", access_.group));
}

}  // namespace takt::node
