// SPDX-License-Identifier: Apache-2.0
#include "cli/study_progress.hpp"

#include <fmt/format.h>

namespace takt::cli {
namespace {

/// "40 s", "12 min", "3.5 h"
std::string in_words(double seconds) {
  if (seconds < 100) return fmt::format("{:.0f} s", seconds);
  return seconds < 6000 ? fmt::format("{:.0f} min", seconds / 60) : fmt::format("{:.1f} h", seconds / 3600);
}

}  // namespace

void StudyProgress::update(const char* what, std::uint64_t done, std::uint64_t of) {
  if (what_ != what) {
    what_ = what;
    began_ = line_.seconds();
  }
  if (of == 0 || !line_.is_due()) return;
  const double share = static_cast<double>(done) / static_cast<double>(of);
  const double seconds = line_.seconds() - began_;
  const std::string left = done > 0 ? in_words(seconds / share - seconds) + " left" : "";
  line_.show(what, share,
             fmt::format("{} of {} points  {:.1f} a second  {}", done, of,
                         seconds > 0 ? static_cast<double>(done) / seconds : 0.0, left));
}

}  // namespace takt::cli
