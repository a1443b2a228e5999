// SPDX-License-Identifier: Apache-2.0
// What goes wrong on one direction of a link: chance that harms frames, and times in which the link is down.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "models/ethernet/frame.hpp"
#include "models/fault/loss_models.hpp"
#include "sim/random.hpp"
#include "sim/time.hpp"

namespace takt::models {

/// Chance on a link, while it lasts.
struct Impairment {
  std::optional<LossModel> loss;
  std::optional<Corruption> corruption;
  std::optional<Duplication> duplication;
  sim::TrueTime from;                            ///< for frames that arrive at or after it
  sim::TrueTime until = sim::TrueTime::never();  ///< and before it
};

class LinkFault {
 public:
  /// `path` names the direction in the random streams, e.g. "sw1 to sw2".
  LinkFault(std::uint64_t seed, std::string_view path) : chance_(seed, path, "link") {}

  void add(const Impairment& impairment) { impairments_.push_back(impairment); }
  bool is_impaired() const { return !impairments_.empty(); }

  bool is_up() const { return up_; }
  void set_up(sim::TrueTime now, bool up) {
    if (up_ && !up) downs_.push_back(now);
    up_ = up;
  }
  /// Whether the link went down while a frame was on it whose first bit left at `start` and whose last bit came at
  /// `end`.
  bool went_down_within(sim::TrueTime start, sim::TrueTime end) const {
    for (std::size_t i = downs_.size(); i-- > 0 && downs_[i] > start;)
      if (downs_[i] <= end) return true;
    return false;
  }

  /// What chance does to a frame that arrives. Every impairment draws for every frame, so that one does not move
  /// another's luck.
  struct Fate {
    bool lost = false;
    bool damaged = false;
    bool doubled = false;
  };
  Fate fate_of(Octets length, sim::TrueTime arrival) {
    Fate fate;
    for (Impairment& impairment : impairments_) {
      const bool counts = arrival >= impairment.from && arrival < impairment.until;
      const bool is_lost = impairment.loss && lost(*impairment.loss, chance_);
      const bool is_damaged = impairment.corruption && impairment.corruption->corrupts(length, chance_);
      const bool is_doubled = impairment.duplication && impairment.duplication->duplicates(chance_);
      fate.lost |= counts && is_lost;
      fate.damaged |= counts && is_damaged;
      fate.doubled |= counts && is_doubled;
    }
    return fate;
  }

  /// A frame is being passed on before its last bit has come, at `last_bit`.
  void cut_through(FrameIndex index, const Frame& frame, sim::TrueTime now, sim::TrueTime last_bit) {
    std::erase_if(passing_, [&](const Passing& passing) { return passing.last_bit < now; });
    passing_.push_back({index, frame.stream, frame.sequence, last_bit});
  }
  /// Marks the frames as damaged whose last bit has not come and will not. Some may have ended already: their records
  /// bear another name then.
  template <class FrameOf>
  void break_passing(sim::TrueTime now, const FrameOf& frame_of) {
    for (const Passing& passing : passing_) {
      Frame* const frame = frame_of(passing.index);
      if (frame != nullptr && passing.last_bit >= now && frame->references > 0 && frame->stream == passing.stream &&
          frame->sequence == passing.sequence)
        frame->bad_fcs = true;
    }
    passing_.clear();
  }

 private:
  struct Passing {
    FrameIndex index;
    StreamIndex stream;
    std::uint64_t sequence = 0;
    sim::TrueTime last_bit;
  };
  sim::RandomStream chance_;
  std::vector<Impairment> impairments_;
  std::vector<sim::TrueTime> downs_;  // ascending
  std::vector<Passing> passing_;
  bool up_ = true;
};

}  // namespace takt::models
