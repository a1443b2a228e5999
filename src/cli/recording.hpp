// What `takt run` records on request: captures, a time line, waveforms, clocks, frames, into the result folder.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "output/clock_series.hpp"
#include "output/fan_out.hpp"
#include "output/frame_series.hpp"
#include "output/pcap_recorder.hpp"
#include "output/timeline_recorder.hpp"
#include "output/vcd_recorder.hpp"
#include "scenario/run/run.hpp"

namespace takt::cli {

struct RecordingOptions {
  std::vector<std::string> pcap;   ///< "all", "node" (all its ports) or "node:port"
  bool timeline = false;
  bool waves = false;
  bool clocks = false;
  bool frames = false;
  bool is_wanted() const { return !pcap.empty() || timeline || waves || clocks || frames; }
};

/// Hangs on a run from before its first event to its end. Recording changes no digest.
class Recording {
 public:
  /// Reports unknown ports to `diagnostics`; then nothing is recorded and nothing was written.
  Recording(const RecordingOptions& options, const std::string& folder, scenario::Run& run, json::Diagnostics& diagnostics);
  Recording(const Recording&) = delete;
  Recording& operator=(const Recording&) = delete;
  ~Recording() { run_->simulation().set_trace(nullptr); }

  /// Opens the files, whose folder is made if it is not there. An empty text, or what went wrong.
  [[nodiscard]] std::string open();
  /// Writes the states of Programs into the time line and closes the files. An empty text, or what went wrong.
  [[nodiscard]] std::string close();

 private:
  struct Capture {
    std::string file;
    std::vector<models::PortId> ports;  ///< none: all
  };
  void select_ports(const std::string& text, json::Diagnostics& diagnostics);
  void write_states();
  void write_faults(const std::string& program, const std::vector<scenario::ProgramFault>& faults);

  RecordingOptions options_;
  std::string folder_;
  scenario::Run* run_;
  std::vector<Capture> captures_;
  output::FanOut sinks_;
  std::unique_ptr<output::PcapRecorder> pcap_;
  std::unique_ptr<output::TimelineRecorder> timeline_;
  std::unique_ptr<output::VcdRecorder> waves_;
  std::unique_ptr<output::ClockSeries> clocks_;
  std::unique_ptr<output::FrameSeries> frames_;
};

}  // namespace takt::cli
