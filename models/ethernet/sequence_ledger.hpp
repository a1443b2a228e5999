// SPDX-License-Identifier: Apache-2.0
// Which frames of a stream have reached a listener, however many copies of each there are.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace takt::models {

/// Remembers what is missing: the gaps between the sequence numbers that have come. Its memory is bounded: where there
/// are very many gaps, only the number of missing ones is kept of the older half, and a copy that comes so late fills
/// none.
class SequenceLedger {
 public:
  /// A copy of that frame has come.
  void arrive(std::uint64_t sequence) {
    if (sequence == next_) [[likely]]
      ++next_;
    else
      arrive_out_of_turn(sequence);
  }
  /// None has come of any frame.
  bool is_empty() const { return next_ == 0; }
  /// Whether one has.
  bool has(std::uint64_t sequence) const;
  /// Of the frames `first` .. `end` - 1, those of which no copy has come.
  std::uint64_t missing(std::uint64_t first, std::uint64_t end) const;

  /// To be looked at now and then: there are so many gaps that the older half should be folded.
  bool has_many_gaps() const { return gaps_.size() > most_gaps; }
  /// `boundaries` are the values of `first` that missing() will be asked.
  void fold(std::span<const std::uint64_t> boundaries);
  static constexpr std::size_t most_gaps = 1 << 16;

 private:
  struct Gap {
    std::uint64_t first;
    std::uint64_t last;
    std::uint64_t missing;  ///< of them; all, unless it was folded
    bool is_exact() const { return missing == last - first + 1; }
  };
  void arrive_out_of_turn(std::uint64_t sequence);
  std::size_t at_or_after(std::uint64_t sequence) const;

  std::uint64_t next_ = 0;  // after the greatest that has come
  std::vector<Gap> gaps_;   // ascending
};

}  // namespace takt::models
