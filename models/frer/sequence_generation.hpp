// SPDX-License-Identifier: Apache-2.0
// The sequence generation function (IEEE 802.1CB clause 7.4.1): numbers the frames of a compound stream.
#pragma once

#include <cstdint>

#include "models/frer/r_tag.hpp"

namespace takt::models {

class SequenceGeneration {
 public:
  /// The number of the next frame: 0, 1, ... 65535, 0, ...
  SequenceNumber next() { return next_++; }
  /// SequenceGenerationReset (7.4.1.3).
  void reset() {
    next_ = 0;
    ++resets_;
  }
  std::uint64_t resets() const { return resets_; }

 private:
  std::uint64_t resets_ = 0;  // frerCpsSeqGenResets; the start is none
  SequenceNumber next_ = 0;   // GenSeqNum
};

}  // namespace takt::models
