// SPDX-License-Identifier: Apache-2.0
// Keys that a key service gives (OPC 10000-14, 8.3.2): what of an answer is believed, and how it joins what is there. A
// value: times and answers are given.
//
// Times are of a clock that never steps, for a service tells no instants but how long a key still lasts.
#pragma once

#include <map>
#include <string>

#include "security/key_ring.hpp"

namespace takt::security {

/// An answer as it came.
struct GivenKeys {
  std::string policy_uri;
  std::uint32_t first_token = 0;
  std::vector<Secret> keys;
  double time_to_next_ms = 0;
  double lifetime_ms = 0;
};

class PulledKeys {
 public:
  /// How many future keys are asked for: what bridges an outage of the service.
  static constexpr std::uint32_t future_keys = 4;
  static constexpr std::size_t most_keys = 64;

  explicit PulledKeys(MessagePolicy policy) : policy_(policy) {}

  /// Takes an answer with the current key first, which came at `now_ns`. "", or what speaks against it: then nothing
  /// has changed.
  std::string take(const GivenKeys& given, std::int64_t now_ns);

  bool is_empty() const { return keys_.empty(); }
  std::size_t size() const { return keys_.size(); }
  /// Whether the last answer that was taken had a key that was not there before.
  bool has_news() const { return has_news_; }
  /// For a KeyRing; one key before the current one is among them, if there was one.
  const KeySchedule& schedule() const { return schedule_; }
  std::unique_ptr<KeySource> source() const;
  /// When the last key ends.
  std::int64_t ends_ns() const {
    return schedule_.first_ns + static_cast<std::int64_t>(keys_.size()) * schedule_.lifetime_ns;
  }
  /// When to ask anew: after half a lifetime (OPC 10000-14, 8.3.1), not more often than each second unless keys run out
  /// before.
  std::int64_t next_pull_ns(std::int64_t now_ns) const;

 private:
  bool brings_news(const GivenKeys& given) const;
  /// Of `now_ns` by what was told before.
  std::uint32_t token_at(std::int64_t now_ns) const { return schedule_.token_after(schedule_.changes_until(now_ns)); }

  MessagePolicy policy_;
  std::vector<Secret> keys_;  ///< from schedule_.first_token on
  KeySchedule schedule_;
  bool has_news_ = false;
};

}  // namespace takt::security
