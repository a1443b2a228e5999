// SPDX-License-Identifier: Apache-2.0
// Eight first-in-first-out queues of a port, whose entries lie in one pool of the network.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

#include "models/egress/class_set.hpp"
#include "models/egress/port_config.hpp"
#include "models/ethernet/frame_pool.hpp"

namespace takt::models {

struct QueueEntry {
  FrameIndex frame;
  std::uint32_t next = 0;
  std::uint32_t length = 0;
};
using QueueEntryIndex = Index<struct QueueEntryTag>;
using QueueEntryPool = Pool<QueueEntry, QueueEntryIndex>;

class PortQueues {
 public:
  ClassSet waiting() const { return waiting_; }
  bool empty() const { return waiting_ == 0; }
  std::uint32_t frames(TrafficClass q) const { return queues_[q].frames; }
  std::uint32_t octets(TrafficClass q) const { return queues_[q].octets; }
  FrameIndex head(TrafficClass q, const QueueEntryPool& pool) const { return pool[queues_[q].head].frame; }

  /// Whether one more frame fits; the reason why not otherwise.
  bool has_room(TrafficClass q, std::uint32_t length, const QueueLimit& limit, DropReason& reason) const {
    const Queue& queue = queues_[q];
    if (queue.frames >= limit.frames) {
      reason = DropReason::queue_frames;
      return false;
    }
    if (queue.octets + length > limit.octets) {
      reason = DropReason::queue_octets;
      return false;
    }
    return true;
  }

  void push(TrafficClass q, FrameIndex frame, std::uint32_t length, QueueEntryPool& pool) {
    const QueueEntryIndex entry = pool.allocate();
    pool[entry] = {frame, 0, length};
    Queue& queue = queues_[q];
    if (queue.frames++ == 0)
      queue.head = entry;
    else
      pool[queue.tail].next = entry.value;
    queue.tail = entry;
    queue.octets += length;
    waiting_ = static_cast<ClassSet>(waiting_ | 1u << q);
    queue.note_peaks();
  }

  /// The same into a queue that is in ascending order of eligibility times, behind those of the same time.
  template <class EligibleOf>
  void push_in_order(TrafficClass q, FrameIndex frame, std::uint32_t length, QueueEntryPool& pool,
                     const EligibleOf& eligible_of) {
    Queue& queue = queues_[q];
    const auto time = eligible_of(frame);
    if (queue.frames == 0 || eligible_of(pool[queue.tail].frame) <= time) {
      push(q, frame, length, pool);
      return;
    }
    const QueueEntryIndex entry = pool.allocate();
    pool[entry] = {frame, 0, length};
    QueueEntryIndex* link = nullptr;
    QueueEntryIndex before = queue.head;
    if (eligible_of(pool[queue.head].frame) > time) {
      link = &queue.head;
    } else {
      while (eligible_of(pool[QueueEntryIndex{pool[before].next}].frame) <= time) before.value = pool[before].next;
    }
    pool[entry].next = link != nullptr ? link->value : pool[before].next;
    if (link != nullptr)
      *link = entry;
    else
      pool[before].next = entry.value;
    ++queue.frames;
    queue.octets += length;
    queue.note_peaks();
  }

  FrameIndex pop(TrafficClass q, QueueEntryPool& pool) {
    Queue& queue = queues_[q];
    const QueueEntryIndex entry = queue.head;
    const QueueEntry& record = pool[entry];
    const FrameIndex frame = record.frame;
    queue.octets -= record.length;
    queue.head.value = record.next;
    if (--queue.frames == 0) waiting_ = static_cast<ClassSet>(waiting_ & ~(1u << q));
    pool.free(entry);
    return frame;
  }

  /// Frames that were never put in would have been waiting, so many at once.
  void note_held(TrafficClass q, std::uint32_t frames, std::uint32_t octets) {
    queues_[q].peak_frames = std::max(queues_[q].peak_frames, frames);
    queues_[q].peak_octets = std::max(queues_[q].peak_octets, octets);
  }

  /// The greatest number of frames that the queue has held, and of octets; not necessarily at once.
  std::uint32_t peak_frames(TrafficClass q) const { return queues_[q].peak_frames; }
  std::uint32_t peak_octets(TrafficClass q) const { return queues_[q].peak_octets; }
  /// The greatest number of frames that any one queue of the port has held.
  std::uint32_t peak_frames() const {
    std::uint32_t peak = 0;
    for (const Queue& queue : queues_) peak = std::max(peak, queue.peak_frames);
    return peak;
  }

 private:
  struct Queue {
    QueueEntryIndex head;
    QueueEntryIndex tail;
    std::uint32_t frames = 0;
    std::uint32_t octets = 0;
    std::uint32_t peak_frames = 0;
    std::uint32_t peak_octets = 0;

    void note_peaks() {
      peak_frames = std::max(peak_frames, frames);
      peak_octets = std::max(peak_octets, octets);
    }
  };
  ClassSet waiting_ = 0;
  std::array<Queue, traffic_class_count> queues_;
};

}  // namespace takt::models
