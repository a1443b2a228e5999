// SPDX-License-Identifier: Apache-2.0
// One sink that hands what it records to several.
#pragma once

#include <vector>

#include "sim/trace.hpp"

namespace takt::output {

class FanOut final : public sim::TraceSink {
 public:
  /// The sink outlives this one. Sinks see each record in the order in which they were added.
  void add(sim::TraceSink& sink) { sinks_.push_back(&sink); }
  bool empty() const { return sinks_.empty(); }

  void record(const sim::TraceRecord& record) override {
    for (sim::TraceSink* const sink : sinks_) sink->record(record);
  }

 private:
  std::vector<sim::TraceSink*> sinks_;
};

}  // namespace takt::output
