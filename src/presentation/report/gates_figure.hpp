// SPDX-License-Identifier: Apache-2.0
// The gates of all ports over one cycle, with the frames that were sent in it and those that were discarded; without
// gates, the frames around the first one that was discarded.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "chart/gantt.hpp"
#include "output/drop_places.hpp"
#include "output/port_directory.hpp"
#include "output/tape.hpp"
#include "report/message_log.hpp"
#include "results/run_result.hpp"
#include "scenario/run/run.hpp"
#include "sim/trace.hpp"

namespace takt::report {

/// Of all gate lists of ports, those that the script sets among them; none if no port ever has gates.
std::optional<sim::Duration> longest_gate_cycle(const scenario::Resolved& resolved);
/// Whether a filter, a stream gate, a meter or a queue has discarded frames.
bool has_discarded(const results::RunResult& result);

/// Watches a run, on which it hangs by scenario::Run::explain_to(). What it draws:
///   with gates   the cycle that the middle of the run lies in, of the list that is in force then and has the longest
///   one. What gates did is taken from the run itself, since lists,
///                clocks and faults may change it at any time
///   without      some periods of the stream whose frame is the first that is discarded
class GateWatch final : public sim::TraceSink {
 public:
  /// `longest` is longest_gate_cycle(); nothing is drawn of what is after `end`.
  GateWatch(scenario::Run& run, std::optional<sim::Duration> longest, sim::TrueTime end);

  bool shows_gates() const { return longest_.has_value(); }
  // In this order, each when the run has come there.
  sim::TrueTime begin() const;
  void start();
  /// With gates.
  sim::TrueTime middle() const { return sim::TrueTime() + end_.since_start() / 2; }
  void choose_cycle();
  /// How far the run is to go; none if nothing has been found that could be drawn: no list is in force, its cycle ends
  /// too late, no frame has been discarded yet.
  std::optional<sim::TrueTime> until() const { return span_ ? std::optional(span_->until) : std::nullopt; }
  void finish();

  void record(const sim::TraceRecord& record) override;

  /// Precondition: it has finished.
  std::optional<chart::Gantt> figure() const;

 private:
  struct Sent {
    sim::TrueTime from;
    sim::TrueTime until;
    std::uint32_t port = 0;  ///< in the directory
    std::uint32_t octets = 0;
    std::uint64_t sequence = 0;
    models::StreamIndex stream;
    models::TrafficClass traffic_class = 0;
  };
  struct Discarded {
    sim::TrueTime at;
    std::uint32_t port = 0;  ///< by which the frame came, or in whose queue it was
    models::TrafficClass traffic_class = 0;
    std::string text;
  };
  struct States {
    sim::TrueTime from;
    models::GateStates open = 0;
  };

  bool is_watched(std::uint32_t port) const;
  void note_sent(const sim::TraceRecord& record, std::uint32_t port);
  void forget_before(sim::TrueTime time);
  void note_drop(const sim::TraceRecord& record);
  chart::GanttRow row_of(std::uint32_t port, models::TrafficClass traffic_class) const;
  double microseconds(sim::TrueTime time) const;

  scenario::Run* run_;
  std::optional<sim::Duration> longest_;
  sim::TrueTime end_;
  std::optional<Span> span_;  // that is drawn, when it is known
  output::PortDirectory directory_;
  output::DropPlaces drops_;
  std::unique_ptr<output::Tape> tape_;  // of gates alone
  bool is_started_ = false;
  std::vector<std::vector<States>> states_;  // by port; empty: no gates
  std::vector<Sent> sent_;
  std::vector<Discarded> discarded_;
  std::vector<std::size_t> last_;  // by port, in sent_: what was sent last
};

}  // namespace takt::report
