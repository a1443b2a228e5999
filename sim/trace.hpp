// SPDX-License-Identifier: Apache-2.0
// What recorders (pcap, time line, waveform) see of a run.
#pragma once

#include <cstdint>

#include "sim/event.hpp"
#include "sim/time.hpp"

namespace takt::sim {

/// One thing that happened. `kind` and the meaning of the arguments belong to the layer that records it.
struct TraceRecord {
  TrueTime time;
  std::uint32_t kind = 0;
  ComponentId where;
  std::uint64_t what = 0;
  std::uint64_t detail = 0;
};

/// A recorder. It may read the simulation but never changes it: a run has the same digest with and without it.
class TraceSink {
 public:
  virtual ~TraceSink() = default;
  virtual void record(const TraceRecord& record) = 0;
};

}  // namespace takt::sim
