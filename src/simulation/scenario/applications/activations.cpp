// SPDX-License-Identifier: Apache-2.0
#include "scenario/applications/activations.hpp"

#include <algorithm>

namespace takt::scenario {

using sim::Duration;
using sim::LocalTime;

Activations::Activations(Duration every, Duration offset, const sim::Distribution& response, std::uint64_t seed,
                         std::string_view path, std::span<const Duration> instants)
    : every_(every),
      grid_{every.ps(), offset.ps()},
      plan_(every, response, sim::RandomStream(seed, path, "response")),
      counts_(instants) {
  counts_.for_each([](Counts& counts, LocalTime first) {
    if (first >= LocalTime()) counts.from = first;
  });
}

void Activations::begin(LocalTime now) {
  if (next_ != LocalTime::never()) end(next_);
  first_ = latest_at(now - Duration::from_ps(1)) + 1;
  last_done_ = first_ - 1;
  plan_.begin(first_);
  plan();
}

void Activations::end(LocalTime now) {
  counts_.for_each([&](Counts& counts, LocalTime) { counts.decided_before = decided(now, counts); });
  first_ = last_done_ = 0;
  next_ = LocalTime::never();
}

void Activations::plan() { next_ = due(plan_.number()).plus_saturated(plan_.response()); }

std::optional<Activations::Call> Activations::act() {
  std::optional<Call> call;
  if (plan_.is_call()) call = Call{plan_.number(), plan_.response()};
  plan_.next();
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
  if (call.activation < first_ || response >= every_) return std::nullopt;  // of before the clock was set, or too late
  return response;
}

std::uint64_t Activations::decided(LocalTime now, Duration from) const { return decided(now, counts_.from(from)); }

std::uint64_t Activations::decided(LocalTime now, const Counts& counts) const {
  if (next_ == LocalTime::never()) return counts.decided_before;
  const std::int64_t first =
      counts.from ? std::max(first_, latest_at(*counts.from - Duration::from_ps(1)) + 1) : first_;
  return counts.decided_before + static_cast<std::uint64_t>(grid_.decided(first, last_done_, now.ps()));
}

}  // namespace takt::scenario
