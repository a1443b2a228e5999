// SPDX-License-Identifier: Apache-2.0
#include "models/egress/preemption.hpp"

namespace takt::models {

FragmentHeader FragmentSequence::start_frame() {
  const FragmentHeader header{smd_s[next_frame_], std::nullopt};
  next_frame_ = static_cast<std::uint8_t>((next_frame_ + 1) % 4);
  next_continuation_ = 0;
  return header;
}

FragmentHeader FragmentSequence::continue_frame() {
  const FragmentHeader header{smd_c[(next_frame_ + 3) % 4], frag_count[next_continuation_]};
  next_continuation_ = static_cast<std::uint8_t>((next_continuation_ + 1) % 4);
  return header;
}

}  // namespace takt::models
