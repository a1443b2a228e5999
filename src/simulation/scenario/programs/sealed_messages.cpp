// SPDX-License-Identifier: Apache-2.0
#include "scenario/programs/sealed_messages.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include "sim/check.hpp"

namespace takt::scenario {
namespace {

constexpr std::size_t secret_octets = 32;
constexpr std::int64_t any_time = 0;  // the key lasts for ever

}  // namespace

SealedMessages::SealedMessages(const plant::ProgramSecurity& security, std::string group, std::uint16_t sender,
                               std::size_t streams)
    : security_(security), group_(std::move(group)), sender_(sender), windows_(std::max<std::size_t>(64, 2 * streams)) {
  begin_life();
}

void SealedMessages::begin_life() {
  auto source = std::make_unique<security::DerivedKeys>(security_.policy, group_, security::Secret(secret_octets));
  channel_.emplace(security::ChannelSettings{security_.mode, security::Nonces::lives, sender_, life_},
                   security::KeyRing(security_.policy, security::KeySchedule{1, 0, 0}, std::move(source)),
                   security::ReplayMemory(windows_));
}

void SealedMessages::restart() {
  ++life_;
  begin_life();
}

security::Octets SealedMessages::seal(security::Octets clear) {
  const security::Octets sealed = channel_->seal(clear, any_time);
  TAKT_CHECK(sealed.size() == clear.size() + security::added_octets(security_.mode),
             "a message of a Program is sealed, and as long as its stream says");
  return sealed;
}

std::optional<security::Octets> SealedMessages::open(security::Octets sealed) {
  const security::Opened opened = channel_->open(sealed, any_time);
  return opened.verdict == security::SecurityVerdict::good ? std::optional(opened.clear) : std::nullopt;
}

}  // namespace takt::scenario
