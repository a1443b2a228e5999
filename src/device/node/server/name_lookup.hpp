// SPDX-License-Identifier: Apache-2.0
// The addresses of a host by its name. The resolver of the system waits as long as it likes and cannot be called off,
// so it works in a thread of its own, and who no longer wants the answer goes.
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "node/hand_over.hpp"

namespace takt::node {

class NameLookup {
 public:
  static constexpr std::size_t most_addresses = 8;

  /// Begins. Throws std::system_error if the machine gives no thread.
  explicit NameLookup(std::string name);

  /// Readable when it is done.
  int file_descriptor() const { return shared_->wake.file_descriptor(); }
  bool is_done() const { return shared_->is_done.load(std::memory_order_acquire); }
  /// When it is done: IPv4 addresses in the order of the resolver; none, and `problem` says why.
  const std::vector<std::string>& addresses() const { return shared_->addresses; }
  const std::string& problem() const { return shared_->problem; }

 private:
  struct Shared {
    std::string name;
    Wake wake;
    std::vector<std::string> addresses;  ///< the thread's until it is done
    std::string problem;
    std::atomic<bool> is_done{false};
  };
  static void look_up(Shared& shared);

  std::shared_ptr<Shared> shared_;
};

}  // namespace takt::node
