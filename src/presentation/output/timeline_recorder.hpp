// SPDX-License-Identifier: Apache-2.0
// Writes a time line in the Chrome trace event format, which ui.perfetto.dev opens: a process for each node with a
// thread for each port, on which every frame is a slice from the first bit of its preamble to its last bit; drops are
// marks on the port where the frame was, or where the node that discarded it had received it; arrows lead from hop to
// hop, and what a frame waits for stands beside the port; and a track for whatever has a state, such as the
// participants of a Program.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "explain/way.hpp"
#include "models/moment.hpp"
#include "models/port_directory.hpp"
#include "output/drop_places.hpp"
#include "output/streaming_file.hpp"
#include "sim/trace.hpp"

namespace takt::output {

class TimelineRecorder final : public sim::TraceSink {
 public:
  using TrackId = std::uint32_t;

  /// Writes as it records. The network outlives the recorder. What states and gates are before `from` or after `to` is
  /// left out.
  TimelineRecorder(const models::Network& network, std::string path, sim::TrueTime from = {},
                   sim::TrueTime to = sim::TrueTime::never());

  /// A track that shows states; tracks of one group stand together.
  TrackId add_state_track(std::string_view group, std::string_view name);
  /// From that time on the track is in that state; an empty text: in none. The times of a track ascend, but it may be
  /// told its past at any time before close().
  void change_state(TrackId track, sim::TrueTime time, std::string_view state);

  /// A mark on a track.
  void mark(TrackId track, sim::TrueTime time, std::string_view text);

  /// The way of a frame, when it has ended: an arrow from hop to hop, and each wait at a port as a slice of its own
  /// with its cause. Hops that an earlier way has shared are left out.
  void add_way(const explain::Way& way);

  /// It is told of things later than they happen, each with its moment.
  void look_at(const models::Moment& moment) { view_.look_at(moment); }
  /// Gates are shown as gates_shown tells.
  void record(const sim::TraceRecord& record) override;

  /// Ends all states at `end` and gives the file its name. Returns an empty text, or what went wrong.
  [[nodiscard]] std::string close(sim::TrueTime end);

 private:
  struct Track {
    std::uint32_t process = 0;
    std::uint32_t thread = 0;
    sim::TrueTime since;
    std::string state;
  };
  /// What a port sends, a whole frame or a fragment.
  struct Slice {
    sim::TrueTime start;
    std::uint32_t octets = 0;
    std::uint64_t sequence = 0;
    models::StreamIndex stream;
    models::Priority priority = 0;
    bool is_open = false;
    bool is_continued = false;  // of a frame that was cut before
    bool is_cut = false;
  };
  static constexpr TrackId no_track = 0xFFFF'FFFF;
  void write_slice(std::uint32_t position);
  void mark_drop(const sim::TraceRecord& record);
  void show_gates(std::uint32_t position, sim::TrueTime time, std::uint64_t states);
  void name_ports();
  void name_process(std::uint32_t process, std::string_view name);
  void name_thread(std::uint32_t process, std::uint32_t thread, std::string_view name);
  void event(std::string_view text);

  const models::Network* network_;
  models::View view_;
  sim::TrueTime from_;
  sim::TrueTime to_;
  models::PortDirectory directory_;
  DropPlaces drops_;
  StreamingFile file_;
  bool first_ = true;
  std::vector<std::string> groups_;
  std::vector<std::uint32_t> tracks_of_group_;
  std::vector<Track> tracks_;
  std::vector<Slice> slices_;              // by position of the port in the directory
  std::vector<std::string> stream_names_;  // escaped
  std::vector<TrackId> gate_tracks_;       // by port; none: it has shown no gates
  std::uint64_t ways_ = 0;
  std::uint64_t waits_ = 0;
};

}  // namespace takt::output
