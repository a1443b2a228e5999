// The gates of all ports over one cycle, with the frames that were sent in it.
#pragma once

#include <optional>
#include <vector>

#include "chart/gantt.hpp"
#include "output/port_directory.hpp"
#include "report/message_log.hpp"
#include "scenario/run/run.hpp"
#include "sim/trace.hpp"

namespace takt::report {

/// The cycle to look at: of the longest gate list, one that begins in the middle of `simulated`; none if no port has gates, or if it would be longer than that.
std::optional<Span> gate_cycle(const scenario::Resolved& resolved, sim::Duration simulated);

/// Watches a run over a span; tell it when the run has come to the beginning.
class GateWatch final : public sim::TraceSink {
 public:
  GateWatch(const scenario::Run& run, Span span);

  /// Takes down what the gates will do, by the clocks and lists of this instant, the span's beginning.
  void look_at_gates();
  void record(const sim::TraceRecord& record) override;

  chart::Gantt figure() const;

 private:
  struct Sent {
    sim::TrueTime from;
    sim::TrueTime until;
    std::uint32_t port = 0;      ///< in the directory
    std::uint32_t octets = 0;
    std::uint64_t sequence = 0;
    models::StreamIndex stream;
    models::TrafficClass traffic_class = 0;
  };
  struct Open {
    sim::TrueTime from;
    sim::TrueTime until;
    models::TrafficClass traffic_class = 0;
  };

  const scenario::Run* run_;
  Span span_;
  output::PortDirectory directory_;
  std::vector<std::vector<Open>> open_;       // by port; empty: no gates
  std::vector<Sent> sent_;
  std::vector<std::size_t> last_;             // by port, in sent_: what is on the wire
};

}  // namespace takt::report
