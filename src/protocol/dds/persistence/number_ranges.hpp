// SPDX-License-Identifier: Apache-2.0
// NumberRanges: which changes of a writer were delivered, whoever brought them.
#pragma once

#include <map>

#include "dds/message/sequence_number.hpp"

namespace takt::dds {

/// Ranges of sequence numbers, few if a writer's changes come in order. Beyond `most` ranges the lowest two count as
/// one.
class NumberRanges {
 public:
  static constexpr std::size_t most = 256;

  bool contains(SequenceNumber number) const {
    const auto after = ends_.upper_bound(number);
    return after != ends_.begin() && std::prev(after)->second >= number;
  }
  void insert(SequenceNumber number) { insert(number, number); }
  void insert(SequenceNumber first, SequenceNumber last) {
    auto at = ends_.upper_bound(last + 1);
    while (at != ends_.begin() && std::prev(at)->second + 1 >= first) {
      at = std::prev(at);
      first = std::min(first, at->first);
      last = std::max(last, at->second);
      at = ends_.erase(at);
    }
    ends_.emplace(first, last);
    if (ends_.size() <= most) return;
    const auto second = std::next(ends_.begin());
    ends_.begin()->second = second->second;
    ends_.erase(second);
  }
  bool empty() const { return ends_.empty(); }
  /// First and last number of each range, ascending.
  const std::map<SequenceNumber, SequenceNumber>& ranges() const { return ends_; }

 private:
  std::map<SequenceNumber, SequenceNumber> ends_;
};

}  // namespace takt::dds
