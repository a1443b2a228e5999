// SPDX-License-Identifier: Apache-2.0
// Budgets as values: rates over time, turns among accounts, octets that are held. Time is passed in.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "sim/time.hpp"

namespace takt::opcua {

/// So many units a second, and those of one second at once after a silence.
class Rate {
 public:
  explicit Rate(std::uint64_t per_second)
      : per_second_(std::max<std::uint64_t>(per_second, 1)),
        unit_(sim::Duration::from_ps(1'000'000'000'000 / static_cast<std::int64_t>(per_second_))) {}

  /// When so many units can be taken; more than those of a second count as those of a second.
  sim::LocalTime ready(std::uint64_t units) const { return paid_until_ + length(units) - length(per_second_); }
  void spend(std::uint64_t units, sim::LocalTime now) { paid_until_ = std::max(paid_until_, now) + length(units); }
  bool try_spend(std::uint64_t units, sim::LocalTime now) {
    if (ready(units) > now) return false;
    spend(units, now);
    return true;
  }

 private:
  sim::Duration length(std::uint64_t units) const {
    return unit_ * static_cast<std::int64_t>(std::min(units, per_second_));
  }

  std::uint64_t per_second_;
  sim::Duration unit_;
  sim::LocalTime paid_until_;
};

/// Whose turn it is: the account that has spent least. Who comes back after a pause begins where the others are.
class FairShares {
 public:
  std::uint64_t spent(const std::string& account) const {
    const auto found = spent_.find(account);
    return found == spent_.end() ? floor_ : std::max(found->second, floor_);
  }
  /// `account` had spent least of all that wait, and is served at this cost.
  void serve(const std::string& account, std::uint64_t cost) {
    const std::uint64_t before = spent(account);
    floor_ = before;
    spent_[account] = before + cost;
    if (spent_.size() > most_accounts) std::erase_if(spent_, [&](const auto& each) { return each.second <= floor_; });
    if (spent_.size() > most_accounts) spent_.clear();
  }

 private:
  static constexpr std::size_t most_accounts = 1024;
  std::map<std::string, std::uint64_t> spent_;
  std::uint64_t floor_ = 0;
};

/// Octets that something may hold, as a part of what the account above it may.
class OctetAccount {
 public:
  OctetAccount(std::size_t limit, std::shared_ptr<OctetAccount> above) : limit_(limit), above_(std::move(above)) {}
  OctetAccount(const OctetAccount&) = delete;
  OctetAccount& operator=(const OctetAccount&) = delete;

  std::size_t held() const { return held_; }
  /// Here and in all above, or in none.
  bool take(std::size_t octets) {
    if (octets > limit_ - std::min(limit_, held_) || (above_ && !above_->take(octets))) return false;
    held_ += octets;
    return true;
  }
  void give(std::size_t octets) {
    held_ -= octets;
    if (above_) above_->give(octets);
  }
  /// What is held goes along, whatever the limits there are: it takes nothing more than before.
  void move_below(std::shared_ptr<OctetAccount> above) {
    if (above_) above_->give(held_);
    above_ = std::move(above);
    for (OctetAccount* at = above_.get(); at != nullptr; at = at->above_.get()) at->held_ += held_;
  }

 private:
  std::size_t limit_;
  std::size_t held_ = 0;
  std::shared_ptr<OctetAccount> above_;
};

/// What one thing holds of an account; given back when it goes.
class HeldOctets {
 public:
  HeldOctets() = default;
  explicit HeldOctets(std::shared_ptr<OctetAccount> account) : account_(std::move(account)) {}
  HeldOctets(HeldOctets&& other) noexcept
      : account_(std::move(other.account_)), octets_(std::exchange(other.octets_, 0)) {}
  HeldOctets& operator=(HeldOctets&& other) noexcept {
    std::swap(account_, other.account_);
    std::swap(octets_, other.octets_);
    return *this;
  }
  ~HeldOctets() { set(0); }

  std::size_t octets() const { return octets_; }
  bool add(std::size_t octets) { return set(octets_ + octets); }
  void remove(std::size_t octets) { set(octets_ - std::min(octets, octets_)); }
  /// False, and nothing changes: there is no room for so many. Without an account there is room.
  bool set(std::size_t octets) {
    if (account_ && octets > octets_ && !account_->take(octets - octets_)) return false;
    if (account_ && octets < octets_) account_->give(octets_ - octets);
    octets_ = octets;
    return true;
  }

 private:
  std::shared_ptr<OctetAccount> account_;
  std::size_t octets_ = 0;
};

}  // namespace takt::opcua
