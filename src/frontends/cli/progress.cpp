// SPDX-License-Identifier: Apache-2.0
#include "cli/progress.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "output/text_report.hpp"

namespace takt::cli {

void Progress::update(sim::Duration done, sim::Duration wanted, std::uint64_t events) {
  const double seconds = line_.seconds();
  if (!line_.is_due() || seconds < 1) return;
  const double share =
      wanted.ps() > 0 ? std::clamp(static_cast<double>(done.ps()) / static_cast<double>(wanted.ps()), 0.0, 1.0) : 1.0;
  const std::string left = share > 0 ? fmt::format("{:.0f} s left", seconds / share - seconds) : "";
  line_.show("", share,
             fmt::format("{:5.1f} %  {}  {:.1f} M events/s  {}", 100 * share, output::readable(done),
                         static_cast<double>(events) / seconds / 1e6, left));
}

}  // namespace takt::cli
