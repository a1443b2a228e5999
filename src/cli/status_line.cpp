#include "cli/status_line.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace takt::cli {

StatusLine::StatusLine(bool is_wanted) : is_wanted_(is_wanted && ::isatty(STDERR_FILENO) == 1) {}

StatusLine::~StatusLine() {
  if (!is_drawn_) return;
  std::fputs("\r\033[K", stderr);
  std::fflush(stderr);
}

bool StatusLine::is_due() const { return is_wanted_ && Clock::now() - drawn_ >= std::chrono::milliseconds(100); }

void StatusLine::show(const std::string& text) {
  if (!is_wanted_) return;
  drawn_ = Clock::now();
  is_drawn_ = true;
  std::fputs(("\r" + text + "\033[K").c_str(), stderr);
  std::fflush(stderr);
}

double StatusLine::seconds() const { return std::chrono::duration<double>(Clock::now() - began_).count(); }

std::string StatusLine::bar(double share) {
  constexpr std::size_t width = 30;
  std::string bar(static_cast<std::size_t>(std::clamp(share, 0.0, 1.0) * width), '=');
  if (bar.size() < width) bar += '>';
  bar.resize(width, ' ');
  return bar;
}

}  // namespace takt::cli
