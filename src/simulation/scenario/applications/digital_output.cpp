// SPDX-License-Identifier: Apache-2.0
#include "scenario/applications/digital_output.hpp"

namespace takt::scenario {

bool DigitalOutput::set(bool high, sim::TrueTime now, sim::Duration latency) {
  const auto edge = level_.set(high, now);
  if (!edge) return false;
  if (edges_.size() < most_edges) edges_.push_back({now, high});
  figures_.add(now, [&](Figures& figures) { figures.latency.add(latency); });
  if (edge->began) figures_.add(*edge->began, [&](Figures& figures) { level_.count(*edge, now, pulse_, figures); });
  return true;
}

}  // namespace takt::scenario
