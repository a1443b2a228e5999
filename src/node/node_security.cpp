#include "node/node_security.hpp"

#include <time.h>

#include <array>

#include "json/record.hpp"

namespace takt::node {
namespace {

using security::SecurityVerdict;

constexpr std::array verdicts = {wire::Verdict::taken, wire::Verdict::not_uadp, wire::Verdict::unsecured, wire::Verdict::security_mode, wire::Verdict::security_header,
                                 wire::Verdict::token, wire::Verdict::truncated, wire::Verdict::signature, wire::Verdict::replayed};
static_assert(verdicts.size() == static_cast<std::size_t>(SecurityVerdict::replayed) + 1);

/// A PublisherId that this node alone has, whatever roles it is given.
std::uint16_t sender_of(const LoadedProgram& program) {
  const wire::ProgramShape& shape = program.endpoint.format->shape();
  const bool is_candidate = program.roles && program.roles->offer;
  return static_cast<std::uint16_t>(shape.first_publisher_id + (is_candidate ? shape.participants.size() + program.roles->offer->number : program.endpoint.handshake.index));
}

}  // namespace

const json::Record& describe(json::Type<SecurityStatus>) {
  static constexpr json::Output outputs[] = {
      json::output<&SecurityStatus::group>("group", "The SecurityGroup."),
      json::output<&SecurityStatus::token>("token", "SecurityTokenId of the key that it sends with; 0: it has sent nothing yet."),
      json::output<&SecurityStatus::life>("life", "Another one at each start; part of every nonce."),
      json::output<&SecurityStatus::unsealed>("unsealed", "Messages that were not sent because there was no key for them."),
  };
  static constexpr json::Record record{"security_status", "The secured messages of a node.", outputs};
  return record;
}

std::unique_ptr<NodeSecurity> NodeSecurity::make(const LoadedConfig& loaded, std::string& problem) {
  const MessageSecurity& security = *loaded.config.security;
  auto memory = SecurityMemory::open(security.memory.value_or(default_memory_path(loaded.config.node)), problem);
  if (!memory) return nullptr;
  const security::ChannelSettings settings{security.mode, security::Nonces::lives, sender_of(loaded.programs.front()), memory->life()};
  const int clock = loaded.config.clock == ClockName::tai ? CLOCK_TAI : CLOCK_REALTIME;  // keys outlive the machine's start
  return std::unique_ptr<NodeSecurity>(new NodeSecurity(*loaded.keys, security.key_lifetime, settings, std::move(memory), clock));
}

NodeSecurity::NodeSecurity(const LoadedKeys& keys, sim::Duration lifetime, const security::ChannelSettings& settings, std::unique_ptr<SecurityMemory> memory, int clock)
    : group_(keys.group), memory_(std::move(memory)), clock_(clock), channel_(settings, keys.ring(lifetime), memory_->windows()) {}

std::int64_t NodeSecurity::now_ns() const {
  timespec time = {};
  ::clock_gettime(clock_, &time);
  return static_cast<std::int64_t>(time.tv_sec) * 1'000'000'000 + time.tv_nsec;
}

auto NodeSecurity::open(uadp::Octets message) -> Opened {
  const security::Opened opened = channel_.open(message, now_ns());
  return {verdicts[static_cast<std::size_t>(opened.verdict)], opened.clear};
}

SecurityStatus NodeSecurity::status() const { return {group_, channel_.token(), channel_.unsealed(), channel_.settings().life}; }

}  // namespace takt::node
