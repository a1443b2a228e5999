// SPDX-License-Identifier: Apache-2.0
#include "dds/rtps/reassembly.hpp"

#include <algorithm>

namespace takt::dds {

bool Reassembly::add(const DataFrag& fragment, sim::LocalTime source) {
  const auto sample_size = static_cast<std::uint32_t>(payload_.size());
  const std::uint64_t last = std::uint64_t{fragment.first_fragment.value} + fragment.fragment_count - 1;
  if (fragment.sample_size != sample_size || fragment.fragment_size != fragment_size_ ||
      fragment.first_fragment.value == 0 || last > is_there_.size())
    return false;
  const FragmentRange range = range_of(fragment.first_fragment, fragment.fragment_count, fragment_size_, sample_size);
  if (fragment.payload.size() < range.size) return false;
  std::copy_n(fragment.payload.begin(), range.size, payload_.begin() + static_cast<std::ptrdiff_t>(range.begin));
  for (std::uint64_t i = fragment.first_fragment.value; i <= last; ++i) {
    if (is_there_[i - 1]) continue;
    is_there_[i - 1] = true;
    ++there_;
  }
  if (fragment.first_fragment.value == 1) inline_qos_ = fragment.inline_qos;
  payload_kind_ = fragment.payload_kind;
  source_ = source;
  return true;
}

FragmentNumberSet Reassembly::missing(FragmentNumber last) const {
  const std::size_t end = last.value == 0 ? is_there_.size() : std::min<std::size_t>(last.value, is_there_.size());
  std::size_t first = 0;
  while (first < end && is_there_[first]) ++first;
  FragmentNumberSet set(FragmentNumber{static_cast<std::uint32_t>(first + 1)});
  for (std::size_t i = first; i < end; ++i) {
    if (is_there_[i]) continue;
    if (!set.insert(FragmentNumber{static_cast<std::uint32_t>(i + 1)})) break;
  }
  return set;
}

}  // namespace takt::dds
