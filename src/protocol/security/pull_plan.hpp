// SPDX-License-Identifier: Apache-2.0
// When a node asks its key service: after half a lifetime, again after failures, and at once when it hears of keys that
// it does not have. A value: times and chance are given.
#pragma once

#include <cstdint>

namespace takt::security {

/// Nanoseconds of a clock that never steps.
class PullPlan {
 public:
  static constexpr std::int64_t least_back_off_ns = 500'000'000;
  static constexpr std::int64_t most_back_off_ns = 30'000'000'000;
  /// Anybody can send a token: a pull that was wished for is followed by another one so long after it at the earliest,
  /// and after twice as long each time as such pulls bring nothing new.
  static constexpr std::int64_t least_between_wishes_ns = 1'000'000'000;
  static constexpr std::int64_t most_between_wishes_ns = 64'000'000'000;

  /// The pull that was due has brought keys; the next one is due at `next_ns`. `is_news`: they are others than those
  /// before.
  void gave(std::int64_t now_ns, std::int64_t next_ns, bool is_news);
  /// It has brought none. The next one is due after half a second, then after twice as long each time up to half a
  /// minute; of that a half is by chance (0 to 255), so that nodes that have lost their service together come back one
  /// by one.
  void failed(std::int64_t now_ns, std::uint8_t chance);
  /// Something on the wire speaks of keys that are not there. Before `wishes_from_ns` that changes nothing.
  void wished(std::int64_t now_ns);

  /// When to pull; at once before the first pull.
  std::int64_t next_ns() const { return next_ns_; }
  std::int64_t wishes_from_ns() const { return wishes_from_ns_; }
  /// Whether the pull that is due was wished for.
  bool is_wished() const { return is_wished_; }

 private:
  void done(std::int64_t now_ns, bool is_news);

  std::int64_t next_ns_ = 0;
  std::int64_t wishes_from_ns_ = 0;
  std::int64_t between_wishes_ns_ = least_between_wishes_ns;
  unsigned failures_ = 0;  ///< one behind the other
  bool is_wished_ = false;
};

}  // namespace takt::security
