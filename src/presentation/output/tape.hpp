// SPDX-License-Identifier: Apache-2.0
// What happens in a network, or in one part of a divided run, kept until recorders are told of it in an order of its
// own: see playback.hpp.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <memory>
#include <unordered_map>
#include <vector>

#include "models/moment.hpp"
#include "models/parts/crossing_watcher.hpp"
#include "models/port_directory.hpp"
#include "output/gate_follower.hpp"
#include "sim/trace.hpp"

namespace takt::output {

/// What of all that happens somebody will be told of.
struct TapeWants {
  std::uint32_t kinds = 0;  ///< bit k: records of the models::Occurrence of number k; those of gates_shown and ended
                            ///< come by the following
  bool ways = false;        ///< which record of a frame was made of which: all kinds are told then, and
                            ///< Network::trace_paths() has been called
  bool gates = false;       ///< gates_shown
  bool payloads = false;    ///< octets of frames that start
  bool queues = false;      ///< how many frames wait
  sim::TrueTime from = {};  ///< records outside of this stretch are left out, unless ways are wanted
  sim::TrueTime to = sim::TrueTime::never();

  static constexpr std::uint32_t bits_of(std::initializer_list<models::Occurrence> kinds) {
    std::uint32_t bits = 0;
    for (const models::Occurrence kind : kinds) bits |= 1U << static_cast<std::uint32_t>(kind);
    return bits;
  }
};

/// Something on a tape, with all that recorders need to know of it, since the network goes on meanwhile.
struct Note {
  enum class Kind : std::uint8_t {
    told,  ///< a trace record
    left,  ///< a copy of a frame leaves for another part
    came,  ///< it goes on here
    over,  ///< the last copy with that record has left
  };
  static constexpr std::uint32_t none = 0xFFFF'FFFF;
  sim::TraceRecord
      record;  ///< of left and came: `where` is the part at the other end, `what` counts the frames of that direction
  std::uint32_t node = none;  ///< where it happens; none: in an application
  Kind kind = Kind::told;
  bool is_there_already = false;  ///< it was so before anything happened: told before all that happens at that instant
  bool is_last = false;           ///< no copy of the frame shares its record any more
  std::uint32_t life =
      none;  ///< of the record of a frame, from when it is made to when it is free; none: nobody follows it
  std::uint32_t parent = none;    ///< of separated: the life of the record before
  std::uint32_t frame = none;     ///< in Tape::frames
  std::uint32_t octets_from = 0;  ///< in Tape::octets
  std::uint32_t octets = 0;
  std::uint32_t queued_frames = 0;
  std::uint32_t delays = none;  ///< in Tape::delays
};

/// Of one network, by one thread. Hangs on its simulation (and on its part of a divided run) from before the first
/// event, or, for gates alone, from any instant on.
class Tape final : public sim::TraceSink, public models::CrossingWatcher {
 public:
  /// `part`: which part of a divided run the network is. The network outlives the tape.
  Tape(models::Network& network, std::uint32_t part, const TapeWants& wants);
  ~Tape() override;
  Tape(const Tape&) = delete;
  Tape& operator=(const Tape&) = delete;

  void record(const sim::TraceRecord& record) override;
  void left(std::uint32_t to, const sim::Event& arrival, models::FrameIndex frame) override;
  void came(std::uint32_t from, const sim::Event& arrival, models::FrameIndex frame) override;
  void over(models::FrameIndex frame) override;

  // While nothing happens in the network, for Playback.
  /// All that happens up to and including `now` has happened.
  void complete(sim::TrueTime now) {
    if (gates_) follow_gates(now + sim::Duration::from_ps(1));
  }
  std::uint32_t part() const { return part_; }
  const std::vector<Note>& notes() const { return notes_; }
  const models::Frame& frame(const Note& note) const { return frames_[note.frame]; }
  std::span<const std::byte> octets(const Note& note) const {
    return std::span(octets_).subspan(note.octets_from, note.octets);
  }
  struct Delays {
    sim::Duration delay;
    sim::Duration node_delay;
  };
  Delays delays(const Note& note) const { return note.delays == Note::none ? Delays{} : delays_[note.delays]; }
  std::size_t lives() const { return lives_; }
  /// Forgets what is not after `until`, and uses those numbers of lives again. What is later has neither frame nor
  /// octets.
  void forget(sim::TrueTime until, const std::vector<std::uint32_t>& ended_lives);

 private:
  /// Of a node whose gates go by a clock of its own.
  struct ClockOfGates final : models::ClockListener {
    void clock_will_change(const models::LocalClock&, sim::TrueTime now) override { tape->follow_gates(now); }
    void clock_changed(const models::LocalClock&, sim::TrueTime now) override { tape->clock_changed(*this, now); }
    Tape* tape = nullptr;
    models::NodeIndex node;
    std::vector<std::uint32_t> positions;  // of its ports
  };
  void follow_gates(sim::TrueTime until);
  void show_gates(std::uint32_t position, sim::TrueTime at, bool is_there_already = false);
  void clock_changed(const ClockOfGates& clock, sim::TrueTime now);
  std::uint32_t node_of(const sim::TraceRecord& record) const;
  void keep_frame(Note& note, const models::Frame& frame);
  void name_life(Note& note, const models::Frame& frame);
  std::uint32_t begin_life(std::uint32_t handle);
  std::uint32_t life_of(std::uint32_t handle) const {
    return handle < life_of_handle_.size() ? life_of_handle_[handle] : Note::none;
  }

  models::Network* network_;
  std::uint32_t part_;
  TapeWants wants_;
  models::PortDirectory directory_;
  std::vector<models::NodeIndex> node_of_component_;
  std::unique_ptr<GateFollower> gates_;  // null: nobody asks for gates
  std::vector<std::unique_ptr<ClockOfGates>> clocks_;
  std::vector<Note> notes_;
  std::vector<models::Frame> frames_;
  std::vector<std::byte> octets_;
  std::vector<Delays> delays_;
  std::vector<std::uint32_t> life_of_handle_;
  std::vector<std::uint32_t> free_lives_;
  std::size_t lives_ = 0;                                      // that there are numbers for
  std::unordered_map<std::uint32_t, std::uint64_t> left_for_;  // how many frames, by part
  std::unordered_map<std::uint32_t, std::uint64_t> came_from_;
};

}  // namespace takt::output
