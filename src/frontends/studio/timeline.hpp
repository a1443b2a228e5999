// SPDX-License-Identifier: Apache-2.0
// What happened in a run, in memory, for a page that scrolls through it: what each port sent, its gates, the states of
// Programs. The page asks for pieces, which hold every frame where there are few and how busy the port was where there
// are many.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scenario/resolved/resolved.hpp"
#include "sim/time.hpp"

namespace takt::studio {

class Timeline {
 public:
  /// What is kept at most; where there is more the timeline ends before the run.
  struct Limits {
    std::uint64_t frames = 8'000'000;        ///< on ports, fragments and drops: 24 octets each
    std::uint64_t gate_changes = 4'000'000;  ///< 16 octets each
  };
  /// A frame on a port, a part of one that was cut, or one that was dropped there.
  struct Sent {
    static constexpr std::uint32_t continued = 1;  ///< flags: the rest of one that was cut
    static constexpr std::uint32_t cut = 2;
    static constexpr std::uint32_t dropped = 4;  ///< and takes no time
    std::int64_t start = 0;                      ///< ps
    float length = 0;                            ///< ps, preamble included
    std::uint32_t stream = 0;
    std::uint32_t sequence = 0;  ///< the low 32 bits
    std::uint32_t flags = 0;     ///< and from bit 8 on its traffic class
  };
  /// Bit q of `open`: the gate of class q is open from that time on.
  struct Gates {
    std::int64_t at = 0;
    std::uint32_t open = 0;
  };
  struct Row {
    std::string node;
    std::uint16_t port = 0;
    std::string peer;
    std::vector<Sent> sent;    ///< by start
    std::vector<Gates> gates;  ///< by time; none: it has none
  };
  struct Track {
    std::string program;
    std::string name;                                          ///< of the participant, or "reactions"
    std::vector<std::pair<std::int64_t, std::string>> states;  ///< from that time on; an empty text: none
  };

  /// Runs the scenario and keeps what happens from `from` on. Null if it was interrupted.
  static std::unique_ptr<Timeline> record(const scenario::Resolved& resolved, sim::TrueTime from, const Limits& limits,
                                          const std::function<bool()>& interrupted);

  /// JSON: {"from_ps", "to_ps", "whole": it reaches the end of the run, "frames": number, "streams": names, "rows":
  /// [{"node", "port", "to", "gates"}], "tracks": [{"program", "name", "states": [[ps, name]]}]}.
  std::string summary() const;

  /// Part number `index` of the time, which is halved `level` times, of `count` rows from `first` on; octets as
  /// docs/studio.md says. What is not there is empty.
  std::string piece(unsigned level, std::uint64_t index, std::size_t first, std::size_t count) const;
  static constexpr unsigned greatest_level = 40;
  static constexpr std::size_t most_rows = 64;  ///< of a piece

  const std::vector<Row>& rows() const { return rows_; }
  const std::vector<Track>& tracks() const { return tracks_; }
  sim::TrueTime from() const { return from_; }
  sim::TrueTime to() const { return to_; }

 private:
  friend class TimelineSink;
  std::vector<Row> rows_;
  std::vector<Track> tracks_;
  std::vector<std::string> streams_;
  sim::TrueTime from_;
  sim::TrueTime to_;
  bool is_whole_ = true;
  std::uint64_t frames_ = 0;
};

}  // namespace takt::studio
