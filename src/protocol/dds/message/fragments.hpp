// SPDX-License-Identifier: Apache-2.0
// How a sample is cut into fragments (DDSI-RTPS 8.3.7.3, 8.4.14.1): all of one size, but for the last.
#pragma once

#include <algorithm>

#include "dds/message/submessage.hpp"
#include "sim/check.hpp"

namespace takt::dds {

/// Fragments of a sample; `fragment_size` is not 0.
constexpr std::uint32_t fragment_count(std::uint32_t sample_size, std::uint16_t fragment_size) {
  return static_cast<std::uint32_t>((std::uint64_t{sample_size} + fragment_size - 1) / fragment_size);
}

/// Where fragments lie in the sample; `first` + `count` - 1 is at most fragment_count().
struct FragmentRange {
  std::size_t begin = 0;
  std::size_t size = 0;
};
constexpr FragmentRange range_of(FragmentNumber first, std::uint32_t count, std::uint16_t fragment_size,
                                 std::uint32_t sample_size) {
  const std::size_t begin = std::size_t{first.value - 1} * fragment_size;
  return {begin, std::min<std::size_t>(std::size_t{count} * fragment_size, sample_size - begin)};
}

/// The submessage that carries `count` fragments of a sample, from `first` on. Ids and sequence number are the
/// caller's.
inline DataFrag fragments_of(Octets sample, FragmentNumber first, std::uint16_t count, std::uint16_t fragment_size) {
  const auto size = static_cast<std::uint32_t>(sample.size());
  TAKT_CHECK(
      first.value != 0 && count != 0 && std::uint64_t{first.value} + count - 1 <= fragment_count(size, fragment_size),
      "fragments are those of the sample");
  DataFrag fragment;
  fragment.first_fragment = first;
  fragment.fragment_count = count;
  fragment.fragment_size = fragment_size;
  fragment.sample_size = size;
  const FragmentRange range = range_of(first, count, fragment_size, size);
  fragment.payload = sample.subspan(range.begin, range.size);
  return fragment;
}

}  // namespace takt::dds
