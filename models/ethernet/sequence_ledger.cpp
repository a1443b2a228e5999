// SPDX-License-Identifier: Apache-2.0
#include "models/ethernet/sequence_ledger.hpp"

#include <algorithm>

namespace takt::models {

/// The first gap that does not end before the sequence number.
std::size_t SequenceLedger::at_or_after(std::uint64_t sequence) const {
  const auto found = std::lower_bound(gaps_.begin(), gaps_.end(), sequence,
                                      [](const Gap& gap, std::uint64_t s) { return gap.last < s; });
  return static_cast<std::size_t>(found - gaps_.begin());
}

void SequenceLedger::arrive_out_of_turn(std::uint64_t sequence) {
  if (sequence > next_) {
    gaps_.push_back({next_, sequence - 1, sequence - next_});
    next_ = sequence + 1;
    return;
  }
  const std::size_t at = at_or_after(sequence);
  if (at == gaps_.size() || gaps_[at].first > sequence || !gaps_[at].is_exact()) return;
  const Gap gap = gaps_[at];
  const auto place = gaps_.begin() + static_cast<std::ptrdiff_t>(at);
  if (gap.first == gap.last) {
    gaps_.erase(place);
  } else if (sequence == gap.first) {
    *place = {gap.first + 1, gap.last, gap.missing - 1};
  } else if (sequence == gap.last) {
    *place = {gap.first, gap.last - 1, gap.missing - 1};
  } else {
    *place = {sequence + 1, gap.last, gap.last - sequence};
    gaps_.insert(gaps_.begin() + static_cast<std::ptrdiff_t>(at), {gap.first, sequence - 1, sequence - gap.first});
  }
}

bool SequenceLedger::has(std::uint64_t sequence) const {
  if (sequence >= next_) return false;
  const std::size_t at = at_or_after(sequence);
  return at == gaps_.size() || gaps_[at].first > sequence || !gaps_[at].is_exact();
}

std::uint64_t SequenceLedger::missing(std::uint64_t first, std::uint64_t end) const {
  std::uint64_t sum = end > next_ ? end - std::max(next_, first) : 0;
  for (std::size_t i = at_or_after(first); i < gaps_.size() && gaps_[i].first < end; ++i) {
    const Gap& gap = gaps_[i];
    sum += gap.is_exact() ? std::min(gap.last, end - 1) - std::max(gap.first, first) + 1 : gap.missing;
  }
  return sum;
}

void SequenceLedger::fold(std::span<const std::uint64_t> boundaries) {
  const auto half = gaps_.begin() + static_cast<std::ptrdiff_t>(gaps_.size() / 2);
  std::vector<Gap> folded;
  for (auto gap = gaps_.begin(); gap != half; ++gap) {
    const bool may_join =
        !folded.empty() && std::none_of(boundaries.begin(), boundaries.end(), [&](std::uint64_t boundary) {
          return boundary > folded.back().first && boundary <= gap->last;
        });
    if (may_join) {
      folded.back().last = gap->last;
      folded.back().missing += gap->missing;
    } else {
      folded.push_back(*gap);
    }
  }
  folded.insert(folded.end(), half, gaps_.end());
  gaps_ = std::move(folded);
}

}  // namespace takt::models
