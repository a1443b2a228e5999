// Eight first-in-first-out queues of a port, whose entries lie in one pool of the network.
#pragma once

#include <array>
#include <bit>
#include <cstdint>

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

/// Which traffic classes have a frame: bit q for class q.
using ClassSet = std::uint8_t;

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
    if (queue.frames > peak_frames_) peak_frames_ = queue.frames;
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

  /// The greatest number of frames that any one queue of the port has held.
  std::uint32_t peak_frames() const { return peak_frames_; }

 private:
  struct Queue {
    QueueEntryIndex head;
    QueueEntryIndex tail;
    std::uint32_t frames = 0;
    std::uint32_t octets = 0;
  };
  ClassSet waiting_ = 0;
  std::uint32_t peak_frames_ = 0;
  std::array<Queue, traffic_class_count> queues_;
};

inline TrafficClass highest_class(ClassSet set) { return static_cast<TrafficClass>(std::bit_width(set) - 1); }

}  // namespace takt::models
