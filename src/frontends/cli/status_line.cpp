// SPDX-License-Identifier: Apache-2.0
#include "cli/status_line.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace takt::cli {
namespace {

/// Of the terminal, less the last one: a character there would make some of them begin a new line.
std::size_t columns_of_terminal() {
  constexpr std::size_t usual = 80;
  winsize size{};
  const bool is_known = ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 1;
  return (is_known ? size.ws_col : usual) - 1;
}

}  // namespace

StatusLine::StatusLine(bool is_wanted) : is_wanted_(is_wanted && ::isatty(STDERR_FILENO) == 1) {}

void StatusLine::clear() {
  if (!is_drawn_) return;
  is_drawn_ = false;
  std::fputs("\r\033[K", stderr);
  std::fflush(stderr);
}

bool StatusLine::is_due() const { return is_wanted_ && Clock::now() - drawn_ >= std::chrono::milliseconds(100); }

void StatusLine::show(std::string_view text) {
  if (!is_wanted_) return;
  drawn_ = Clock::now();
  is_drawn_ = true;
  std::fputs(("\r" + std::string(text.substr(0, columns_of_terminal())) + "\033[K").c_str(), stderr);
  std::fflush(stderr);
}

void StatusLine::show(std::string_view before, double share, std::string_view behind) {
  constexpr std::size_t least = 6;
  constexpr std::size_t most = 30;
  const std::size_t around = before.size() + behind.size() + 4;  // brackets and spaces
  const std::size_t width =
      std::clamp(columns_of_terminal() > around ? columns_of_terminal() - around : 0, least, most);
  std::string bar(static_cast<std::size_t>(std::clamp(share, 0.0, 1.0) * static_cast<double>(width)), '=');
  if (bar.size() < width) bar += '>';
  bar.resize(width, ' ');
  show(std::string(before) + (before.empty() ? "[" : " [") + bar + "] " + std::string(behind));
}

double StatusLine::seconds() const { return std::chrono::duration<double>(Clock::now() - began_).count(); }

}  // namespace takt::cli
