// SPDX-License-Identifier: Apache-2.0
#include "gateway/channel.hpp"

#include <numeric>

namespace takt::gateway {

std::uint64_t ChannelFigures::mapping_error_total() const {
  return std::accumulate(mapping_errors.begin(), mapping_errors.end(), std::uint64_t{0});
}

MappingError Channel::receive(Octets value, sim::LocalTime now) {
  const MappingError error = mapping_.convert(value, mapped_);
  if (error == MappingError::none)
    buffer_.push(mapped_, now);
  else
    ++errors_[static_cast<std::size_t>(error)];
  return error;
}

}  // namespace takt::gateway
