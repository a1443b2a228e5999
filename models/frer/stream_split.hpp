// SPDX-License-Identifier: Apache-2.0
// Splits a compound stream: numbers its frames and makes one frame of each for every member (IEEE 802.1CB
// clauses 7.4.1, 7.7).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "models/ethernet/traffic.hpp"
#include "models/frer/redundancy_config.hpp"
#include "models/frer/sequence_generation.hpp"

namespace takt::models {

class StreamSplit {
 public:
  /// `where`: the component that records name as the place.
  explicit StreamSplit(const StreamSplitConfig& config, sim::ComponentId where = {})
      : config_(config), where_(where), frames_(config.members.size()) {
    TAKT_CHECK(!config_.members.empty(), "a stream is split into members");
  }

  static constexpr std::uint16_t any_port = 0xFFFF;

  /// One frame for each member, in their order, but none for those that would leave by the port `except`; the caller's
  /// copy of the frame is one of them. They differ in destination and VLAN, carry the same R-TAG, and are 6 octets
  /// longer than the frame was unless it had one. Each further one counts among the stream's copies. The span lives
  /// until the next call.
  std::span<const FrameIndex> split(Traffic& traffic, FrameIndex frame, std::uint16_t except = any_port) {
    ++counters_.frames;
    const Frame& original = traffic.frame(frame);
    const SequenceNumber number = original.r_tagged ? original.r_tag_sequence : generation_.next();
    std::size_t last = config_.members.size();
    while (last-- > 0 && is_left_out(last, except)) {
    }
    TAKT_CHECK(last < config_.members.size(),
               "a stream is split into members that leave by other ports than it came by");
    if (original.references == 1) tag(traffic, frame, number);  // once for all members
    std::size_t made = 0;
    for (std::size_t i = 0; i <= last; ++i) {
      if (is_left_out(i, except)) continue;
      frames_[made] = i < last ? traffic.duplicate(frame, where_) : traffic.own(frame, where_);
      address(traffic, frames_[made], config_.members[i], number);
      ++made;
    }
    counters_.copies += made - 1;
    return std::span(frames_).first(made);
  }

  struct Counters {
    std::uint64_t frames = 0;  ///< of the compound stream
    std::uint64_t copies = 0;  ///< made beyond them
    bool operator==(const Counters&) const = default;
  };
  const Counters& counters() const { return counters_; }
  const StreamSplitConfig& config() const { return config_; }
  SequenceGeneration& sequence_generation() { return generation_; }

 private:
  bool is_left_out(std::size_t member, std::uint16_t except) const {
    return except != any_port && config_.members[member].port == except;
  }
  static void address(Traffic& traffic, FrameIndex index, const StreamMember& member, SequenceNumber number) {
    Frame& frame = traffic.frame(index);
    frame.on_route = false;
    frame.destination = member.destination;
    frame.vlan = member.vlan;
    if (!frame.r_tagged) tag(traffic, index, number);
  }
  static void tag(Traffic& traffic, FrameIndex index, SequenceNumber number) {
    Frame& frame = traffic.frame(index);
    frame.r_tag_sequence = number;
    traffic.set_tags(index, frame.tagged, true);
  }

  StreamSplitConfig config_;
  sim::ComponentId where_;
  SequenceGeneration generation_;
  Counters counters_;
  std::vector<FrameIndex> frames_;
};

}  // namespace takt::models
