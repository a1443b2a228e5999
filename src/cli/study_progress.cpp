#include "cli/study_progress.hpp"

#include <fmt/format.h>

namespace takt::cli {

void StudyProgress::update(const char* what, std::uint64_t done, std::uint64_t of) {
  if (what_ != what) {
    what_ = what;
    began_ = line_.seconds();
  }
  if (of == 0 || !line_.is_due()) return;
  const double share = static_cast<double>(done) / static_cast<double>(of);
  const double seconds = line_.seconds() - began_;
  const std::string left = done > 0 ? fmt::format("{:.0f} s left", seconds / share - seconds) : "";
  line_.show(fmt::format("{} [{}] {} of {} points  {:.1f} a second  {}", what, StatusLine::bar(share), done, of, seconds > 0 ? static_cast<double>(done) / seconds : 0.0, left));
}

}  // namespace takt::cli
