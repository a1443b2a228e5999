// SPDX-License-Identifier: Apache-2.0
#include "security/key_ring.hpp"

#include <algorithm>

namespace takt::security {
namespace {

constexpr std::uint64_t tokens = 0xFFFF'FFFF;  // without 0
constexpr std::uint64_t lifetimes_beyond_the_last_key = 2;

}  // namespace

std::uint64_t KeySchedule::changes_until(std::int64_t now_ns) const {
  if (lifetime_ns == 0 || now_ns < first_ns) return 0;
  return (static_cast<std::uint64_t>(now_ns) - static_cast<std::uint64_t>(first_ns)) /
         static_cast<std::uint64_t>(lifetime_ns);
}

std::uint32_t KeySchedule::token_after(std::uint64_t changes) const {
  return static_cast<std::uint32_t>((first_token - 1 + changes) % tokens + 1);
}

std::uint64_t KeySchedule::place_of(std::uint32_t token) const {
  return token >= first_token ? token - first_token : tokens - first_token + token;
}

std::optional<Secret> ListedKeys::key(std::uint32_t token) const {
  const std::uint64_t place = KeySchedule{first_token_, 0, 0}.place_of(token);
  return token == 0 || place >= keys_.size() ? std::nullopt : std::optional(keys_[place]);
}

std::optional<Secret> DerivedKeys::key(std::uint32_t token) const {
  if (token == 0) return std::nullopt;
  constexpr std::string_view purpose = "takt SecurityGroup";
  Hmac hmac(Hash::sha256, secret_.octets());
  Secret whole(3 * digest_octets(Hash::sha256));
  for (std::size_t i = 0; i < 3; ++i) {
    if (i > 0) hmac.add(whole.octets().subspan((i - 1) * hmac.size(), hmac.size()));
    hmac.add(std::as_bytes(std::span(purpose)));
    hmac.add(std::as_bytes(std::span(group_)));
    std::array<std::byte, 6> behind;
    sim::store(behind.data(), token, sim::ByteOrder::little);
    behind[4] = static_cast<std::byte>(policy_);
    behind[5] = static_cast<std::byte>(i + 1);
    hmac.add(behind);
    hmac.finish(whole.octets().subspan(i * hmac.size(), hmac.size()));
  }
  return Secret(Octets(whole.octets()).first(key_octets(policy_)));
}

KeyRing::KeyRing(MessagePolicy policy, const KeySchedule& schedule, std::unique_ptr<KeySource> source)
    : policy_(policy), schedule_(schedule), source_(std::move(source)) {}

GroupKey* KeyRing::made(std::uint32_t token) {
  for (const Slot& slot : slots_)
    if (slot.token == token) return slot.key.get();
  const auto octets = source_->key(token);
  if (!octets) return nullptr;
  Slot& slot = slots_[next_slot_];
  next_slot_ = (next_slot_ + 1) % slots_.size();
  slot = {token, std::make_unique<GroupKey>(policy_, octets->octets())};
  return slot.key.get();
}

auto KeyRing::current(std::int64_t now_ns) -> std::optional<Current> {
  if (now_ns < schedule_.first_ns) return std::nullopt;
  changes_ = std::max(changes_, schedule_.changes_until(now_ns));
  for (std::uint64_t back = 0; back <= std::min(lifetimes_beyond_the_last_key, changes_); ++back) {
    const std::uint32_t token = schedule_.token_after(changes_ - back);
    GroupKey* const key = made(token);
    if (key == nullptr) continue;
    if (used_ != 0 && is_later_token(used_, token)) return std::nullopt;  // it may have signed all that it may
    used_ = token;
    return Current{token, key};
  }
  return std::nullopt;
}

GroupKey* KeyRing::find(std::uint32_t token, std::int64_t now_ns) {
  if (token == 0) return nullptr;
  changes_ = std::max(changes_, schedule_.changes_until(now_ns));
  const std::uint64_t first = changes_ > 0 ? changes_ - 1 : 0;
  for (std::uint64_t changes = first; changes <= changes_ + 1; ++changes)
    if (schedule_.token_after(changes) == token) return made(token);
  // Past its time, but the last that there is.
  if (changes_ < lifetimes_beyond_the_last_key ||
      schedule_.token_after(changes_ - lifetimes_beyond_the_last_key) != token || source_->key(next_token(token)))
    return nullptr;
  return made(token);
}

bool KeyRing::is_missing(std::uint32_t token, std::int64_t now_ns) const {
  return token != 0 && (now_ns < schedule_.first_ns || is_later_token(token, schedule_.token_after(changes_)));
}

void KeyRing::replace(const KeySchedule& schedule, std::unique_ptr<KeySource> source) {
  schedule_ = schedule;
  source_ = std::move(source);
  changes_ = used_ != 0 && is_later_token(used_, schedule.first_token) ? schedule.place_of(used_) : 0;
  slots_ = {};
  next_slot_ = 0;
}

}  // namespace takt::security
