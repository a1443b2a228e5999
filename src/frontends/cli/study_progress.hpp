// SPDX-License-Identifier: Apache-2.0
// The progress bar of studies: points, rate, time left.
#pragma once

#include <cstdint>
#include <string>

#include "cli/status_line.hpp"

namespace takt::cli {

class StudyProgress {
 public:
  explicit StudyProgress(bool is_wanted) : line_(is_wanted) {}
  /// `what` is done with the points; another `what` begins anew.
  void update(const char* what, std::uint64_t done, std::uint64_t of);
  /// Takes the line away. To be called before anything else is printed.
  void clear() { line_.clear(); }

 private:
  StatusLine line_;
  std::string what_;
  double began_ = 0;  // in the line's seconds
};

}  // namespace takt::cli
