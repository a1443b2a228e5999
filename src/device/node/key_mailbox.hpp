// SPDX-License-Identifier: Apache-2.0
// Between who pulls keys and the cycle that seals with them: keys and news of the service one way, the wish for others
// the other way, without locks. Neither side waits for the other.
#pragma once

#include <atomic>
#include <memory>

#include "node/hand_over.hpp"
#include "node/key_service_state.hpp"
#include "security/key_ring.hpp"

namespace takt::node {

struct KeyDelivery {
  security::KeySchedule schedule;  ///< on CLOCK_BOOTTIME, which never steps
  std::unique_ptr<security::KeySource> source;
};

class KeyMailbox {
 public:
  bool is_open() const { return wake_.is_open(); }

  // The side of who pulls.
  void give(std::unique_ptr<KeyDelivery> delivery) { deliveries_.give(std::move(delivery)); }
  void tell(std::unique_ptr<KeyServiceState> state) { states_.give(std::move(state)); }
  int wishes_descriptor() const { return wake_.file_descriptor(); }
  /// Until then a flood of wishes is one.
  void clear_wishes() {
    wake_.clear();
    is_wished_.store(false, std::memory_order_release);
  }

  // The cycle's side.
  std::unique_ptr<KeyDelivery> take() { return deliveries_.take(); }
  std::unique_ptr<KeyServiceState> state() { return states_.take(); }
  /// Keys are spoken of that are not there.
  void wish() {
    if (!is_wished_.load(std::memory_order_relaxed) && !is_wished_.exchange(true, std::memory_order_acq_rel))
      wake_.signal();
  }

 private:
  Newest<KeyDelivery> deliveries_;
  Newest<KeyServiceState> states_;
  std::atomic<bool> is_wished_{false};
  Wake wake_;
};

}  // namespace takt::node
