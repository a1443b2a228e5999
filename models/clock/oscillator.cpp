// SPDX-License-Identifier: Apache-2.0
#include "models/clock/oscillator.hpp"

#include <algorithm>
#include <utility>

#include "models/clock/fixed_sine.hpp"
#include "sim/check.hpp"

namespace takt::models {
namespace {

constexpr std::int64_t ps_per_second = 1'000'000'000'000;

std::int64_t uniform(sim::RandomStream& chance, std::int64_t lowest, std::int64_t highest) {
  TAKT_CHECK(lowest <= highest, "a range that is not empty");
  return lowest + static_cast<std::int64_t>(chance.below(static_cast<std::uint64_t>(highest - lowest) + 1));
}

}  // namespace

void draw_oscillator(const OscillatorRange& range, std::uint64_t seed, std::string_view path,
                     OscillatorConfig& config) {
  sim::RandomStream chance(seed, path, "oscillator");
  config.offset.parts_per_trillion =
      uniform(chance, range.lowest_offset.parts_per_trillion, range.highest_offset.parts_per_trillion);
  config.drift_ppt_per_second = uniform(chance, range.lowest_drift_ppt_per_second, range.highest_drift_ppt_per_second);
}

Oscillator::Oscillator(OscillatorConfig config, std::uint64_t seed, std::string_view path)
    : config_(std::move(config)), chance_(seed, path, "frequency walk") {
  TAKT_CHECK(config_.update_interval > sim::Duration(), "an update interval above zero");
  TAKT_CHECK(!config_.temperature || config_.temperature->period > sim::Duration(), "a period above zero");
  TAKT_CHECK(config_.bound.parts_per_trillion >= 0 && config_.bound.parts_per_trillion < ps_per_second,
             "a clock that goes forwards");
  TAKT_CHECK(std::is_sorted(config_.table.begin(), config_.table.end(),
                            [](const FrequencyPoint& a, const FrequencyPoint& b) { return a.time <= b.time; }),
             "points at ascending times");
  next_change_ = next_after(interval_start_);
  rate_ = rate_in_interval();
}

void Oscillator::advance() {
  TAKT_CHECK(next_change_ != sim::TrueTime::never(), "a change that is due");
  interval_start_ = next_change_;
  next_change_ = next_after(interval_start_);
  if (config_.walk) {
    const std::int64_t step =
        uniform(chance_, -config_.walk->step.parts_per_trillion, config_.walk->step.parts_per_trillion);
    const std::int64_t bound = config_.walk->bound.parts_per_trillion;
    walk_ppt_ = std::clamp(walk_ppt_ + step, -bound, bound);
  }
  rate_ = rate_in_interval();
}

void Oscillator::set_offset(sim::TrueTime now, sim::FrequencyOffset offset) {
  TAKT_CHECK(now >= interval_start_ && now <= next_change_, "a change in the present interval");
  config_.offset = offset;
  rate_ = rate_in_interval();
}

sim::TrueTime Oscillator::next_after(sim::TrueTime time) const {
  if (config_.is_constant()) return sim::TrueTime::never();
  const bool only_table = config_.drift_ppt_per_second == 0 && !config_.temperature && !config_.walk;
  if (!only_table) return time.plus_saturated(config_.update_interval);
  // The flat stretches before the first point and after the last need no updates.
  if (time < config_.table.front().time) return config_.table.front().time;
  return time < config_.table.back().time ? time.plus_saturated(config_.update_interval) : sim::TrueTime::never();
}

ClockRate Oscillator::rate_in_interval() const {
  const bool ends = next_change_ != sim::TrueTime::never();
  const sim::TrueTime middle = ends ? interval_start_ + (next_change_ - interval_start_) / 2 : interval_start_;
  const std::int64_t bound = config_.bound.parts_per_trillion;
  RateOffset y = RateOffset::from({std::clamp(smooth_ppt(middle) + walk_ppt_, -bound, bound)});
  if (config_.temperature) y = y + temperature_at(middle);
  const RateOffset limit = RateOffset::from(config_.bound);
  return ClockRate::one_plus(std::clamp(y, -limit, limit));
}

std::int64_t Oscillator::smooth_ppt(sim::TrueTime time) const {
  const sim::int128 drift = divide_rounded(sim::int128{config_.drift_ppt_per_second} * time.ps(), ps_per_second);
  const sim::int128 sum = drift + config_.offset.parts_per_trillion + table_ppt(time);
  return static_cast<std::int64_t>(std::clamp(sum, sim::int128{-ps_per_second}, sim::int128{ps_per_second}));
}

RateOffset Oscillator::temperature_at(sim::TrueTime time) const {
  const SinusoidalFrequency& wave = *config_.temperature;
  const auto into = static_cast<sim::uint128>(time.ps() % wave.period.ps());
  const auto turns =
      static_cast<std::uint64_t>((into << 64) / static_cast<sim::uint128>(wave.period.ps())) + wave.phase;
  const std::int64_t amplitude = RateOffset::from(wave.amplitude).multiple();
  return RateOffset::from_multiple(
      static_cast<std::int64_t>((sim::int128{amplitude} * fixed_sine(turns)) >> RateOffset::fraction_bits));
}

std::int64_t Oscillator::table_ppt(sim::TrueTime time) const {
  const std::vector<FrequencyPoint>& table = config_.table;
  if (table.empty()) return 0;
  const auto after = std::upper_bound(table.begin(), table.end(), time,
                                      [](sim::TrueTime t, const FrequencyPoint& p) { return t < p.time; });
  if (after == table.begin()) return table.front().frequency.parts_per_trillion;
  const FrequencyPoint& left = *(after - 1);
  if (after == table.end()) return left.frequency.parts_per_trillion;
  const sim::int128 rise = sim::int128{after->frequency.parts_per_trillion} - left.frequency.parts_per_trillion;
  return left.frequency.parts_per_trillion +
         static_cast<std::int64_t>(divide_rounded(rise * (time - left.time).ps(), (after->time - left.time).ps()));
}

}  // namespace takt::models
