// The line on standard error that says how far a long command is; on a terminal only.
#pragma once

#include <chrono>
#include <string>

namespace takt::cli {

/// Draws over itself, at most ten times a second, and removes itself at the end.
class StatusLine {
 public:
  explicit StatusLine(bool is_wanted);
  ~StatusLine();
  StatusLine(const StatusLine&) = delete;
  StatusLine& operator=(const StatusLine&) = delete;

  /// Whether a terminal looks, and the last text has stood for a tenth of a second: only then is a text worth making.
  bool is_due() const;
  void show(const std::string& text);
  /// Since it was made, in s.
  double seconds() const;
  /// "=====>    " of 30 characters.
  static std::string bar(double share);

 private:
  using Clock = std::chrono::steady_clock;
  bool is_wanted_;
  bool is_drawn_ = false;
  Clock::time_point began_ = Clock::now();
  Clock::time_point drawn_ = began_;
};

}  // namespace takt::cli
