// SPDX-License-Identifier: Apache-2.0
#include "security/pulled_keys.hpp"

#include <algorithm>

namespace takt::security {
namespace {

constexpr double least_lifetime_ms = 100;
constexpr double most_lifetime_ms = 366.0 * 86'400'000;
constexpr std::int64_t second_ns = 1'000'000'000;

std::int64_t nanoseconds(double milliseconds) { return static_cast<std::int64_t>(milliseconds * 1e6); }

}  // namespace

std::string PulledKeys::take(const GivenKeys& given, std::int64_t now_ns) {
  if (given.policy_uri != uri_of(policy_)) return "keys of another policy";
  if (given.first_token == 0) return "a token of 0";
  if (given.keys.empty()) return "no keys";
  if (given.keys.size() > most_keys) return "more than " + std::to_string(most_keys) + " keys";
  if (std::any_of(given.keys.begin(), given.keys.end(),
                  [&](const Secret& each) { return each.size() != key_octets(policy_); }))
    return "a key of another length than its policy has";
  if (!(given.lifetime_ms >= least_lifetime_ms && given.lifetime_ms <= most_lifetime_ms))
    return "a lifetime that is none: 100 ms to a year";
  KeySchedule next{given.first_token, 0, nanoseconds(given.lifetime_ms)};
  // open62541 1.5.7 tells no such time: its key is taken as a new one then.
  const bool is_reported = given.time_to_next_ms >= 0 && given.time_to_next_ms <= given.lifetime_ms;
  next.first_ns = now_ns + (is_reported ? nanoseconds(given.time_to_next_ms) : next.lifetime_ns) - next.lifetime_ns;

  std::optional<Secret> before;
  if (!keys_.empty()) {
    const std::uint32_t own = token_at(now_ns);
    if (is_later_token(own, next_token(given.first_token)))
      return "token " + std::to_string(given.first_token) + " after token " + std::to_string(own) +
             ": keys that were used are not used again";
    // A service that does not tell the time tells the same key for all of its lifetime, which has begun when it was
    // told first.
    if (!is_reported && given.first_token == own)
      next.first_ns = schedule_.first_ns + static_cast<std::int64_t>(schedule_.place_of(own)) * schedule_.lifetime_ns;
    const std::uint32_t previous = given.first_token == 1 ? 0xFFFF'FFFF : given.first_token - 1;
    const std::uint64_t place = schedule_.place_of(previous);
    const std::uint64_t place_of_first = place + 1;
    const bool is_another = place_of_first < keys_.size() &&
                            !(keys_[place_of_first] == given.keys.front());  // then those of before are void
    if (place < keys_.size() && !is_another) before = keys_[place];
  }
  has_news_ = brings_news(given);
  keys_ = given.keys;
  schedule_ = next;
  if (before) {
    keys_.insert(keys_.begin(), std::move(*before));
    schedule_.first_token = given.first_token == 1 ? 0xFFFF'FFFF : given.first_token - 1;
    schedule_.first_ns -= schedule_.lifetime_ns;
  }
  return "";
}

bool PulledKeys::brings_news(const GivenKeys& given) const {
  const std::uint64_t first = keys_.empty() ? 0 : schedule_.place_of(given.first_token);
  for (std::size_t i = 0; i < given.keys.size(); ++i)
    if (first + i >= keys_.size() || !(keys_[first + i] == given.keys[i])) return true;
  return false;
}

std::unique_ptr<KeySource> PulledKeys::source() const {
  return std::make_unique<ListedKeys>(schedule_.first_token, keys_);
}

std::int64_t PulledKeys::next_pull_ns(std::int64_t now_ns) const {
  const std::int64_t half_of_what_is_left = std::max<std::int64_t>((ends_ns() - now_ns) / 2, 0);
  return now_ns + std::max(schedule_.lifetime_ns / 2, std::min(second_ns, half_of_what_is_left));
}

}  // namespace takt::security
