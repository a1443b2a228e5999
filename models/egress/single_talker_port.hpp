// SPDX-License-Identifier: Apache-2.0
// The sending side of a port to which one process alone hands frames.
//
// Such a port has nothing to decide: a frame starts when it is handed over, or when the one before it is over. Both are
// known when the process sends, so the frame is put on the medium then, and neither its way through the operating
// system nor the end of the one before costs an event.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "models/egress/frame_queue.hpp"
#include "models/ethernet/link.hpp"

namespace takt::models {

class SingleTalkerPort {
 public:
  /// All frames are of class `q`. Both references outlive this.
  SingleTalkerPort(const sim::Simulation& simulation, Link& link, TrafficClass q);

  /// False while a trace sink is attached: then every step is an event.
  bool accepts(const sim::Simulation& simulation) {
    if (simulation.trace() != nullptr) [[unlikely]]
      is_recorded_ = true;
    return !is_recorded_;
  }
  bool is_recorded() const { return is_recorded_; }

  /// The frame is handed to the port at `handed_over`, which is neither past nor before that of the frame before it.
  /// Precondition: accepts().
  void send(sim::Simulation& simulation, FrameIndex frame, const Frame& record, sim::TrueTime handed_over) {
    if (sent_.size() == sent_.capacity()) [[unlikely]]
      make_room(simulation.now());
    const sim::TrueTime start = std::max(handed_over, link_->free_at());
    sent_.push_back({handed_over, start, record.length});
    link_->transmit_at(simulation, start, frame, record);
  }

  /// What the link has counted already but has not begun to send.
  struct ToCome {
    std::uint64_t frames = 0;
    std::uint64_t wire_octets = 0;
  };
  ToCome to_come() const;
  /// What the queues of the port have held up to now; nothing is in them.
  const PortQueues& queues();

 private:
  struct Sent {
    sim::TrueTime handed_over;
    sim::TrueTime start;
    std::uint32_t length = 0;
  };
  [[gnu::noinline]] void make_room(sim::TrueTime now);
  void note_peaks(sim::TrueTime now);

  const sim::Simulation* simulation_;
  Link* link_;
  std::vector<Sent> sent_;   // the last ones; which of them have started is rarely needed
  PortQueues held_;          // its peaks only
  std::size_t noted_ = 0;    // so many of sent_ are in the peaks
  std::size_t waiting_ = 0;  // the first one that waits when the last noted one is handed over
  std::uint32_t octets_waiting_ = 0;
  TrafficClass class_;
  bool is_recorded_ = false;
};

}  // namespace takt::models
