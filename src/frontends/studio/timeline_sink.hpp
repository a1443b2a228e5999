// SPDX-License-Identifier: Apache-2.0
// Fills a timeline from what a run says.
#pragma once

#include <cstdint>
#include <vector>

#include "models/port_directory.hpp"
#include "output/drop_places.hpp"
#include "output/gate_follower.hpp"
#include "scenario/run/run.hpp"
#include "studio/timeline.hpp"

namespace takt::studio {

class TimelineSink final : public sim::TraceSink {
 public:
  /// All outlive it. Hangs on the run by scenario::Run::explain_to().
  TimelineSink(const scenario::Run& run, const Timeline::Limits& limits, Timeline& timeline);

  void record(const sim::TraceRecord& record) override;
  /// There is no more room: what comes after this is not kept.
  bool is_full() const { return is_full_; }
  /// The end: gates up to then, the states of Programs.
  void finish(sim::TrueTime now);

 private:
  void follow_gates(sim::TrueTime now);
  void show_gates(std::uint32_t position, sim::TrueTime at);
  void add_program(std::size_t program);

  const scenario::Run* run_;
  Timeline::Limits limits_;
  Timeline* timeline_;
  models::PortDirectory directory_;
  output::GateFollower gates_;
  output::DropPlaces drops_;
  std::uint64_t changes_ = 0;
  sim::TrueTime last_;
  bool is_full_ = false;
};

}  // namespace takt::studio
