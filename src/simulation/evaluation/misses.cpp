// SPDX-License-Identifier: Apache-2.0
#include "evaluation/misses.hpp"

#include <algorithm>
#include <set>

namespace takt::evaluation {

void Misses::take(const Misses& other) {
  in_a_row = std::max(in_a_row, other.in_a_row);
  in_window = std::max(in_window, other.in_window);
  missed = std::max(missed, other.missed);
  counted = std::max(counted, other.counted);
}

Misses misses_of(const std::vector<bool>& missed, std::uint64_t window) {
  Misses found;
  found.counted = missed.size();
  std::uint64_t row = 0, within = 0;
  for (std::size_t i = 0; i < missed.size(); ++i) {
    row = missed[i] ? row + 1 : 0;
    within += missed[i] ? 1 : 0;
    if (window > 0 && i >= window && missed[i - window]) --within;
    found.missed += missed[i] ? 1 : 0;
    found.in_a_row = std::max(found.in_a_row, row);
    if (window > 0) found.in_window = std::max(found.in_window, within);
  }
  return found;
}

Misses misses_of(const scenario::Run& run, models::StreamIndex stream, std::uint64_t sent, sim::Duration deadline,
                 std::uint64_t window) {
  const models::Traffic& traffic = run.network().traffic();
  const std::uint64_t all = traffic.stream(stream).sent;
  const std::uint64_t first = all - sent;
  const sim::TrueTime now = run.simulation().now();
  std::set<std::uint64_t> may_come;
  traffic.for_each_live([&](const models::Frame& frame) {
    if (frame.stream == stream && now - frame.produced <= deadline) may_come.insert(frame.sequence);
  });
  Misses most;
  for (const models::DeliveryBook::Timely& timely : traffic.book().timely(stream)) {
    if (timely.deadline != deadline) continue;
    std::vector<bool> missed(sent);
    for (std::uint64_t i = 0; i < sent; ++i) {
      const bool came = first + i < timely.came.size() && timely.came[first + i];
      missed[i] = !came && !may_come.contains(first + i);
    }
    most.take(misses_of(missed, window));
  }
  return most;
}

}  // namespace takt::evaluation
