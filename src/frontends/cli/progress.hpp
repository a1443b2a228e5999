// SPDX-License-Identifier: Apache-2.0
// The progress bar of long runs.
#pragma once

#include <cstdint>

#include "cli/status_line.hpp"
#include "sim/time.hpp"

namespace takt::cli {

/// Not drawn before the first second.
class Progress {
 public:
  explicit Progress(bool is_wanted) : line_(is_wanted) {}
  void update(sim::Duration done, sim::Duration wanted, std::uint64_t events);

 private:
  StatusLine line_;
};

}  // namespace takt::cli
