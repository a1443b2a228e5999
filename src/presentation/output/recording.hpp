// SPDX-License-Identifier: Apache-2.0
// What `takt run` records on request: captures, a time line, waveforms, clocks, frames, into the result folder.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "explain/way_recorder.hpp"
#include "output/clock_series.hpp"
#include "output/fan_out.hpp"
#include "output/frame_series.hpp"
#include "output/hop_series.hpp"
#include "output/pcap_recorder.hpp"
#include "output/playback.hpp"
#include "output/timeline_recorder.hpp"
#include "output/vcd_recorder.hpp"
#include "scenario/division/divided_run.hpp"

namespace takt::output {

struct RecordingOptions {
  std::vector<std::string> pcap;  ///< "all", "node" (all its ports), "node:port" or "stream:name"
  bool timeline = false;
  bool waves = false;
  bool clocks = false;
  bool frames = false;
  std::optional<std::string> from;  ///< a duration since the start
  std::optional<std::string> to;
  std::vector<std::string> streams;  ///< none: all
  bool is_wanted() const { return !pcap.empty() || timeline || waves || clocks || frames; }
};

/// Hangs on a run from before its first event to its end. Recording changes no digest, and the files are the same for
/// every division of the run.
class Recording {
 public:
  /// Reports unknown ports and streams to `diagnostics`; then nothing is recorded and nothing was written.
  Recording(const RecordingOptions& options, const std::string& folder, scenario::Run& run,
            json::Diagnostics& diagnostics);
  Recording(const RecordingOptions& options, const std::string& folder, scenario::DividedRun& run,
            json::Diagnostics& diagnostics);
  Recording(const Recording&) = delete;
  Recording& operator=(const Recording&) = delete;
  ~Recording();

  /// Opens the files, whose folder is made if it is not there. An empty text, or what went wrong.
  [[nodiscard]] std::string open();
  /// Writes what has happened up to and including `now`, to which the run has come. What is recorded until then is kept
  /// in memory, so this is to be called often.
  void write_until(sim::TrueTime now);
  /// Writes the states of Programs into the time line and closes the files. An empty text, or what went wrong.
  /// Precondition: of a divided run, all has been gathered.
  [[nodiscard]] std::string close();
  /// The names of the files, within the folder.
  std::vector<std::string> files() const;

 private:
  struct Capture {
    std::string text;  ///< as it was asked for
    std::string file;
    std::vector<models::PortId> ports;          ///< none: all
    std::optional<models::StreamIndex> stream;  ///< its frames, wherever they pass, instead
  };
  /// Who is told of ways: the time line and the table of hops.
  struct Ways final : explain::WaySink {
    bool wants(models::StreamIndex stream) const override { return selection.has(stream); }
    void ended(const explain::Way& way) override;
    Selection selection;
    TimelineRecorder* timeline = nullptr;
    HopSeries* hops = nullptr;
  };
  /// Shows the states of Programs as signals, as they change.
  class ProgramWaves;

  Recording(const RecordingOptions& options, const std::string& folder, std::vector<scenario::Run*> runs,
            scenario::DividedRun* divided, json::Diagnostics& diagnostics);
  void make_tapes();
  void select(json::Diagnostics& diagnostics);
  /// The sink is told of records of these kinds.
  void add_sink(sim::TraceSink& sink, std::initializer_list<models::Occurrence> kinds);
  void select_capture(const std::string& text, json::Diagnostics& diagnostics);
  std::optional<models::StreamIndex> find_stream(const std::string& option, const std::string& name,
                                                 json::Diagnostics& diagnostics) const;
  void write_states();
  void write_reactions(const std::string& group, const scenario::ProgramMonitor& monitor);
  void write_faults(const std::string& program, const std::vector<scenario::ProgramFault>& faults);

  RecordingOptions options_;
  std::string folder_;
  std::vector<scenario::Run*> runs_;  ///< the parts
  scenario::Run* run_;                ///< the first of them, in which Programs act, and which has all when all is over
  scenario::DividedRun* divided_;     ///< null: there is one part
  std::vector<Capture> captures_;
  FanOut sinks_;
  Playback playback_{sinks_};
  TapeWants wants_;
  std::vector<std::unique_ptr<Tape>> tapes_;  // by part
  std::unique_ptr<PcapRecorder> pcap_;
  std::unique_ptr<TimelineRecorder> timeline_;
  std::unique_ptr<VcdRecorder> waves_;
  std::unique_ptr<ClockSeries> clocks_;
  std::unique_ptr<FrameSeries> frames_;
  std::unique_ptr<HopSeries> hops_;
  Ways ways_;
  std::unique_ptr<explain::WayRecorder> way_recorder_;
  std::unique_ptr<ProgramWaves> program_waves_;
  std::vector<std::unique_ptr<SelectedSink>> selected_;
};

}  // namespace takt::output
