// SPDX-License-Identifier: Apache-2.0
// Tells recorders what tapes hold: in one order, whatever the number of tapes.
//
// Records are told by time, those of one instant node by node, those of one node in the order in which they came about.
// What happens at a node at one instant comes about in the same order on one thread and in whatever part of a divided
// run the node is; what happens at other nodes at that instant comes before or after it, as threads have it. So files
// are the same, octet for octet, for every division.
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "models/moment.hpp"
#include "output/tape.hpp"

namespace takt::output {

class Playback {
 public:
  /// Both outlive it. Recorders look at moment().
  explicit Playback(sim::TraceSink& sink) : sink_(&sink) {}
  Playback(const Playback&) = delete;
  Playback& operator=(const Playback&) = delete;

  /// A further part, in the order of their numbers; before anything is told. The tape outlives this.
  void add(Tape& tape);
  const models::Moment& moment() const { return moment_; }

  /// Tells what has happened up to and including `until`, to which all parts have come, and forgets it. Nothing happens
  /// meanwhile.
  void play(sim::TrueTime until);

 private:
  /// A note, by what it is ordered.
  struct Place {
    sim::TrueTime time;
    bool is_happening = true;  // not there already
    std::uint32_t node = 0;
    std::uint32_t tape = 0;
    std::uint32_t note = 0;
  };
  struct Part {
    Tape* tape = nullptr;
    std::vector<std::uint32_t> record_of_life;  // as which record of a frame recorders know it
    std::vector<std::uint32_t> ended;           // lives
  };
  static std::uint64_t way_of(std::uint32_t from, std::uint32_t to) { return std::uint64_t{from} << 32 | to; }
  void tell(Part& part, const Note& note);
  void emit_record(Part& part, const Note& note);
  std::uint32_t begin_record();
  std::uint32_t& record_of(Part& part, std::uint32_t life);
  void end_instant(sim::TrueTime time);

  sim::TraceSink* sink_;
  models::Moment moment_;
  std::vector<Part> parts_;
  std::vector<Place> places_;           // kept for its room
  std::vector<std::uint32_t> holders_;  // by record: the lives that it has in all parts, and copies between them
  std::vector<std::uint32_t> free_records_;
  std::vector<std::uint32_t> ends_;  // records of which a life ends at the present instant
  std::unordered_map<std::uint64_t, std::unordered_map<std::uint64_t, std::uint32_t>>
      under_way_;  // records of frames between two parts, by number
};

}  // namespace takt::output
