// SPDX-License-Identifier: Apache-2.0
// Who is where: what is occupied on each link, for streams that repeat strictly.
//
// On a link the streams of one period stand in a row of their own, in order of their phases. Whether another stream
// fits is then a look into each row, at as many places as its period and the row's have between two common multiples.
// That costs little where periods divide each other, and never more than the repetitions themselves.
#pragma once

#include <vector>

#include "schedule/problem.hpp"

namespace takt::schedule {

/// Of how many places in one period a claim is looked at singly. Where it would be more, the search takes it as
/// blocking everywhere, which is too much and never too little.
inline constexpr Ps most_places = 100'000;

/// The periods of a problem, each once; streams name them by index.
class Periods {
 public:
  explicit Periods(const Problem& problem);
  Ps operator[](std::uint32_t index) const { return periods_[index]; }
  std::size_t size() const { return periods_.size(); }
  std::uint32_t of(StreamIndex stream) const { return of_stream_[stream]; }
  /// A stream more, behind all others.
  void add(Ps period);
  /// The last one is none any more.
  void drop_last() { of_stream_.pop_back(); }
  Ps common(std::uint32_t a, std::uint32_t b) const { return common_[a * periods_.size() + b]; }  ///< the gcd
 private:
  std::vector<Ps> periods_;
  std::vector<std::uint32_t> of_stream_;
  std::vector<Ps> common_;
};

class Board {
 public:
  struct Slot {
    Ps at = 0;  ///< phase within the period
    Ps length = 0;
    StreamIndex stream = 0;
  };
  struct Row {
    std::uint32_t period = 0;
    Ps longest = 0;           ///< of its slots, ever
    std::vector<Slot> slots;  ///< by phase
  };

  Board(const Periods& periods, std::size_t links) : periods_(&periods), rows_(links) {}

  void add(LinkIndex link, std::uint32_t period, Ps at, Ps length, StreamIndex stream);
  /// Precondition: it was added just so.
  void remove(LinkIndex link, std::uint32_t period, Ps at, StreamIndex stream);
  /// How much later than `at` something of that length and period must begin so as not to meet what it meets first; 0
  /// if it fits. A lower bound: what is there next is not asked.
  Ps push(LinkIndex link, std::uint32_t period, Ps at, Ps length) const;
  const std::vector<Row>& rows(LinkIndex link) const { return rows_[link]; }
  void clear() {
    for (auto& rows : rows_) rows.clear();
  }

  /// Calls see(stream, begin, end, every): whoever begins within (begin, end) modulo `every`, with that length, meets
  /// the stream.
  template <class See>
  void for_blocked(LinkIndex link, std::uint32_t period, Ps length, See see) const {
    for (const Row& row : rows_[link]) {
      const Ps every = periods_->common(period, row.period);
      for (const Slot& slot : row.slots) see(slot.stream, slot.at - length, slot.at + slot.length, every);
    }
  }

 private:
  const Periods* periods_;
  std::vector<std::vector<Row>> rows_;  ///< by link
};

}  // namespace takt::schedule
