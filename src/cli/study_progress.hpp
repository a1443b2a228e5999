// The progress bar of studies: points, rate, time left; on a terminal only.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace takt::cli {

/// Draws on standard error, at most ten times a second, and removes itself at the end.
class StudyProgress {
 public:
  explicit StudyProgress(bool is_wanted);
  ~StudyProgress();
  StudyProgress(const StudyProgress&) = delete;
  StudyProgress& operator=(const StudyProgress&) = delete;

  void update(const char* what, std::uint64_t done, std::uint64_t of);

 private:
  using Clock = std::chrono::steady_clock;
  bool is_wanted_;
  bool is_drawn_ = false;
  std::string what_;
  Clock::time_point began_;
  Clock::time_point drawn_;
};

}  // namespace takt::cli
