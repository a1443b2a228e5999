// SPDX-License-Identifier: Apache-2.0
// Ctrl-C: the first one asks for a clean end, the second one ends the process.
#pragma once

namespace takt::cli {

/// While it lives, SIGINT and SIGTERM only set a flag. One at a time.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;
  bool requested() const;
};

}  // namespace takt::cli
