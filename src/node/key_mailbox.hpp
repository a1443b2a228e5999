// Keys on their way from who pulls them to the cycle: the newest ones count. Neither side waits for the other.
#pragma once

#include <atomic>
#include <memory>

#include "security/key_ring.hpp"

namespace takt::node {

struct KeyDelivery {
  security::KeySchedule schedule;   ///< on CLOCK_BOOTTIME, which never steps
  std::unique_ptr<security::KeySource> source;
};

class KeyMailbox {
 public:
  KeyMailbox() = default;
  KeyMailbox(const KeyMailbox&) = delete;
  KeyMailbox& operator=(const KeyMailbox&) = delete;
  ~KeyMailbox() { take(); }

  /// What was there and has not been taken is dropped.
  void give(std::unique_ptr<KeyDelivery> delivery) { std::unique_ptr<KeyDelivery>(waiting_.exchange(delivery.release(), std::memory_order_acq_rel)); }
  /// Null: nothing new.
  std::unique_ptr<KeyDelivery> take() {
    if (waiting_.load(std::memory_order_relaxed) == nullptr) return nullptr;
    return std::unique_ptr<KeyDelivery>(waiting_.exchange(nullptr, std::memory_order_acq_rel));
  }

 private:
  std::atomic<KeyDelivery*> waiting_{nullptr};
};

}  // namespace takt::node
