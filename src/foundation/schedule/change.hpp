// SPDX-License-Identifier: Apache-2.0
// Changing a schedule that runs: streams come, go and take other ways, and all others stay where they are.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "schedule/board.hpp"
#include "schedule/routes.hpp"

namespace takt::schedule {

/// Why a schedule cannot be changed here; empty: it can. Frames that wait in bridges, and repetitions that differ, are
/// not moved one by one.
std::string why_not_changeable(const Problem& problem, const Solution& solution);

class Plant {
 public:
  /// Precondition: `solution` is a schedule of `problem`, and why_not_changeable() is empty.
  Plant(Problem problem, const Solution& solution);
  Plant(const Plant&) = delete;
  Plant& operator=(const Plant&) = delete;

  /// A stream more, where nobody has to move, or else where one other stream has to; that one is named. Nothing, and no
  /// change, if there is no such place.
  struct Added {
    StreamIndex stream = 0;
    std::vector<StreamIndex> moved;
  };
  std::optional<Added> add(Stream stream);
  /// The streams behind it keep their indices; it is scheduled no longer.
  void remove(StreamIndex stream);
  /// The link is gone. All streams that came over it get other ways, prescribed or not, if they can; the others stay.
  struct Rerouted {
    std::vector<StreamIndex> moved;
    std::vector<StreamIndex> lost;  ///< without a way or a place: scheduled no longer
  };
  Rerouted fail(LinkIndex link);

  const Problem& problem() const { return problem_; }
  bool is_scheduled(StreamIndex stream) const { return ways_[stream].has_value(); }
  /// Of all that are scheduled.
  Solution solution() const;

 private:
  bool place(StreamIndex stream);
  bool place_by_moving_one(StreamIndex stream, std::vector<StreamIndex>& moved);
  std::vector<Way> ways_of(StreamIndex stream);
  void put(StreamIndex stream, Way way, Ps at);
  void remove_stream(StreamIndex stream);

  Problem problem_;
  Timing timing_;
  Periods periods_;
  Board board_;
  Routes routes_;
  std::vector<std::optional<Way>> ways_;  ///< by stream
  std::vector<Ps> at_;
};

}  // namespace takt::schedule
