// SPDX-License-Identifier: Apache-2.0
#include "models/clock/servo.hpp"

#include <algorithm>
#include <array>

#include "sim/check.hpp"

namespace takt::models {
namespace {

constexpr int gain_bits = 24;
constexpr sim::int128 trillion = 1'000'000'000'000;

/// kp and ki for T = 2^-7 ... 2^4 s: round(2^56 min(0.7 T^-0.3, 0.7/T)), round(2^56 min(0.3 T^0.4, 0.3/T)).
constexpr std::array<ServoGains, ServoGains::highest_log_interval - ServoGains::lowest_log_interval + 1>
    gains_of_interval = {{
        {216'242'367'779'380'819, 3'103'966'490'115'449},
        {175'643'381'422'548'483, 4'095'708'338'481'310},
        {142'666'757'464'577'305, 5'404'319'552'844'595},
        {115'881'415'630'976'768, 7'131'042'402'323'074},
        {94'124'957'539'413'809, 9'409'466'861'922'240},
        {76'453'222'318'317'784, 12'415'865'960'461'797},
        {62'099'313'037'209'648, 16'382'833'353'925'239},
        {50'440'315'826'549'555, 21'617'278'211'378'381},
        {25'220'157'913'274'778, 10'808'639'105'689'190},
        {12'610'078'956'637'389, 5'404'319'552'844'595},
        {6'305'039'478'318'694, 2'702'159'776'422'298},
        {3'152'519'739'159'347, 1'351'079'888'211'149},
    }};

/// From ns/s for each ns (2^-56) to 2^-62 for each ps (2^-24): 10^-12 * 2^62 * 2^24 / 2^56.
std::int64_t gain_per_ps(std::int64_t gain_56) {
  return static_cast<std::int64_t>(
      divide_rounded(sim::int128{gain_56} << (RateOffset::fraction_bits + gain_bits - 56), trillion));
}

sim::int128 product(std::int64_t gain, sim::Duration offset) { return (sim::int128{gain} * offset.ps()) >> gain_bits; }

sim::Duration magnitude(sim::Duration d) { return d < sim::Duration() ? -d : d; }

}  // namespace

ServoGains ServoGains::of_interval(int log_interval) {
  return gains_of_interval[static_cast<std::size_t>(
      std::clamp(log_interval, lowest_log_interval, highest_log_interval) - lowest_log_interval)];
}

Servo::Servo(const ServoConfig& config) : config_(config), stable_left_(config.stable_count) {
  TAKT_CHECK(config.highest_frequency.parts_per_trillion > 0 &&
                 config.highest_frequency.parts_per_trillion < 1'000'000'000'000,
             "a clock that can be trimmed but not stopped");
  set_log_sync_interval(config.log_sync_interval);
}

void Servo::set_log_sync_interval(int log_interval) {
  const int before = config_.log_sync_interval;
  config_.log_sync_interval =
      std::clamp(log_interval, ServoGains::lowest_log_interval, ServoGains::highest_log_interval);
  const int now = config_.log_sync_interval;
  const ServoGains gains = ServoGains::of_interval(now);
  proportional_gain_ = gain_per_ps(gains.proportional);
  integral_gain_ = gain_per_ps(gains.integral);
  if (config_.kind == ServoKind::drift_tracking) {
    const sim::int128 both = (sim::int128{gains.proportional} * gains.integral) >> (56 + 2);  // kp ki / 4
    drift_gain_ = gain_per_ps(static_cast<std::int64_t>(now >= 0 ? both << now : both >> -now));
    const std::int64_t drift = drift_.multiple();
    drift_ = RateOffset::from_multiple(now >= before ? drift << (now - before) : drift >> (before - now));
  }
  // 0.016 / ki seconds, at most 1000 s (which no ki of the table needs).
  estimate_over_ =
      sim::Duration::from_ps(static_cast<std::int64_t>((sim::int128{16'000'000'000} << 56) / gains.integral));
}

void Servo::restart(bool may_step) {
  phase_ = Phase::first_sample;
  state_ = ServoState::unlocked;
  first_update_ = first_update_ || may_step;
  drift_ = RateOffset();
}

RateOffset Servo::holdover(sim::Duration since) const {
  if (drift_ == RateOffset()) return -frequency_;
  // drift * since / 2^log s
  const sim::int128 interval =
      config_.log_sync_interval >= 0 ? trillion << config_.log_sync_interval : trillion >> -config_.log_sync_interval;
  return -limited(frequency_.multiple() + divide_rounded(sim::int128{drift_.multiple()} * since.ps(), interval));
}

ServoAction Servo::sample(sim::Duration offset, sim::LocalTime at) {
  state_ = ServoState::unlocked;
  switch (phase_) {
    case Phase::first_sample:
      first_offset_ = offset;
      first_at_ = at;
      phase_ = Phase::estimating;
      break;
    case Phase::estimating:
      last_ = first_estimate(offset, at);
      break;
    case Phase::controlling:
      if (config_.step_threshold > sim::Duration() && magnitude(offset) > config_.step_threshold) {
        phase_ = Phase::first_sample;
        break;
      }
      last_ = controlled(offset);
      state_ = locked_state(offset);
      break;
  }
  if (state_ == ServoState::unlocked) stable_left_ = config_.stable_count;
  if (state_ != ServoState::unlocked) first_update_ = false;
  return {state_, -last_, state_ == ServoState::jump ? -offset : sim::Duration()};
}

RateOffset Servo::first_estimate(sim::Duration offset, sim::LocalTime at) {
  const sim::Duration elapsed = at - first_at_;
  if (elapsed <= sim::Duration()) {
    phase_ = Phase::first_sample;
    return last_;
  }
  if (elapsed + elapsed / 1000 < estimate_over_) return last_;
  // drift += (1 - drift) * change of offset / elapsed: the clock that measures both is wrong by the drift itself.
  const sim::int128 measured =
      divide_rounded(sim::int128{(offset - first_offset_).ps()} << RateOffset::fraction_bits, elapsed.ps());
  const sim::int128 change = limited(measured).multiple();
  frequency_ = limited(frequency_.multiple() +
                       ((change * (RateOffset::one - frequency_.multiple())) >> RateOffset::fraction_bits));
  phase_ = Phase::controlling;
  state_ = steps(offset) ? ServoState::jump : ServoState::locked;
  return frequency_;
}

RateOffset Servo::controlled(sim::Duration offset) {
  const sim::int128 integral = product(integral_gain_, offset);
  const sim::int128 drift = drift_.multiple() + product(drift_gain_, offset);
  const sim::int128 integrated = frequency_.multiple() + integral + drift;
  const sim::int128 wanted = product(proportional_gain_, offset) + integrated;
  const RateOffset possible = limited(wanted);
  if (possible.multiple() == wanted) {  // at the limit nothing more is integrated
    frequency_ = limited(integrated);
    drift_ = limited(drift);
  }
  return possible;
}

bool Servo::steps(sim::Duration offset) const {
  const auto exceeds = [&](sim::Duration threshold) {
    return threshold > sim::Duration() && magnitude(offset) > threshold;
  };
  return (first_update_ && exceeds(config_.first_step_threshold)) || exceeds(config_.step_threshold);
}

ServoState Servo::locked_state(sim::Duration offset) {
  if (config_.stable_threshold == sim::Duration()) return ServoState::locked;
  if (magnitude(offset) >= config_.stable_threshold)
    stable_left_ = config_.stable_count;
  else if (stable_left_ > 0)
    --stable_left_;
  return stable_left_ == 0 ? ServoState::locked_stable : ServoState::locked;
}

RateOffset Servo::limited(sim::int128 y) const {
  const sim::int128 highest = RateOffset::from(config_.highest_frequency).multiple();
  return RateOffset::from_multiple(static_cast<std::int64_t>(std::clamp(y, -highest, highest)));
}

}  // namespace takt::models
