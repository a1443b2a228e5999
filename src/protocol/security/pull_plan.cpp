// SPDX-License-Identifier: Apache-2.0
#include "security/pull_plan.hpp"

#include <algorithm>

namespace takt::security {

void PullPlan::gave(std::int64_t now_ns, std::int64_t next_ns, bool is_news) {
  failures_ = 0;
  next_ns_ = next_ns;
  done(now_ns, is_news);
}

void PullPlan::failed(std::int64_t now_ns, std::uint8_t chance) {
  const std::int64_t most = std::min(least_back_off_ns << std::min(failures_, 10U), most_back_off_ns);
  ++failures_;
  next_ns_ = now_ns + most / 2 + most / 2 * chance / 256;
  done(now_ns, false);
}

void PullPlan::done(std::int64_t now_ns, bool is_news) {
  if (is_news) between_wishes_ns_ = least_between_wishes_ns;
  wishes_from_ns_ = std::max(wishes_from_ns_, now_ns + (is_wished_ ? between_wishes_ns_ : least_between_wishes_ns));
  if (is_wished_ && !is_news) between_wishes_ns_ = std::min(2 * between_wishes_ns_, most_between_wishes_ns);
  is_wished_ = false;
}

void PullPlan::wished(std::int64_t now_ns) {
  if (now_ns < wishes_from_ns_ || next_ns_ <= now_ns) return;
  next_ns_ = now_ns;
  is_wished_ = true;
}

}  // namespace takt::security
