// SPDX-License-Identifier: Apache-2.0
// Records the digital output and the publications that it follows.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "papers/coexistence/signal.hpp"
#include "scenario/resolved/resolved.hpp"
#include "sim/trace.hpp"

namespace takt::papers::coexistence {

class OutputLog final : public sim::TraceSink {
 public:
  /// The scenario's first output; `commands_of` is the application whose publications are noted, none if it is empty.
  OutputLog(const scenario::Resolved& resolved, std::string_view commands_of);

  void record(const sim::TraceRecord& record) override;
  const std::vector<SignalEdge>& edges() const { return edges_; }
  /// When each was published, in order.
  const std::vector<sim::TrueTime>& commands() const { return commands_; }

 private:
  std::optional<models::StreamIndex> stream_;
  std::vector<SignalEdge> edges_;
  std::vector<sim::TrueTime> commands_;
};

}  // namespace takt::papers::coexistence
