// SPDX-License-Identifier: Apache-2.0
#include "dds/rtps/flow_controller.hpp"

#include <algorithm>
#include <tuple>

#include "sim/check.hpp"

namespace takt::dds {

std::string problem_of(const FlowControllerSettings& settings) {
  if (settings.name.empty()) return "a flow controller needs a name";
  if (settings.period <= sim::Duration()) return "flow controller " + settings.name + ": the period must be above 0";
  if (settings.max_bytes_per_period != 0 &&
      settings.max_bytes_per_period < FlowControllerSettings::least_bytes_per_period)
    return "flow controller " + settings.name + ": max_bytes_per_period must be 0 (no limit) or at least " +
           std::to_string(FlowControllerSettings::least_bytes_per_period);
  return "";
}

FlowController::FlowController(const FlowControllerSettings& settings, sim::LocalTime now)
    : settings_(settings), period_begin_(now) {
  TAKT_CHECK(problem_of(settings).empty(), "a flow controller's settings are sound");
}

void FlowController::add(StatefulWriter& writer, const FlowShare& share) {
  const std::uint32_t limit = settings_.max_bytes_per_period;
  TAKT_CHECK(limit == 0 || writer.settings().max_message <= limit, "each message fits into a period");
  places_.push_back({&writer, share, 0, {}});
}

void FlowController::remove(const StatefulWriter& writer) {
  const auto at = std::find(places_.begin(), places_.end(), &writer);
  if (at == places_.end()) return;
  const auto index = static_cast<std::size_t>(at - places_.begin());
  places_.erase(at);
  if (turn_ > index) --turn_;
}

void FlowController::notify(const StatefulWriter& writer, sim::LocalTime now) {
  const auto at = std::find(places_.begin(), places_.end(), &writer);
  TAKT_CHECK(at != places_.end(), "a writer tells its own controller");
  const SequenceNumber last = writer.history().last();
  if (at->waiting.empty() || at->waiting.back().second < last) at->waiting.push_back({arrivals_++, last});
  // A controller that waits for the next period goes on waiting.
  if (ready_at_ == sim::LocalTime::never()) ready_at_ = now;
}

void FlowController::begin_period(sim::LocalTime now) {
  const std::int64_t periods = (now - period_begin_) / settings_.period;
  if (periods <= 0) return;
  period_begin_ += periods * settings_.period;
  used_ = 0;
  for (Place& place : places_) place.used = 0;
}

bool FlowController::is_reserved(const Place& place, std::size_t size) const {
  return (place.used + size) * 100 <= std::uint64_t{settings_.max_bytes_per_period} * place.share.reservation;
}

FlowController::Place* FlowController::choose(Outbox& outbox, std::size_t& size) {
  Place* best = nullptr;
  // Of all schedulers the lowest goes first; what a scheduler does not look at is 0.
  using Rank = std::tuple<int, std::int32_t, std::uint64_t, std::size_t>;
  Rank lowest{};
  for (std::size_t i = 0; i < places_.size(); ++i) {
    Place& place = places_[i];
    const std::size_t octets = place.writer->next_size(outbox);
    while (!place.waiting.empty() && place.waiting.front().second < place.writer->first_unsent())
      place.waiting.pop_front();
    if (octets == 0) continue;
    const std::uint64_t came =
        place.waiting.empty() ? 0 : place.waiting.front().first;  // what is asked for again came before
    const std::size_t after_turn = (i + places_.size() - turn_ % places_.size()) % places_.size();
    Rank rank{};
    switch (settings_.scheduler) {
      case FlowScheduler::fifo:
        rank = {0, 0, came, i};
        break;
      case FlowScheduler::round_robin:
        rank = {0, 0, 0, after_turn};
        break;
      case FlowScheduler::high_priority:
        rank = {0, place.share.priority, came, i};
        break;
      case FlowScheduler::priority_with_reservation:
        rank = {is_reserved(place, octets) ? 0 : 1, place.share.priority, came, i};
        break;
    }
    if (best != nullptr && lowest <= rank) continue;
    best = &place;
    lowest = rank;
    size = octets;
  }
  return best;
}

void FlowController::wake(sim::LocalTime now, Outbox& outbox) {
  if (ready_at_ > now) return;
  begin_period(now);
  ready_at_ = sim::LocalTime::never();
  std::size_t size = 0;
  while (Place* const place = choose(outbox, size)) {
    if (settings_.max_bytes_per_period != 0 && used_ + size > settings_.max_bytes_per_period) {
      ready_at_ = period_begin_ + settings_.period;
      return;
    }
    const SequenceNumber before = place->writer->first_unsent();
    const std::size_t octets = place->writer->send_next(now, outbox);
    used_ += octets;
    place->used += octets;
    turn_ = static_cast<std::size_t>(place - places_.data());
    if (place->writer->first_unsent() != before || !place->writer->is_within_sample())
      turn_ = (turn_ + 1) % places_.size();
  }
}

}  // namespace takt::dds
