// SPDX-License-Identifier: Apache-2.0
#include "gateway/shared_buffer.hpp"

#include <algorithm>

#include "sim/check.hpp"

namespace takt::gateway {

void AgeFigures::add(sim::Duration age) {
  least = count == 0 ? age : std::min(least, age);
  greatest = count == 0 ? age : std::max(greatest, age);
  sum_ps += age.ps();
  ++count;
}

SharedBuffer::SharedBuffer(const BufferSettings& settings) : settings_(settings) {
  TAKT_CHECK(settings.capacity > 0, "a buffer has room for a value");
  if (settings_.overflow == Overflow::keep_latest) settings_.capacity = 1;
  places_.resize(settings_.capacity);
}

void SharedBuffer::leave() {
  TAKT_CHECK(waiting_ > 0, "what leaves a buffer is in it");
  first_ = (first_ + 1) % places_.size();
  --waiting_;
}

void SharedBuffer::push(Octets octets, sim::LocalTime now) {
  ++figures_.received;
  if (waiting_ == places_.size()) {
    if (settings_.overflow == Overflow::drop_newest) {
      ++figures_.dropped;
      return;
    }
    leave();
    ++figures_.overwritten;
  }
  Place& place = places_[(first_ + waiting_) % places_.size()];
  place.octets.assign(octets.begin(), octets.end());
  place.since = now;
  ++waiting_;
}

std::optional<SharedBuffer::Value> SharedBuffer::pull(sim::LocalTime now) {
  while (waiting_ > 0) {
    const Place& place = places_[first_];
    leave();
    const sim::Duration age = now - place.since;
    if (settings_.stale_after && age > *settings_.stale_after) {
      ++figures_.stale;
      continue;
    }
    ++figures_.forwarded;
    age_.add(age);
    return Value{place.octets, place.since};
  }
  return std::nullopt;
}

}  // namespace takt::gateway
