#include "node/server/key_puller.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <time.h>

#include <algorithm>
#include <cstdio>
#include <limits>

#include "node/program_reporter.hpp"
#include "node/server/ordinary_thread.hpp"
#include "opcua/services/security_keys.hpp"

namespace takt::node {
namespace {

constexpr std::size_t most_octets_of_answer = 65'536;
constexpr std::int64_t least_back_off_ns = 500'000'000;
constexpr std::int64_t most_back_off_ns = 30'000'000'000;
constexpr std::int64_t last_key_goes_on_for = 2;  // lifetimes, as security::KeyRing has it
constexpr int most_wait_ms = 1000;

std::int64_t boot_ns() {
  timespec time = {};
  ::clock_gettime(CLOCK_BOOTTIME, &time);
  return static_cast<std::int64_t>(time.tv_sec) * 1'000'000'000 + time.tv_nsec;
}

opcua::Now now() { return {sim::LocalTime::from_ps(boot_ns() * 1000), utc_now()}; }

/// From half a second on twice as long each time, up to half a minute; nodes that have lost their service together come back one by one.
std::int64_t back_off_ns(unsigned failures, security::RandomOctets& random) {
  const std::int64_t most = std::min(least_back_off_ns << std::min(failures, 10U), most_back_off_ns);
  std::array<std::byte, 1> chance{};
  random.fill(chance);
  return most / 2 + most / 2 * std::to_integer<std::int64_t>(chance[0]) / 256;
}

}  // namespace

std::unique_ptr<KeyPuller> KeyPuller::make(const LoadedConfig& loaded, const std::string& folder, KeyMailbox& mailbox, std::string& problem) {
  const KeyServiceAccess& access = *loaded.config.security->key_service;
  security::SystemRandom random;
  auto identity = own_identity(loaded.config, access.pki, folder, random, problem);
  if (!identity) return nullptr;
  std::unique_ptr<KeyPuller> made(new KeyPuller(loaded, std::move(*identity), mailbox));
  if (made->stop_.is_open()) return made;
  problem = what_failed("keys of a key service");
  return nullptr;
}

KeyPuller::KeyPuller(const LoadedConfig& loaded, opcua::Identity identity, KeyMailbox& mailbox)
    : access_(*loaded.key_access), endpoint_(loaded.config.security->key_service->endpoint), identity_(std::move(identity)), mailbox_(mailbox), keys_(loaded.config.security->policy),
      buffer_(most_octets_of_answer) {
  settings_.endpoint_url = endpoint_;
  settings_.application_uri = identity_.certificate.application_uri();
  settings_.application_name = "takt node " + loaded.config.node;
  settings_.user = loaded.config.security->key_service->user;
  settings_.password = access_.password;
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
  unsigned failures = 0;
  while (!is_over_) {
    const std::string problem = pull();
    if (is_over_) return;
    tell(problem);
    failures = problem.empty() ? 0 : failures + 1;
    wait_until(problem.empty() ? keys_.next_pull_ns(boot_ns()) : boot_ns() + back_off_ns(failures - 1, random_));
  }
}

void KeyPuller::wait_until(std::int64_t until_ns) {
  while (!is_over_) {
    tell_if_none_are_left();
    const std::int64_t left_ms = (until_ns - boot_ns() + 999'999) / 1'000'000;
    if (left_ms <= 0) return;
    pollfd waiting = {stop_.file_descriptor(), POLLIN, 0};
    ::poll(&waiting, 1, static_cast<int>(std::min<std::int64_t>(left_ms, most_wait_ms)));
  }
}

std::string KeyPuller::pull() {
  std::string problem;
  auto connection = TcpConnection::connect(access_.address, problem);
  if (!connection) return problem;
  opcua::SecurityKeysRequest request;
  request.group = opcua::Text(access_.group);
  request.count = security::PulledKeys::future_keys;
  opcua::CallClient client(settings_, identity_, access_.certificate, random_, opcua::call_of(request), now());
  problem = connected_call(*connection, client);
  return problem.empty() ? take(client.result()) : problem;
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
    pollfd waiting[] = {{stop_.file_descriptor(), POLLIN, 0}, {connection.file_descriptor(), static_cast<short>(POLLIN | (client.output().empty() ? 0 : POLLOUT)), 0}};
    ::poll(waiting, 2, static_cast<int>(std::clamp<std::int64_t>(left_ms, 0, most_wait_ms)));
    if ((waiting[1].revents & (POLLERR | POLLHUP)) != 0 && (waiting[1].revents & POLLIN) == 0) return connection.problem();
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
  if (!opcua::is_good(result.status_code)) return fmt::format("it gives no keys of {} to {}: {}", access_.group, settings_.user, opcua::short_name_of(result.status_code));
  auto answer = opcua::keys_in(result);
  if (!answer) return "what it gives is not what GetSecurityKeys gives";
  const security::GivenKeys given{std::move(answer->policy_uri.value), answer->first_token, std::move(answer->keys), answer->time_to_next_ms, answer->lifetime_ms};
  if (const std::string problem = keys_.take(given, boot_ns()); !problem.empty()) return "it gives " + problem;
  mailbox_.give(std::make_unique<KeyDelivery>(KeyDelivery{keys_.schedule(), keys_.source()}));
  return "";
}

/// What goes on as before is not told again.
void KeyPuller::tell(const std::string& problem) {
  if (problem.empty()) {
    if (!has_told_keys_ || !told_.empty()) std::fprintf(stderr, "takt: keys of %s: pulled from %s\n", access_.group.c_str(), endpoint_.c_str());
    has_told_keys_ = true;
    has_told_none_ = false;
  } else if (problem != told_) {
    const std::string until = keys_.is_empty() ? "nothing is sent without keys" : fmt::format("those that are there last for {} s", std::max<std::int64_t>(keys_.ends_ns() - boot_ns(), 0) / 1'000'000'000);
    std::fprintf(stderr, "takt: keys of %s: %s: %s; %s\n", access_.group.c_str(), endpoint_.c_str(), problem.c_str(), until.c_str());
  }
  told_ = problem;
}

void KeyPuller::tell_if_none_are_left() {
  if (has_told_none_ || keys_.is_empty() || boot_ns() < keys_.ends_ns() + last_key_goes_on_for * keys_.schedule().lifetime_ns) return;
  has_told_none_ = true;
  std::fprintf(stderr, "takt: keys of %s: the last one has ended; nothing is sent without keys\n", access_.group.c_str());
}

}  // namespace takt::node
