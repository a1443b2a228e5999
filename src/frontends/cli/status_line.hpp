// SPDX-License-Identifier: Apache-2.0
// The line on standard error that says how far a long command is; on a terminal only.
#pragma once

#include <chrono>
#include <string>
#include <string_view>

namespace takt::cli {

/// Draws over itself, at most ten times a second, within one line of the terminal (80 columns if its width is unknown),
/// and removes itself at the end.
class StatusLine {
 public:
  explicit StatusLine(bool is_wanted);
  ~StatusLine() { clear(); }
  StatusLine(const StatusLine&) = delete;
  StatusLine& operator=(const StatusLine&) = delete;

  /// Whether a terminal looks, and the last text has stood for a tenth of a second: only then is a text worth making.
  bool is_due() const;
  /// What does not fit is cut off.
  void show(std::string_view text);
  /// "before [=====>    ] behind", with a bar of at most 30 characters in the room that there is.
  void show(std::string_view before, double share, std::string_view behind);
  /// Takes the line away. To be called before anything else is printed.
  void clear();
  /// Since it was made, in s.
  double seconds() const;

 private:
  using Clock = std::chrono::steady_clock;
  bool is_wanted_;
  bool is_drawn_ = false;
  Clock::time_point began_ = Clock::now();
  Clock::time_point drawn_ = began_;
};

}  // namespace takt::cli
