// SPDX-License-Identifier: Apache-2.0
// The way of the slowest frame of each stream, which the result knows only the latency of: where its time went, hop by
// hop.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "explain/explanation.hpp"
#include "explain/way_recorder.hpp"
#include "models/network.hpp"
#include "results/run_result.hpp"

namespace takt::report {

/// Told of the ways of a run, it keeps for each of the slowest streams that of the first frame that took as long as the
/// result says.
class WorstWays final : public explain::WaySink {
 public:
  static constexpr std::size_t most_streams = 50;

  /// The network outlives it.
  WorstWays(const models::Network& network, const results::RunResult& result);

  bool wants(models::StreamIndex stream) const override;
  bool wants_delivery(const models::Frame& frame, models::NodeIndex listener, sim::TrueTime now) override;
  bool wants_loss(const models::Frame&, models::DropReason) override { return false; }
  void ended(const explain::Way& way) override;

  /// No stream has delivered anything, or all that are sought have been found.
  bool is_complete() const { return missing_ == 0; }
  /// The slowest first.
  std::vector<const explain::ExplainedFrame*> frames() const;
  /// Streams that have delivered frames and are not looked at.
  std::size_t left_out() const { return left_out_; }

 private:
  struct Sought {
    models::StreamIndex stream;
    sim::Duration latency;
    std::optional<explain::ExplainedFrame> found = {};
  };
  Sought* find(models::StreamIndex stream);

  const models::Network* network_;
  std::vector<Sought> sought_;
  std::vector<std::size_t> of_stream_;  // by stream: its place in sought_, or beyond
  std::size_t missing_ = 0;
  std::size_t left_out_ = 0;
};

/// The section of the page; nothing if no way was found.
std::string ways_section(const WorstWays& ways);

}  // namespace takt::report
