// SPDX-License-Identifier: Apache-2.0
// Wakes a waiting part when another part has posted something for it.
#pragma once

#include <atomic>
#include <cstdint>

namespace takt::models {

/// One thread sleeps by it, others ring. Who rings while nobody sleeps reads one word.
class alignas(64) Bell {
 public:
  /// After what the sleeper waits for has been stored (sequentially consistent, as all here: the ringer sees the
  /// sleeper, or the sleeper sees what was stored).
  void ring() {
    if (sleeps_.load()) wake();
  }
  /// Sleeps until somebody rings, unless there is something already: `is_ready` reads what ringers store before they
  /// ring.
  template <class IsReady>
  void sleep_unless(IsReady&& is_ready) {
    const std::uint32_t rung = rung_.load();
    sleeps_.store(true);
    if (!is_ready()) rung_.wait(rung);
    sleeps_.store(false);
  }

 private:
  void wake() {
    rung_.fetch_add(1);
    rung_.notify_one();
  }

  std::atomic<bool> sleeps_{false};
  std::atomic<std::uint32_t> rung_{0};
};

}  // namespace takt::models
