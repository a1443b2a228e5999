// SPDX-License-Identifier: Apache-2.0
#include "models/egress/single_talker_port.hpp"

#include <algorithm>

namespace takt::models {
namespace {
constexpr std::size_t few = 64;  // frames that are kept together until it is asked which have started
}

SingleTalkerPort::SingleTalkerPort(const sim::Simulation& simulation, Link& link, TrafficClass q)
    : simulation_(&simulation), link_(&link), class_(q) {
  sent_.reserve(few);
}

/// Those that have started are as good as gone: no later one is handed over before now.
void SingleTalkerPort::make_room(sim::TrueTime now) {
  note_peaks(now);
  const auto first = std::find_if(sent_.begin(), sent_.end(), [now](const Sent& sent) { return sent.start > now; });
  const auto gone = static_cast<std::size_t>(first - sent_.begin());
  while (waiting_ < gone) octets_waiting_ -= sent_[waiting_++].length;
  sent_.erase(sent_.begin(), first);
  noted_ -= gone;
  waiting_ -= gone;
  if (sent_.size() > sent_.capacity() / 2) sent_.reserve(2 * sent_.capacity());
}

/// As a port does it: what starts at the instant at which another one comes does not wait.
void SingleTalkerPort::note_peaks(sim::TrueTime now) {
  for (; noted_ < sent_.size() && sent_[noted_].handed_over <= now; ++noted_) {
    if (sent_[noted_].start == sent_[noted_].handed_over) {  // those before it have started
      waiting_ = noted_ + 1;
      octets_waiting_ = 0;
      continue;
    }
    octets_waiting_ += sent_[noted_].length;
    while (waiting_ <= noted_ && sent_[waiting_].start <= sent_[noted_].handed_over)
      octets_waiting_ -= sent_[waiting_++].length;
    if (waiting_ <= noted_) held_.note_held(class_, static_cast<std::uint32_t>(noted_ + 1 - waiting_), octets_waiting_);
  }
}

SingleTalkerPort::ToCome SingleTalkerPort::to_come() const {
  ToCome result;
  for (const Sent& sent : sent_) {
    if (sent.start <= simulation_->now()) continue;
    ++result.frames;
    result.wire_octets += wire_length(Octets{sent.length}).count;
  }
  return result;
}

const PortQueues& SingleTalkerPort::queues() {
  note_peaks(simulation_->now());
  return held_;
}

}  // namespace takt::models
