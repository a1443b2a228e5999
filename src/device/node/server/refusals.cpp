// SPDX-License-Identifier: Apache-2.0
#include "node/server/refusals.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace takt::node {
namespace {

constexpr std::uint64_t most_in_a_row = 5;  // people who try to find out why they are refused

}  // namespace

std::optional<std::string> Refusals::take(const std::string& host, const std::string& what, const std::string& detail,
                                          sim::LocalTime now) {
  ++count_;
  const auto key = std::pair(host, what);
  if (!entries_.contains(key)) make_room();
  Entry& entry = entries_[key];
  if (entry.told_in_a_row > 0 && now - entry.told >= quiet) entry.told_in_a_row = 0;
  if (entry.told_in_a_row >= most_in_a_row || (entry.told_in_a_row > 0 && entry.last == detail)) {
    ++entry.untold;
    return std::nullopt;
  }
  ++entry.told_in_a_row;
  entry.told = now;
  entry.last = detail;
  const std::uint64_t more = std::exchange(entry.untold, 0);
  return fmt::format("server: refused from {}: {}{}{}{}", host, what, detail.empty() ? "" : ": ", detail,
                     more == 0 ? "" : fmt::format(" (and {} more before)", more));
}

/// The one that was told longest ago goes; what was only counted of it is told with the next summary.
void Refusals::make_room() {
  if (entries_.size() < most_entries) return;
  const auto oldest = std::min_element(entries_.begin(), entries_.end(),
                                       [](const auto& a, const auto& b) { return a.second.told < b.second.told; });
  forgotten_ += oldest->second.untold;
  entries_.erase(oldest);
}

std::optional<std::string> Refusals::due(sim::LocalTime now) {
  for (auto& [key, entry] : entries_) {
    if (entry.untold == 0 || now - entry.told < quiet) continue;
    entry.told = now;
    return fmt::format("server: refused from {}: {}: {} more within a minute", key.first, key.second,
                       std::exchange(entry.untold, 0));
  }
  if (forgotten_ == 0) return std::nullopt;
  return fmt::format("server: refused from others: {} more", std::exchange(forgotten_, 0));
}

}  // namespace takt::node
