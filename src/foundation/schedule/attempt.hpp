// SPDX-License-Identifier: Apache-2.0
// One attempt of the search (search.hpp), for strict repetition.
#pragma once

#include <deque>
#include <mutex>
#include <optional>
#include <vector>

#include "schedule/board.hpp"
#include "schedule/search.hpp"

namespace takt::schedule {

/// What all attempts know of a problem: first ways, and other ways once somebody asks.
class Ground {
 public:
  Ground(const Problem& problem, const SearchOptions& options);
  /// With one given way for each stream, and a start for those that stay where they are.
  Ground(const Problem& problem, const SearchOptions& options, std::vector<Way> ways,
         std::vector<std::optional<Ps>> fixed);

  const Problem& problem() const { return timing_.problem(); }
  const Timing& timing() const { return timing_; }
  const Periods& periods() const { return periods_; }
  const SearchOptions& options() const { return options_; }
  const std::optional<Way>& first(StreamIndex stream) const { return first_[stream]; }
  /// Thread-safe, and the same whoever asks when.
  const std::vector<Way>& ways(StreamIndex stream) const;
  /// Nothing: it may be moved.
  std::optional<Ps> fixed(StreamIndex stream) const { return fixed_.empty() ? std::nullopt : fixed_[stream]; }

 private:
  SearchOptions options_;
  Timing timing_;
  Periods periods_;
  Routes routes_;
  std::vector<std::optional<Way>> first_;
  std::vector<std::optional<Ps>> fixed_;
  mutable std::deque<std::once_flag> asked_;
  mutable std::vector<std::vector<Way>> ways_;
};

/// Where a stream stands.
struct Stand {
  const Way* way = nullptr;  ///< of the ground; null: not placed
  Ps at = 0;                 ///< start at the talker
  std::vector<Ps> starts;    ///< by link, if it waits somewhere; else the lags of the way say them
  Ps start(std::size_t hop) const { return starts.empty() ? at + way->lags[hop] : starts[hop]; }
};

class Attempt {
 public:
  Attempt(const Ground& ground, std::uint32_t number);

  /// Places all streams, or as many as it can: it gives up after so many steps without a stream more than ever before.
  /// True if all are placed.
  bool run(std::uint64_t most_steps, const Stop& stop);
  /// Each stream once, nobody taken out. True if all are placed.
  bool place_all_once();

  const std::vector<Stand>& stands() const { return stands_; }
  std::vector<LeftOver> left_over();
  std::size_t most_placed() const { return best_count_; }
  std::uint64_t steps() const { return steps_; }
  /// By stream: one, and one more for each time that it was taken out. Those that are dear are hard to place together.
  const std::vector<std::uint64_t>& prices() const { return price_; }
  Solution solution() const;

 private:
  struct Edge {
    Ps at;
    StreamIndex stream;
    std::int32_t change;
  };
  /// Starts from `from` until before `until`, and all that are multiples of `every` later, meet the other one.
  struct Span {
    Ps from, until, every;
    StreamIndex other;
  };
  struct Spot {
    Stand stand;
    std::uint64_t cost = ~std::uint64_t{0};
  };
  /// What it costs to be on a link from `at` on, until the next piece; over one period.
  struct Piece {
    Ps at;
    std::uint64_t cost;
  };
  /// A start on a link, behind one on the link before in the way.
  struct Label {
    Ps at;
    std::uint64_t cost;  ///< of all so far
    std::uint32_t before;
  };

  std::vector<StreamIndex> order();
  bool place_free(StreamIndex stream, bool at_random);
  void put(StreamIndex stream, Stand stand);
  void remove_stream(StreamIndex stream);
  Spot cheapest(StreamIndex stream);
  void look_for_cheaper(StreamIndex stream, const Way& way, Spot& best);
  void look_for_cheaper_waiting(StreamIndex stream, const Way& way, Spot& best);
  void cut_into_pieces(StreamIndex stream, const Way& way);
  const Piece& piece_at(std::size_t hop, Ps phase) const;
  bool is_as_cheap(std::uint64_t cost, const Spot& best);
  void find_conflicts(StreamIndex stream, const Stand& stand, std::vector<StreamIndex>& found) const;
  bool assign_classes();
  void perturb();
  void remember_best();

  const Ground& ground_;
  std::uint32_t number_;
  sim::RandomStream random_;
  Board board_;
  std::vector<Stand> stands_;
  std::vector<Stand> best_;
  std::size_t placed_ = 0;
  std::size_t best_count_ = 0;
  std::uint64_t steps_ = 0;
  std::uint64_t ties_ = 0;
  std::vector<std::uint64_t> price_;  ///< of taking a stream out
  std::vector<Edge> edges_;
  std::vector<std::uint32_t> covers_;  ///< by stream, while edges are swept
  std::vector<Span> spans_;
  std::vector<std::uint32_t> last_span_;  ///< by stream, while spans are made: index of its last one, counted from 1
  bool waits_ = false;
  std::vector<std::vector<Piece>> pieces_;  ///< by hop
  std::vector<std::vector<Label>> labels_;  ///< by hop
  std::vector<Ps> roots_;
  std::vector<std::vector<std::uint8_t>> classes_;  ///< by stream and link of its way, if somebody waits
};

}  // namespace takt::schedule
