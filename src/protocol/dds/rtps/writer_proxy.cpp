// SPDX-License-Identifier: Apache-2.0
#include "dds/rtps/writer_proxy.hpp"

#include <algorithm>

namespace takt::dds {

SequenceNumber WriterProxy::gap_end(SequenceNumber number) const {
  auto at = gaps.upper_bound(number);
  if (at == gaps.begin()) return number;
  --at;
  return std::max(at->second, number);
}

bool WriterProxy::is_missing(SequenceNumber number) const {
  return number >= next && gap_end(number) == number && !pending.contains(number);
}

SequenceNumberSet WriterProxy::missing() const {
  SequenceNumberSet set(next);
  if (is_blocked) return set;  // it would find no room again
  for (SequenceNumber number = next; number <= announced && set.can_hold(number); ++number)
    if (is_missing(number) && !reassemblies.contains(number)) set.insert(number);
  return set;
}

bool WriterProxy::lacks_anything() const {
  if (is_blocked) return false;
  for (SequenceNumber number = next; number <= announced;) {
    const SequenceNumber after = gap_end(number);
    if (after == number && !pending.contains(number)) return true;
    number = after == number ? number + 1 : after;
  }
  return std::any_of(reassemblies.begin(), reassemblies.end(), [](const auto& each) {
    return each.second.announced.value != 0 && !each.second.missing(each.second.announced).is_empty();
  });
}

bool WriterProxy::add_gap(SequenceNumber from, SequenceNumber to, const ReceiveLimits& limits) {
  from = std::max(from, next);
  if (from >= to) return true;
  auto at = gaps.upper_bound(to);  // the first range behind what [from, to) touches
  while (at != gaps.begin()) {
    const auto before = std::prev(at);
    if (before->second < from) break;
    from = std::min(from, before->first);
    to = std::max(to, before->second);
    at = gaps.erase(before);
  }
  if (gaps.size() >= limits.max_gaps) return false;
  gaps.emplace(from, to);
  return true;
}

void WriterProxy::tidy() {
  while (!pending.empty() && pending.begin()->first < next) {
    pending_octets -= pending.begin()->second.payload.size();
    pending.erase(pending.begin());
  }
  reassemblies.erase(reassemblies.begin(), reassemblies.lower_bound(next));
  while (!gaps.empty() && gaps.begin()->second <= next) gaps.erase(gaps.begin());
}

}  // namespace takt::dds
