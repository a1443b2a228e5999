#include "scenario/applications/activations.hpp"

#include <algorithm>

namespace takt::scenario {

using sim::Duration;
using sim::LocalTime;

Activations::Activations(Duration every, Duration offset, const sim::Distribution& response, std::uint64_t seed, std::string_view path,
                         std::span<const Duration> instants)
    : every_(every), grid_{every.ps(), offset.ps()}, response_(&response), chance_(seed, path, "response"), counts_(instants) {
  counts_.for_each([](Counts& counts, LocalTime first) {
    if (first >= LocalTime()) counts.from = first;
  });
}

void Activations::begin(LocalTime now) {
  if (next_ != LocalTime::never()) end(next_);
  planned_ = latest_at(now - Duration::from_ps(1)) + 1;
  first_ = planned_;
  last_done_ = first_ - 1;
  plan();
}

void Activations::end(LocalTime now) {
  counts_.for_each([&](Counts& counts, LocalTime) { counts.decided_before = decided(now, counts); });
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

std::optional<Activations::Call> Activations::act() {
  std::optional<Call> call;
  if (is_call_) call = Call{planned_++, drawn_};
  plan();
  return call;
}

void Activations::finish(const Call& call) {
  last_done_ = call.activation;
  ++done_;
  counts_.add(due(last_done_), [](Counts& counts) { ++counts.done; });
}

std::optional<Duration> Activations::response_at(const Call& call, LocalTime now) const {
  const Duration response = now - due(call.activation);
  if (call.activation < first_ || response >= every_) return std::nullopt;   // of before the clock was set, or too late
  return response;
}

std::uint64_t Activations::decided(LocalTime now, Duration from) const { return decided(now, counts_.from(from)); }

std::uint64_t Activations::decided(LocalTime now, const Counts& counts) const {
  if (next_ == LocalTime::never()) return counts.decided_before;
  // The latest one that is due is open until it is done; what is done stays so where the clock was set back.
  const std::int64_t open = std::max(latest_at(now), last_done_ + 1);
  const std::int64_t first = counts.from ? std::max(first_, latest_at(*counts.from - Duration::from_ps(1)) + 1) : first_;
  return counts.decided_before + static_cast<std::uint64_t>(std::max(open - first, std::int64_t{0}));
}

}  // namespace takt::scenario
