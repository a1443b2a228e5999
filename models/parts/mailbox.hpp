// SPDX-License-Identifier: Apache-2.0
// Frames on their way from one part of a divided run to another, and until when no more of them will come.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <vector>

#include "models/ethernet/frame.hpp"
#include "sim/event.hpp"
#include "sim/time.hpp"

namespace takt::models {

/// A frame that crosses from part to part: its event at the receiver, its record, and where its octets are, if it has
/// any.
struct Parcel {
  sim::Event arrival;
  Frame frame;
  std::size_t octets_from = 0;  ///< in Consignment::octets
  std::uint16_t octets = 0;
};

struct Consignment {
  std::vector<Parcel> parcels;
  std::vector<std::byte> octets;  ///< of payloads, one behind another
  bool empty() const { return parcels.empty(); }
  void clear() {
    parcels.clear();
    octets.clear();
  }
};

/// One direction between two parts: one thread posts, another takes.
class alignas(64) Mailbox {
 public:
  /// Posts what is in `consignment`, which is empty then, and promises: nothing that is posted later comes before
  /// `promise`.
  void post(Consignment& consignment, sim::TrueTime promise) {
    if (!consignment.empty()) {
      const std::lock_guard lock(mutex_);
      if (waiting_.empty())
        std::swap(waiting_, consignment);
      else
        append(consignment);
      consignment.clear();
      has_mail_.store(true, std::memory_order_relaxed);
    }
    promise_.store(promise.ps());  // sequentially consistent: see Bell
  }

  /// Until when nothing comes but what take() gives when it is called afterwards.
  sim::TrueTime promise() const { return sim::TrueTime::from_ps(promise_.load()); }

  /// What has been posted, into `consignment`, which is empty before. False if nothing was.
  bool take(Consignment& consignment) {
    if (!has_mail_.load(std::memory_order_relaxed)) return false;
    const std::lock_guard lock(mutex_);
    std::swap(waiting_, consignment);
    has_mail_.store(false, std::memory_order_relaxed);
    return true;
  }

 private:
  void append(const Consignment& more) {
    for (Parcel parcel : more.parcels) {
      parcel.octets_from += waiting_.octets.size();
      waiting_.parcels.push_back(parcel);
    }
    waiting_.octets.insert(waiting_.octets.end(), more.octets.begin(), more.octets.end());
  }

  std::atomic<std::int64_t> promise_{0};
  std::atomic<bool> has_mail_{false};
  alignas(64) std::mutex mutex_;
  Consignment waiting_;
};

}  // namespace takt::models
