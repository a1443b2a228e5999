#include "cli/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <string>

#include "output/text_report.hpp"

namespace takt::cli {

Progress::Progress(bool is_wanted) : is_wanted_(is_wanted && ::isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
  if (!is_drawn_) return;
  std::fputs("\r\033[K", stderr);
  std::fflush(stderr);
}

void Progress::update(sim::Duration done, sim::Duration wanted, std::uint64_t events) {
  if (!is_wanted_) return;
  const Clock::time_point now = Clock::now();
  if (now - began_ < std::chrono::seconds(1) || now - drawn_ < std::chrono::milliseconds(100)) return;
  drawn_ = now;
  is_drawn_ = true;
  const double share = wanted.ps() > 0 ? std::clamp(static_cast<double>(done.ps()) / static_cast<double>(wanted.ps()), 0.0, 1.0) : 1.0;
  const double seconds = std::chrono::duration<double>(now - began_).count();
  const auto filled = static_cast<std::size_t>(share * 30);
  std::string bar(30, ' ');
  std::fill_n(bar.begin(), filled, '=');
  if (filled < bar.size()) bar[filled] = '>';
  std::string left = share > 0 ? fmt::format("{:.0f} s left", seconds / share - seconds) : "";
  fmt::print(stderr, "\r[{}] {:5.1f} %  {}  {:.1f} M events/s  {}\033[K", bar, 100 * share, output::readable(done),
             static_cast<double>(events) / seconds / 1e6, left);
  std::fflush(stderr);
}

}  // namespace takt::cli
