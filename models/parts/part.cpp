// SPDX-License-Identifier: Apache-2.0
#include "models/parts/part.hpp"

#include <algorithm>

namespace takt::models {
namespace {

/// How often a part looks for mail before it sleeps: some 100 us. A busy machine schedules a sleeper sooner than a
/// spinner. Where there are more parts than processors, what it waits for may wait for its processor.
constexpr int looks_before_sleeping = 2000;
constexpr int looks_in_a_crowd = 10;
constexpr std::int64_t steps_a_promise = 4;

inline void pause() {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#endif
}

}  // namespace

void Part::send(std::uint32_t part, const sim::Event& arrival, FrameIndex frame) {
  Traffic& traffic = network_->traffic();
  const Frame& record = traffic.frame(frame);
  Consignment& to = outgoing_[part];
  Parcel& parcel = to.parcels.emplace_back(Parcel{arrival, record, to.octets.size(), 0});
  if (!record.payload.is_none()) {
    const std::span<const std::byte> octets = traffic.payload(record.payload).view();
    parcel.octets = static_cast<std::uint16_t>(octets.size());
    to.octets.insert(to.octets.end(), octets.begin(), octets.end());
  }
  sent_.push_back(frame);
  if (watcher_ != nullptr) watcher_->left(part, arrival, frame);
}

sim::TrueTime Part::safe_until() const {
  sim::TrueTime safe = sim::TrueTime::never();
  for (const Neighbour& neighbour : neighbours_) safe = std::min(safe, neighbour.from->promise());
  return safe;
}

void Part::receive_posted() {
  for (const Neighbour& neighbour : neighbours_) {
    if (!neighbour.from->take(incoming_)) continue;
    for (const Parcel& parcel : incoming_.parcels) {
      const FrameIndex frame = network_->traffic().take_over(
          parcel.frame, std::span(incoming_.octets).subspan(parcel.octets_from, parcel.octets));
      if (watcher_ != nullptr) watcher_->came(neighbour.part, parcel.arrival, frame);
      simulation_->receive(parcel.arrival.time, parcel.arrival.order, parcel.arrival.serial_kind,
                           parcel.arrival.argument | frame.value);
    }
    incoming_.clear();
  }
}

/// What has left since the last time is on its way; and what may leave from now on.
void Part::post(sim::TrueTime safe) {
  for (const FrameIndex frame : sent_) {
    if (watcher_ != nullptr && network_->traffic().frame(frame).references == 1) watcher_->over(frame);
    network_->traffic().release(frame);
  }
  sent_.clear();
  const sim::TrueTime next = std::min(simulation_->next_time(), safe);
  for (const Neighbour& neighbour : neighbours_) {
    neighbour.to->post(outgoing_[neighbour.part], next.plus_saturated(neighbour.promise));
    neighbour.bell->ring();
  }
}

/// In short steps: a promise given only after all safe work would keep the other part waiting for that long, and this
/// part afterwards in turn.
void Part::advance(sim::TrueTime until, const std::atomic<bool>& stop) {
  const sim::Duration tick = sim::Duration::from_ps(1);
  const sim::Duration step = std::max(tick, shortest_promise_ / steps_a_promise);
  sim::TrueTime done = simulation_->now() - tick;
  const int patience = is_crowded_ ? looks_in_a_crowd : looks_before_sleeping;
  int looks = 0;
  for (bool is_first = true;; is_first = false) {
    const sim::TrueTime safe = safe_until();  // before the mail, which then has all that comes earlier
    const sim::TrueTime last = std::min(until, safe - tick);
    if (last <= done && !is_first) {
      if (stop.load()) return;
      pause();
      if (++looks % patience == 0) bell_.sleep_unless([&] { return safe_until() != safe || stop.load(); });
      continue;
    }
    looks = 0;
    receive_posted();
    done = std::max(done, std::min(last, std::max(done, simulation_->next_time()).plus_saturated(step)));
    simulation_->run(done);
    post(safe);
    if (done == until) return;
  }
}

}  // namespace takt::models
