// SPDX-License-Identifier: Apache-2.0
#include "output/recording.hpp"

#include <algorithm>
#include <filesystem>

#include "json/quantity.hpp"
#include "output/program_states.hpp"

namespace takt::output {

using models::Occurrence;

Recording::Recording(const RecordingOptions& options, const std::string& folder, scenario::Run& run,
                     json::Diagnostics& diagnostics)
    : Recording(options, folder, {&run}, nullptr, diagnostics) {}

Recording::Recording(const RecordingOptions& options, const std::string& folder, scenario::DividedRun& run,
                     json::Diagnostics& diagnostics)
    : Recording(options, folder, run.runs(), &run, diagnostics) {}

Recording::Recording(const RecordingOptions& options, const std::string& folder, std::vector<scenario::Run*> runs,
                     scenario::DividedRun* divided, json::Diagnostics& diagnostics)
    : options_(options), folder_(folder), runs_(std::move(runs)), run_(runs_.front()), divided_(divided) {
  for (const std::string& text : options.pcap) select_capture(text, diagnostics);
  select(diagnostics);
  if (options.clocks && run_->clocks() == nullptr)
    diagnostics.error({"--clocks", 0, 0, ""}, "no clocks to record",
                      {"a scenario without gPTP", "\"gptp\" in \"clocks\""});
}

/// Each state is the number that Programs publish: 11 Halted, 12 Ready, 13 Running, 14 Suspended, 15 Halted.INIT; 0:
/// dead, or nobody.
class Recording::ProgramWaves final : public sim::TraceSink {
 public:
  ProgramWaves(const scenario::Run& run, VcdRecorder& waves, sim::TrueTime from)
      : run_(run), waves_(waves), from_(from) {
    for (std::size_t p = 0; p < run.resolved().programs.size(); ++p) {
      const scenario::ResolvedProgram& program = run.resolved().programs[p];
      Shown shown;
      for (const std::string& participant : program.participant_names)
        shown.signals.push_back(waves.add_signal("program " + program.name, participant, 8,
                                                 static_cast<std::uint64_t>(handshake::PublishedState::Halted)));
      shown_.push_back(std::move(shown));
    }
  }

  /// What has changed since the last record. The monitors know more: the run is ahead of what is told.
  void record(const sim::TraceRecord& record) override { show_until(record.time); }
  void show_until(sim::TrueTime now) {
    changes_.clear();
    for (std::size_t p = 0; p < shown_.size(); ++p) {
      Shown& shown = shown_[p];
      const scenario::ProgramMonitor& monitor = run_.monitor(p);
      for (; shown.states < monitor.history().size() && monitor.history()[shown.states].time <= now; ++shown.states) {
        const scenario::StateRecord& state = monitor.history()[shown.states];
        changes_.push_back({state.time, shown.signals[state.participant], static_cast<std::uint64_t>(state.change.to)});
      }
      for (; shown.lives < monitor.lives().size() && monitor.lives()[shown.lives].time <= now; ++shown.lives) {
        const scenario::LifeRecord& life = monitor.lives()[shown.lives];
        changes_.push_back({life.time, shown.signals[life.participant],
                            life.is_back ? static_cast<std::uint64_t>(handshake::PublishedState::Halted) : 0});
      }
    }
    std::ranges::stable_sort(changes_, {}, &Change::time);
    for (const Change& change : changes_) waves_.set(change.signal, std::max(change.time, from_), change.value);
  }

 private:
  struct Change {
    sim::TrueTime time;
    VcdRecorder::SignalId signal = 0;
    std::uint64_t value = 0;
  };
  struct Shown {
    std::vector<VcdRecorder::SignalId> signals;  // by participant
    std::size_t states = 0;                      // that have been shown
    std::size_t lives = 0;
  };
  const scenario::Run& run_;
  VcdRecorder& waves_;
  sim::TrueTime from_;
  std::vector<Shown> shown_;
  std::vector<Change> changes_;  // kept for its room
};

Recording::~Recording() {
  for (scenario::Run* const run : runs_) run->simulation().set_trace(nullptr);
  for (std::size_t part = 0; divided_ != nullptr && part < runs_.size(); ++part) divided_->watch(part, nullptr);
}

void Recording::Ways::ended(const explain::Way& way) {
  if (timeline != nullptr && selection.has(way)) timeline->add_way(way);
  if (hops != nullptr) hops->ended(way);
}

void Recording::select(json::Diagnostics& diagnostics) {
  const auto time = [&](const char* option, const std::optional<std::string>& text, sim::TrueTime& value) {
    if (!text) return;
    if (const auto parsed = json::parse_duration(*text))
      value = sim::TrueTime() + *parsed;
    else
      diagnostics.error({option, 0, 0, ""}, "not a time",
                        {json::quote(*text), "a duration since the start, such as \"1500ms\""});
  };
  Selection& selection = ways_.selection;
  time("--from", options_.from, selection.from);
  time("--to", options_.to, selection.to);
  if (selection.to < selection.from)
    diagnostics.error({"--to", 0, 0, ""}, "an end before the beginning",
                      {json::quote(*options_.to), "a time after that of --from"});
  const auto& streams = run_->network().traffic().streams();
  if (!options_.streams.empty()) selection.streams.resize(streams.size());
  for (const std::string& name : options_.streams)
    if (const auto found = find_stream("--stream " + name, name, diagnostics)) selection.streams[found->value] = true;
}

std::optional<models::StreamIndex> Recording::find_stream(const std::string& option, const std::string& name,
                                                          json::Diagnostics& diagnostics) const {
  const auto& streams = run_->network().traffic().streams();
  const auto found = std::ranges::find(streams, name, &models::Stream::name);
  if (found != streams.end()) return models::StreamIndex{static_cast<std::uint32_t>(found - streams.begin())};
  diagnostics.error({option, 0, 0, ""}, "no such stream",
                    {json::quote(name), "the name of a stream, as result.json lists them"});
  return std::nullopt;
}

/// Each recorder hears what is selected.
void Recording::add_sink(sim::TraceSink& sink, std::initializer_list<models::Occurrence> kinds) {
  wants_.kinds |= TapeWants::bits_of(kinds);
  if (ways_.selection.is_all()) {
    sinks_.add(sink);
    return;
  }
  selected_.push_back(std::make_unique<SelectedSink>(run_->network(), ways_.selection, sink));
  selected_.back()->look_at(playback_.moment());
  sinks_.add(*selected_.back());
}

namespace {

/// What becomes of "sw1:2" where it is part of the name of a file.
std::string file_name_of(std::string text) {
  std::ranges::replace_if(
      text, [](char c) { return c == ':' || c == '/'; }, '-');
  return text + ".pcapng";
}

}  // namespace

void Recording::select_capture(const std::string& text, json::Diagnostics& diagnostics) {
  const scenario::Topology& topology = run_->resolved().topology;
  const std::size_t colon = text.find(':');
  const std::string name = text.substr(0, colon);
  const auto node = topology.find(name);
  Capture capture{text, file_name_of(text), {}, {}};
  if (node) {
    for (const scenario::Neighbour& neighbour : topology.neighbours[*node])
      if (colon == std::string::npos || text.substr(colon + 1) == std::to_string(neighbour.port))
        capture.ports.push_back({models::NodeIndex{*node}, neighbour.port});
  }
  if (capture.ports.empty() && name == "stream" && colon != std::string::npos) {
    capture.stream = find_stream("--pcap " + text, text.substr(colon + 1), diagnostics);
    if (!capture.stream) return;
  } else if (capture.ports.empty() && text != "all") {
    diagnostics.error({"--pcap " + text, 0, 0, ""}, "no such port",
                      {json::quote(text), "all, a node (all its ports), node:port or stream:NAME",
                       node ? "" : suggest_node(topology, name, diagnostics)});
    return;
  }
  const auto same = std::ranges::find(captures_, capture.file, &Capture::file);
  if (same == captures_.end())
    captures_.push_back(std::move(capture));
  else if (same->text != text)
    diagnostics.error({"--pcap " + text, 0, 0, ""}, "a second capture of that name",
                      {capture.file + ", as of --pcap " + same->text, "one of them at a time"});
}

std::string Recording::open() {
  if (!options_.is_wanted()) return {};
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  if (error) return folder_ + ": " + error.message();
  const std::filesystem::path folder(folder_);
  if (!captures_.empty()) {
    pcap_ = std::make_unique<PcapRecorder>(run_->network());
    for (const Capture& capture : captures_) {
      const std::string path = (folder / capture.file).string();
      if (std::string problem =
              capture.stream ? pcap_->add_stream(path, *capture.stream) : pcap_->add(path, capture.ports);
          !problem.empty())
        return problem;
    }
    pcap_->look_at(playback_.moment());
    wants_.payloads = true;
    add_sink(*pcap_, {Occurrence::started});
  }
  if (options_.timeline) {
    timeline_ = std::make_unique<TimelineRecorder>(run_->network(), (folder / "timeline.json").string(),
                                                   ways_.selection.from, ways_.selection.to);
    timeline_->look_at(playback_.moment());
    wants_.gates = true;
    add_sink(*timeline_, {Occurrence::started, Occurrence::resumed, Occurrence::cut, Occurrence::drop,
                          Occurrence::arrived, Occurrence::separated});
  }
  if (options_.waves) {
    waves_ = std::make_unique<VcdRecorder>(run_->network(), (folder / "waves.vcd").string());
    for (const scenario::ResolvedSignal& signal : run_->resolved().signals) {
      const scenario::ResolvedApplication& application = run_->resolved().applications[signal.application];
      waves_->add_output(run_->resolved().topology.nodes[application.node.value].name + "\n" + application.name,
                         signal.name);
    }
    waves_->begin_at(ways_.selection.from);
    waves_->end_at(ways_.selection.to);
    waves_->look_at(playback_.moment());
    wants_.gates = wants_.queues = true;
    program_waves_ = std::make_unique<ProgramWaves>(*run_, *waves_, ways_.selection.from);
    add_sink(*program_waves_, {});
    add_sink(*waves_, {Occurrence::enqueued, Occurrence::dequeued, Occurrence::started, Occurrence::resumed,
                       Occurrence::cut, Occurrence::drop, Occurrence::output_changed});
  }
  if (options_.clocks) {
    clocks_ = std::make_unique<ClockSeries>(run_->network(), (folder / "clocks.csv").string(), ways_.selection.from,
                                            ways_.selection.to);
    for (scenario::Run* const run : runs_) run->set_clock_sink(clocks_.get());
  }
  if (options_.frames) {
    frames_ = std::make_unique<FrameSeries>(run_->network(), (folder / "frames.csv").string());
    frames_->look_at(playback_.moment());
    add_sink(*frames_, {Occurrence::received, Occurrence::drop});
    hops_ = std::make_unique<HopSeries>(run_->network(), ways_.selection, (folder / "hops.csv").string());
  }
  if (timeline_ || hops_) {
    ways_.timeline = timeline_.get();
    ways_.hops = hops_.get();
    way_recorder_ = std::make_unique<explain::WayRecorder>(run_->network(), ways_);
    way_recorder_->look_at(playback_.moment());
    wants_.ways = true;
    sinks_.add(*way_recorder_);
  }
  make_tapes();
  return {};
}

/// Each part hears of all that somebody wants to know.
void Recording::make_tapes() {
  if (sinks_.empty()) return;
  wants_.from = ways_.selection.from;
  wants_.to = ways_.selection.to;
  for (std::uint32_t part = 0; part < runs_.size(); ++part) {
    tapes_.push_back(std::make_unique<Tape>(runs_[part]->network(), part, wants_));
    playback_.add(*tapes_.back());
    if (wants_.ways)
      runs_[part]->explain_to(tapes_.back().get());
    else
      runs_[part]->simulation().set_trace(tapes_.back().get());
    if (wants_.ways && divided_ != nullptr) divided_->watch(part, tapes_.back().get());
  }
}

void Recording::write_until(sim::TrueTime now) {
  if (!tapes_.empty()) playback_.play(now);
}

std::vector<std::string> Recording::files() const {
  std::vector<std::string> names;
  const auto add = [&](bool is_there, std::initializer_list<const char*> files) {
    if (is_there) names.insert(names.end(), files.begin(), files.end());
  };
  for (const Capture& capture : captures_) names.push_back(capture.file);
  add(options_.timeline, {"timeline.json"});
  add(options_.waves, {"waves.vcd", "waves.gtkw"});
  add(options_.clocks, {"clocks.csv"});
  add(options_.frames, {"frames.csv", "hops.csv"});
  return names;
}

std::string Recording::close() {
  const sim::TrueTime now = run_->simulation().now();
  write_until(now);
  for (scenario::Run* const run : runs_) run->simulation().set_trace(nullptr);
  if (way_recorder_) way_recorder_->finish(now);
  std::string problem;
  if (pcap_) problem = pcap_->close();
  if (timeline_) {
    write_states();
    if (std::string other = timeline_->close(now); problem.empty()) problem = std::move(other);
  }
  if (waves_) {
    if (now >= ways_.selection.from) program_waves_->show_until(std::min(now, ways_.selection.to));
    if (std::string other = waves_->close(now); problem.empty()) problem = std::move(other);
  }
  if (clocks_) {
    for (scenario::Run* const run : runs_) run->set_clock_sink(nullptr);
    if (std::string other = clocks_->close(); problem.empty()) problem = std::move(other);
  }
  if (frames_)
    if (std::string other = frames_->close(); problem.empty()) problem = std::move(other);
  if (hops_)
    if (std::string other = hops_->close(); problem.empty()) problem = std::move(other);
  return problem;
}

/// What happens to the nodes and links of a program, each beginning and each end as a state of its own.
void Recording::write_faults(const std::string& program, const std::vector<scenario::ProgramFault>& faults) {
  const auto track = timeline_->add_state_track("program " + program, "faults");
  std::vector<std::pair<sim::TrueTime, std::string_view>> events;
  for (const scenario::ProgramFault& fault : faults) {
    events.emplace_back(fault.at, fault.text);
    if (!fault.end_text.empty()) events.emplace_back(fault.until, fault.end_text);
  }
  std::stable_sort(events.begin(), events.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  timeline_->change_state(track, sim::TrueTime(), "none");
  for (const auto& [time, text] : events)
    if (time <= run_->simulation().now()) timeline_->change_state(track, time, std::string(text));
}

/// Each from its cause to the last who was there; and the calls of the script.
void Recording::write_reactions(const std::string& group, const scenario::ProgramMonitor& monitor) {
  const auto track = timeline_->add_state_track(group, "reactions");
  sim::TrueTime free;
  for (const handshake::Reaction& reaction : monitor.reactions()) {
    if (reaction.began < free) continue;  // it has come while another one was under way
    timeline_->change_state(track, reaction.began, handshake::name_of(reaction.kind));
    if (reaction.outcome != handshake::ReactionOutcome::completed) continue;
    timeline_->change_state(track, reaction.completed, "");
    free = reaction.completed;
  }
  const auto calls = timeline_->add_state_track(group, "calls");
  for (const scenario::CallRecord& call : monitor.calls())
    timeline_->mark(calls, call.time, program::name_of(call.method));
}

void Recording::write_states() {
  for (std::size_t p = 0; p < run_->resolved().programs.size(); ++p) {
    const scenario::ResolvedProgram& program = run_->resolved().programs[p];
    for (std::size_t i = 0; i < program.participant_names.size(); ++i) {
      const auto track = timeline_->add_state_track("program " + program.name, program.participant_names[i]);
      for (const auto& [time, state] : states_of(run_->monitor(p), i)) timeline_->change_state(track, time, state);
    }
    write_reactions("program " + program.name, run_->monitor(p));
    if (!run_->monitor(p).faults().empty()) write_faults(program.name, run_->monitor(p).faults());
    for (std::size_t role = 0; run_->roles(p) != nullptr && role + 1 < program.participant_names.size(); ++role) {
      const auto track =
          timeline_->add_state_track("program " + program.name, program.participant_names[role + 1] + " is");
      timeline_->change_state(track, sim::TrueTime(), "nobody");
      for (const scenario::BindingRecord& record : run_->roles(p)->history())
        if (record.role == role)
          timeline_->change_state(
              track, record.time,
              record.candidate
                  ? run_->resolved().topology.nodes[program.candidates()[*record.candidate].node.value].name
                  : "nobody");
    }
  }
}

}  // namespace takt::output
