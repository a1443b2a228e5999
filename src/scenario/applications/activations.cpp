#include "scenario/applications/activations.hpp"

#include <algorithm>

namespace takt::scenario {

using sim::Duration;
using sim::LocalTime;

Activations::Activations(Duration every, Duration offset, const sim::Distribution& response, std::uint64_t seed, std::string_view path)
    : every_(every), offset_(offset), response_(&response), chance_(seed, path, "response") {}

/// The number of the last activation that is due by then.
std::int64_t Activations::latest_at(LocalTime now) const {
  const std::int64_t since = now.ps() - offset_.ps();
  return since >= 0 ? since / every_.ps() : -((-since + every_.ps() - 1) / every_.ps());
}

void Activations::begin(LocalTime now) {
  if (next_ != LocalTime::never()) end(next_);
  planned_ = latest_at(now - Duration::from_ps(1)) + 1;
  first_ = planned_;
  last_done_ = first_ - 1;
  plan();
}

void Activations::end(LocalTime now) {
  decided_before_ = decided(now);
  done_before_ += done_;
  done_ = 0;
  first_ = planned_ = last_done_ = 0;
  next_ = LocalTime::never();
}

void Activations::plan() {
  is_call_ = false;
  for (int draws = 0; draws < most_draws; ++draws, ++planned_) {
    drawn_ = response_->draw(chance_);
    is_call_ = drawn_ < every_;
    if (is_call_) break;
  }
  next_ = due(planned_).plus_saturated(is_call_ ? drawn_ : Duration());
}

std::optional<Duration> Activations::act() {
  std::optional<Duration> response;
  if (is_call_) {
    response = drawn_;
    last_done_ = planned_++;
    ++done_;
  }
  plan();
  return response;
}

std::uint64_t Activations::decided(LocalTime now) const {
  if (next_ == LocalTime::never()) return decided_before_;
  // The latest one that is due is open until it is done; what is done stays so where the clock was set back.
  const std::int64_t open = std::max(latest_at(now), last_done_ + 1);
  return decided_before_ + static_cast<std::uint64_t>(std::max(open - first_, std::int64_t{0}));
}

}  // namespace takt::scenario
