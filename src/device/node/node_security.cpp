// SPDX-License-Identifier: Apache-2.0
#include "node/node_security.hpp"

#include <time.h>

#include <array>
#include <limits>

#include "json/record.hpp"

namespace takt::node {
namespace {

using security::SecurityVerdict;

constexpr std::array verdicts = {wire::Verdict::taken,         wire::Verdict::not_uadp,        wire::Verdict::unsecured,
                                 wire::Verdict::security_mode, wire::Verdict::security_header, wire::Verdict::token,
                                 wire::Verdict::truncated,     wire::Verdict::signature,       wire::Verdict::replayed};
static_assert(verdicts.size() == static_cast<std::size_t>(SecurityVerdict::replayed) + 1);

/// A PublisherId that this node alone has, whatever roles it is given.
std::uint16_t sender_of(const LoadedProgram& program) {
  const wire::ProgramShape& shape = program.endpoint.format->shape();
  const bool is_candidate = program.roles && program.roles->offer;
  return static_cast<std::uint16_t>(
      shape.first_publisher_id +
      (is_candidate ? shape.participants.size() + program.roles->offer->number : program.endpoint.handshake.index));
}

/// Until some have come: nothing is sent, and nothing taken.
security::KeyRing no_keys(security::MessagePolicy policy) {
  return {policy,
          {1, std::numeric_limits<std::int64_t>::max(), 0},
          std::make_unique<security::ListedKeys>(1, std::vector<security::Secret>())};
}

}  // namespace

namespace {

bool pulls_keys(const SecurityStatus& status) { return status.key_service.has_value(); }
const KeyServiceStatus& key_service_of(const SecurityStatus& status) { return *status.key_service; }

}  // namespace

const json::Record& describe(json::Type<SecurityStatus>) {
  static constexpr json::Output outputs[] = {
      json::output<&SecurityStatus::group>("group", "The SecurityGroup."),
      json::output<&SecurityStatus::token>(
          "token", "SecurityTokenId of the key that it sends with; 0: it has sent nothing yet."),
      json::output<&SecurityStatus::life>("life", "Another one at each start; part of every nonce."),
      json::output<&SecurityStatus::clock_returns>(
          "clock_returns",
          "How often its clock was ahead by more than a key, and came back: each time it began another life."),
      json::output<&SecurityStatus::unsealed>("unsealed",
                                              "Messages that were not sent because there was no key for them."),
      json::only_if<&pulls_keys>(json::output<&key_service_of>("key_service", "Where its keys come from."),
                                 "of a node that pulls its keys"),
  };
  static constexpr json::Record record{"security_status", "The secured messages of a node.", outputs};
  return record;
}

std::unique_ptr<NodeSecurity> NodeSecurity::make(const LoadedConfig& loaded, KeyMailbox* mailbox,
                                                 std::string& problem) {
  const MessageSecurity& security = *loaded.config.security;
  auto memory = SecurityMemory::open(security.memory.value_or(default_memory_path(loaded.config.node)),
                                     security.key_lifetime, problem);
  if (!memory) return nullptr;
  const std::uint16_t sender = loaded.programs.empty() ? loaded.sender : sender_of(loaded.programs.front());
  const security::ChannelSettings settings{security.mode, security.nonces, sender, memory->life()};
  if (loaded.key_access)
    return std::unique_ptr<NodeSecurity>(new NodeSecurity(loaded.key_access->group, no_keys(security.policy), settings,
                                                          std::move(memory), CLOCK_BOOTTIME, mailbox));
  const int clock =
      loaded.config.clock == ClockName::tai ? CLOCK_TAI : CLOCK_REALTIME;  // keys outlive the machine's start
  return std::unique_ptr<NodeSecurity>(new NodeSecurity(loaded.keys->group, loaded.keys->ring(security.key_lifetime),
                                                        settings, std::move(memory), clock, nullptr));
}

NodeSecurity::NodeSecurity(std::string group, security::KeyRing keys, const security::ChannelSettings& settings,
                           std::unique_ptr<SecurityMemory> memory, int clock, KeyMailbox* mailbox)
    : group_(std::move(group)),
      memory_(std::move(memory)),
      clock_(clock),
      mailbox_(mailbox),
      channel_(settings, std::move(keys), memory_->windows()) {}

/// Once in half a lifetime there are some.
void NodeSecurity::install_keys() {
  if (mailbox_ == nullptr) return;
  if (auto delivery = mailbox_->take()) channel_.keys().replace(delivery->schedule, std::move(delivery->source));
}

std::int64_t NodeSecurity::now_ns() const {
  timespec time = {};
  ::clock_gettime(clock_, &time);
  return static_cast<std::int64_t>(time.tv_sec) * 1'000'000'000 + time.tv_nsec;
}

std::int64_t NodeSecurity::look_at_clock() {
  const std::int64_t now = now_ns();
  if (mailbox_ == nullptr && channel_.keys().was_ahead(now)) {
    channel_.begin_anew(memory_->begin_life(), now);
    ++clock_returns_;
  }
  return now;
}

auto NodeSecurity::open(uadp::Octets message) -> Opened {
  install_keys();
  const security::Opened opened = channel_.open(message, look_at_clock());
  if (opened.wants_keys && mailbox_ != nullptr) mailbox_->wish();
  return {verdicts[static_cast<std::size_t>(opened.verdict)], opened.clear};
}

SecurityStatus NodeSecurity::status() {
  SecurityStatus status{group_, channel_.token(), channel_.unsealed(), channel_.settings().life, clock_returns_};
  if (mailbox_ == nullptr) return status;
  if (auto state = mailbox_->state()) key_service_ = std::move(*state);
  status.key_service = status_of(key_service_, now_ns());
  return status;
}

}  // namespace takt::node
