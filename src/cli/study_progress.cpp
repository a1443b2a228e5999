#include "cli/study_progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

namespace takt::cli {

StudyProgress::StudyProgress(bool is_wanted) : is_wanted_(is_wanted && ::isatty(STDERR_FILENO) == 1) {}

StudyProgress::~StudyProgress() {
  if (!is_drawn_) return;
  std::fputs("\r\033[K", stderr);
  std::fflush(stderr);
}

void StudyProgress::update(const char* what, std::uint64_t done, std::uint64_t of) {
  if (!is_wanted_ || of == 0) return;
  const Clock::time_point now = Clock::now();
  if (what_ != what) {
    what_ = what;
    began_ = drawn_ = now;
  }
  if (now - drawn_ < std::chrono::milliseconds(100)) return;
  drawn_ = now;
  is_drawn_ = true;
  const double share = static_cast<double>(done) / static_cast<double>(of);
  const double seconds = std::chrono::duration<double>(now - began_).count();
  const auto filled = static_cast<std::size_t>(share * 30);
  std::string bar = std::string(filled, '=') + (filled < 30 ? ">" : "");
  bar.resize(30, ' ');
  const std::string left = done > 0 ? fmt::format("{:.0f} s left", seconds / share - seconds) : "";
  fmt::print(stderr, "\r{} [{}] {} of {} points  {:.1f} a second  {}\033[K", what, bar, done, of, static_cast<double>(done) / seconds, left);
  std::fflush(stderr);
}

}  // namespace takt::cli
