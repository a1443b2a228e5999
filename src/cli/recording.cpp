#include "cli/recording.hpp"

#include <algorithm>
#include <filesystem>

namespace takt::cli {

Recording::Recording(const RecordingOptions& options, const std::string& folder, scenario::Run& run, json::Diagnostics& diagnostics)
    : options_(options), folder_(folder), run_(&run) {
  for (const std::string& text : options.pcap) select_ports(text, diagnostics);
  if (options.clocks && run.clocks() == nullptr)
    diagnostics.error({"--clocks", 0, 0, ""}, "no clocks to record", {"a scenario without gPTP", "\"gptp\" in \"clocks\""});
}

void Recording::select_ports(const std::string& text, json::Diagnostics& diagnostics) {
  if (text == "all") {
    captures_.push_back({"all.pcap", {}});
    return;
  }
  const scenario::Topology& topology = run_->resolved().topology;
  const std::size_t colon = text.find(':');
  const std::string name = text.substr(0, colon);
  const auto node = topology.find(name);
  Capture capture{text + ".pcap", {}};
  std::replace(capture.file.begin(), capture.file.end(), ':', '-');
  if (node) {
    for (const scenario::Neighbour& neighbour : topology.neighbours[*node])
      if (colon == std::string::npos || text.substr(colon + 1) == std::to_string(neighbour.port))
        capture.ports.push_back({models::NodeIndex{*node}, neighbour.port});
  }
  if (capture.ports.empty())
    diagnostics.error({"--pcap " + text, 0, 0, ""}, "no such port",
                      {json::quote(text), "all, a node (all its ports) or node:port", node ? "" : suggest_node(topology, name, diagnostics)});
  else
    captures_.push_back(std::move(capture));
}

std::string Recording::open() {
  if (!options_.is_wanted()) return {};
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  if (error) return folder_ + ": " + error.message();
  const std::filesystem::path folder(folder_);
  if (!captures_.empty()) {
    pcap_ = std::make_unique<output::PcapRecorder>(run_->network());
    for (const Capture& capture : captures_)
      if (std::string problem = pcap_->add((folder / capture.file).string(), capture.ports); !problem.empty()) return problem;
    sinks_.add(*pcap_);
  }
  if (options_.timeline) {
    timeline_ = std::make_unique<output::TimelineRecorder>(run_->network(), (folder / "timeline.json").string());
    sinks_.add(*timeline_);
  }
  if (options_.waves) {
    waves_ = std::make_unique<output::VcdRecorder>(run_->network(), (folder / "waves.vcd").string());
    for (const scenario::ResolvedSignal& signal : run_->resolved().signals) {
      const scenario::ResolvedApplication& application = run_->resolved().applications[signal.application];
      waves_->add_output(run_->resolved().topology.nodes[application.node.value].name + "\n" + application.name, signal.name);
    }
    sinks_.add(*waves_);
  }
  if (options_.clocks) {
    clocks_ = std::make_unique<output::ClockSeries>(run_->network(), (folder / "clocks.csv").string());
    run_->set_clock_sink(clocks_.get());
  }
  if (options_.frames) {
    frames_ = std::make_unique<output::FrameSeries>(run_->network(), (folder / "frames.csv").string());
    sinks_.add(*frames_);
  }
  run_->simulation().set_trace(&sinks_);
  return {};
}

std::string Recording::close() {
  run_->simulation().set_trace(nullptr);
  std::string problem;
  if (pcap_) problem = pcap_->close();
  if (timeline_) {
    write_states();
    if (std::string other = timeline_->close(run_->simulation().now()); problem.empty()) problem = std::move(other);
  }
  if (waves_)
    if (std::string other = waves_->close(run_->simulation().now()); problem.empty()) problem = std::move(other);
  if (clocks_) {
    run_->set_clock_sink(nullptr);
    if (std::string other = clocks_->close(); problem.empty()) problem = std::move(other);
  }
  if (frames_)
    if (std::string other = frames_->close(); problem.empty()) problem = std::move(other);
  return problem;
}

namespace {

/// The states of a participant in the order of time; who dies is dead, whatever was recorded at that instant.
std::vector<std::pair<sim::TrueTime, std::string_view>> states_of(const scenario::ProgramMonitor& monitor, std::size_t participant) {
  std::vector<std::pair<sim::TrueTime, std::string_view>> states;
  for (const scenario::StateRecord& record : monitor.history())
    if (record.participant == participant) states.emplace_back(record.time, handshake::name_of(record.change.to));
  for (const scenario::LifeRecord& life : monitor.lives())
    if (life.participant == participant) states.emplace_back(life.time, life.is_back ? handshake::name_of(handshake::PublishedState::Halted) : "dead");
  std::stable_sort(states.begin(), states.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  return states;
}

}  // namespace

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

void Recording::write_states() {
  for (std::size_t p = 0; p < run_->resolved().programs.size(); ++p) {
    const scenario::ResolvedProgram& program = run_->resolved().programs[p];
    for (std::size_t i = 0; i < program.participant_names.size(); ++i) {
      const auto track = timeline_->add_state_track("program " + program.name, program.participant_names[i]);
      timeline_->change_state(track, sim::TrueTime(), handshake::name_of(handshake::PublishedState::Halted));
      for (const auto& [time, state] : states_of(run_->monitor(p), i)) timeline_->change_state(track, time, state);
    }
    if (!run_->monitor(p).faults().empty()) write_faults(program.name, run_->monitor(p).faults());
    for (std::size_t role = 0; run_->roles(p) != nullptr && role + 1 < program.participant_names.size(); ++role) {
      const auto track = timeline_->add_state_track("program " + program.name, program.participant_names[role + 1] + " is");
      timeline_->change_state(track, sim::TrueTime(), "nobody");
      for (const scenario::BindingRecord& record : run_->roles(p)->history())
        if (record.role == role)
          timeline_->change_state(track, record.time, record.candidate ? run_->resolved().topology.nodes[program.candidates()[*record.candidate].node.value].name : "nobody");
    }
  }
}

}  // namespace takt::cli
