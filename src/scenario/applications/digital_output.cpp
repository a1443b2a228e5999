#include "scenario/applications/digital_output.hpp"

namespace takt::scenario {

bool DigitalOutput::is_off(sim::Duration length, sim::Duration nominal) {
  const sim::Duration off = length > nominal ? length - nominal : nominal - length;
  return off * 10 > nominal;
}

bool DigitalOutput::set(bool high, sim::TrueTime now) {
  if (high == high_) return false;
  high_ = high;
  if (edges_.size() < most_edges) edges_.push_back({now, high});
  if (high) {
    if (rise_)
      figures_.add(*rise_, [&](Figures& figures) {
        figures.periods.add(now - *rise_);
        figures.irregular_periods += is_off(now - *rise_, pulse_ * 2) ? 1 : 0;
      });
    rise_ = now;
  } else {
    figures_.add(*rise_, [&](Figures& figures) {
      figures.pulses.add(now - *rise_);
      figures.irregular_pulses += is_off(now - *rise_, pulse_) ? 1 : 0;
    });
  }
  return true;
}

}  // namespace takt::scenario
