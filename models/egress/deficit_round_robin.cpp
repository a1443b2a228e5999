// SPDX-License-Identifier: Apache-2.0
#include "models/egress/deficit_round_robin.hpp"

#include <algorithm>
#include <limits>

#include "sim/check.hpp"

namespace takt::models {

/// All rounds in which nobody can send are taken at once: a small quantum costs no more than a large one.
TrafficClass DeficitRoundRobin::choose(const PerClass& first) {
  chosen_ = now_;
  if (first[now_.turn] != 0 && now_.deficits[now_.turn] >= first[now_.turn]) return now_.turn;
  constexpr int classes = traffic_class_count;
  const auto after = [this](int step) { return static_cast<TrafficClass>((now_.turn + classes - step) % classes); };
  std::int64_t rounds = std::numeric_limits<std::int64_t>::max();
  int last = 0;
  for (int step = 1; step <= classes; ++step) {
    const TrafficClass q = after(step);
    if (first[q] == 0) continue;
    TAKT_CHECK(quanta_[q] > 0, "a class without a share");
    const std::int64_t needed = std::max<std::int64_t>(1, (first[q] - now_.deficits[q] + quanta_[q] - 1) / quanta_[q]);
    if (needed >= rounds) continue;  // of those that can send in one round the first
    rounds = needed;
    last = step;
  }
  TAKT_CHECK(last != 0, "somebody has a frame");
  for (int step = 1; step <= classes; ++step) {
    const TrafficClass q = after(step);
    if (first[q] != 0) chosen_.deficits[q] += quanta_[q] * (step <= last ? rounds : rounds - 1);
  }
  chosen_.turn = after(last);
  return chosen_.turn;
}

void DeficitRoundRobin::started(TrafficClass q, std::int64_t octets, bool queue_is_empty) {
  TAKT_CHECK(q == chosen_.turn && octets <= chosen_.deficits[q], "its turn");
  now_ = chosen_;
  now_.deficits[q] = queue_is_empty ? 0 : now_.deficits[q] - octets;
}

}  // namespace takt::models
