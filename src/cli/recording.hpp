// What `takt run` records on request: captures, a time line, waveforms, clocks, frames, into the result folder.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "output/clock_series.hpp"
#include "output/fan_out.hpp"
#include "explain/way_recorder.hpp"
#include "output/frame_series.hpp"
#include "output/hop_series.hpp"
#include "output/pcap_recorder.hpp"
#include "output/timeline_recorder.hpp"
#include "output/vcd_recorder.hpp"
#include "scenario/run/run.hpp"

namespace takt::cli {

struct RecordingOptions {
  std::vector<std::string> pcap;   ///< "all", "node" (all its ports), "node:port" or "stream:name"
  bool timeline = false;
  bool waves = false;
  bool clocks = false;
  bool frames = false;
  std::optional<std::string> from;   ///< a duration since the start
  std::optional<std::string> to;
  std::vector<std::string> streams;  ///< none: all
  bool is_wanted() const { return !pcap.empty() || timeline || waves || clocks || frames; }
};

/// Hangs on a run from before its first event to its end. Recording changes no digest.
class Recording {
 public:
  /// Reports unknown ports and streams to `diagnostics`; then nothing is recorded and nothing was written.
  Recording(const RecordingOptions& options, const std::string& folder, scenario::Run& run, json::Diagnostics& diagnostics);
  Recording(const Recording&) = delete;
  Recording& operator=(const Recording&) = delete;
  ~Recording();

  /// Opens the files, whose folder is made if it is not there. An empty text, or what went wrong.
  [[nodiscard]] std::string open();
  /// Writes the states of Programs into the time line and closes the files. An empty text, or what went wrong.
  [[nodiscard]] std::string close();
  /// The names of the files, within the folder.
  std::vector<std::string> files() const;

 private:
  struct Capture {
    std::string text;                   ///< as it was asked for
    std::string file;
    std::vector<models::PortId> ports;  ///< none: all
    std::optional<models::StreamIndex> stream;   ///< its frames, wherever they pass, instead
  };
  /// Who is told of ways: the time line and the table of hops.
  struct Ways final : explain::WaySink {
    bool wants(models::StreamIndex stream) const override { return selection.has(stream); }
    void ended(const explain::Way& way) override;
    output::Selection selection;
    output::TimelineRecorder* timeline = nullptr;
    output::HopSeries* hops = nullptr;
  };
  /// Shows the states of Programs as signals, as they change.
  class ProgramWaves;

  void select(json::Diagnostics& diagnostics);
  void add_sink(sim::TraceSink& sink);
  void select_capture(const std::string& text, json::Diagnostics& diagnostics);
  std::optional<models::StreamIndex> find_stream(const std::string& option, const std::string& name, json::Diagnostics& diagnostics) const;
  void write_states();
  void write_reactions(const std::string& group, const scenario::ProgramMonitor& monitor);
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
  std::unique_ptr<output::HopSeries> hops_;
  Ways ways_;
  std::unique_ptr<explain::WayRecorder> way_recorder_;
  std::unique_ptr<ProgramWaves> program_waves_;
  std::vector<std::unique_ptr<output::SelectedSink>> selected_;
};

}  // namespace takt::cli
