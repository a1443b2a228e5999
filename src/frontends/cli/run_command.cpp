// SPDX-License-Identifier: Apache-2.0
// takt run: what happens.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "cli/batch_run.hpp"
#include "cli/commands.hpp"
#include "cli/interrupt.hpp"
#include "cli/places.hpp"
#include "cli/progress.hpp"
#include "cli/terminal.hpp"
#include "cli/threads.hpp"
#include "evaluation/evaluate.hpp"
#include "output/recording.hpp"
#include "output/result_folder.hpp"
#include "output/text_report.hpp"
#include "report/run_page.hpp"
#include "results/result_json.hpp"
#include "scenario/division/divided_run.hpp"
#include "scenario/run/huge_heap.hpp"

namespace takt::cli {
namespace {

struct RunOptions {
  BatchOptions batch;
  output::RecordingOptions recording;
  std::uint32_t threads = 1;
  bool all = false;
};

/// What is recorded is kept until the slice is over: so many bytes for each event.
constexpr std::uint64_t recorded_events_a_slice = 100'000;

/// Simulates in slices, so that the bar moves and Ctrl-C is seen. True if the end was reached.
bool simulate(scenario::Run& run, output::Recording& recording, bool is_recorded, bool show_progress) {
  const InterruptGuard interrupt;
  Progress progress(show_progress);
  const std::uint64_t events_a_slice = is_recorded ? recorded_events_a_slice : 200'000;
  while (!run.advance(events_a_slice)) {
    recording.write_until(run.simulation().now());
    if (interrupt.requested()) return false;
    progress.update(run.simulation().now().since_start(), run.end().since_start(), run.simulation().event_count());
  }
  return true;
}

/// The same on several threads, in slices of time, each about as many events.
bool simulate(scenario::DividedRun& run, output::Recording& recording, bool is_recorded, bool show_progress) {
  const InterruptGuard interrupt;
  Progress progress(show_progress);
  const std::uint64_t events_a_slice = is_recorded ? recorded_events_a_slice : 2'000'000;
  sim::Duration slice = sim::Duration::from_ps(std::max<std::int64_t>(1, run.end().ps() / 10'000));
  while (run.now() < run.end()) {
    if (interrupt.requested()) return false;
    const std::uint64_t before = run.event_count();
    run.advance(run.now().plus_saturated(slice));
    recording.write_until(run.now());
    if (run.event_count() - before < events_a_slice / 2) slice = std::min(slice * 2, run.end() - sim::TrueTime());
    if (run.event_count() - before > events_a_slice * 2) slice = std::max(slice / 2, sim::Duration::from_ps(1));
    progress.update(run.now().since_start(), run.end().since_start(), run.event_count());
  }
  return true;
}

ExitStatus status_of(const results::RunResult& result) {
  if (result.verdict == results::Verdict::fail) return ExitStatus::requirement_failed;
  if (result.partial) return ExitStatus::interrupted;
  return result.verdict == results::Verdict::undecided ? ExitStatus::undecided : ExitStatus::pass;
}

/// The page, and the run once more for what it shows. Empty, or what went wrong.
std::string write_page(const std::string& path, const scenario::Resolved& resolved, const results::RunResult& result) {
  const InterruptGuard interrupt;
  report::Replay replay(resolved, result);
  replay.advance([&] { return interrupt.requested(); });
  return output::write_file(path, report::run_page(resolved, result, replay));
}

/// The files of the folder whose names are known before the run: where one of them is a folder, the run would be for
/// nothing.
bool can_write_files(const std::string& out, const output::Recording& recording, bool is_json) {
  if (out.empty()) return true;
  std::vector<std::string> names(output::result_files.begin(), output::result_files.end());
  for (std::string& name : recording.files()) names.push_back(std::move(name));
  for (std::string& name : names) name = (std::filesystem::path(out) / name).string();
  std::vector<Place> places;
  for (const std::string& name : names) places.push_back({"--out", name, Place::Kind::file});
  return can_write(places, is_json);
}

ScenarioDone run(const RunOptions& options, const LoadedScenario& loaded) {
  const bool is_json = options.batch.scenario.is_json();
  const std::string& page_file = options.batch.report;
  json::Diagnostics diagnostics;
  const scenario::Division division = division_for(*loaded.resolved, options.threads);
  std::optional<scenario::Run> whole;
  std::optional<scenario::DividedRun> divided;
  division.is_divided() ? void(divided.emplace(*loaded.resolved, division)) : void(whole.emplace(*loaded.resolved));
  std::optional<output::Recording> recording;
  whole ? void(recording.emplace(options.recording, loaded.out, *whole, diagnostics))
        : void(recording.emplace(options.recording, loaded.out, *divided, diagnostics));
  if (diagnostics.has_errors()) {
    tell(diagnostics);
    return {ExitStatus::bad_input};
  }
  if (!can_write_files(loaded.out, *recording, is_json)) return {ExitStatus::bad_input};
  std::optional<output::WrittenFiles> folder;
  if (!loaded.out.empty()) {
    folder.emplace(loaded.out, "run", loaded.file);
    if (const std::string problem = folder->begin(); !problem.empty()) return {cannot_write(problem)};
  }
  if (const std::string problem = recording->open(); !problem.empty()) return {cannot_write(problem)};
  const bool show_progress = !options.batch.quiet && !is_json;
  const bool is_recorded = options.recording.is_wanted();
  const bool complete = whole ? simulate(*whole, *recording, is_recorded, show_progress)
                              : simulate(*divided, *recording, is_recorded, show_progress);
  results::RunResult result = evaluation::evaluate(whole ? *whole : divided->gathered(), !complete);
  evaluation::keep_requirements(result, loaded.asked);
  if (const std::string problem = recording->close(); !problem.empty()) return {cannot_write(problem)};
  const bool report_is_inside = folder && !page_file.empty() && folder->add_if_inside(page_file);
  if (folder) {
    if (!options.batch.junit.empty()) folder->add_if_inside(options.batch.junit);
    for (std::string& name : recording->files()) folder->add(std::move(name));
    if (const std::string problem =
            output::write_result_folder(*folder, result, json::encode(loaded.resolved->scenario));
        !problem.empty())
      return {cannot_write(problem)};
  }
  if (!page_file.empty())
    if (const std::string problem = write_page(page_file, *loaded.resolved, result); !problem.empty())
      return {cannot_write(problem)};
  ScenarioDone done{status_of(result)};
  done.page = is_json               ? results::run_json(result)
              : options.batch.quiet ? output::run_line(result)
                                    : output::run_report(result, {page_width(), options.all});
  done.told = folder ? folder->summary() : "";
  done.report = report_is_inside ? "" : page_file;
  done.suite = report::suite_of(loaded.file, result);
  return done;
}

/// What is recorded is of one scenario, and lies in a folder.
bool can_record(const RunOptions& options) {
  if (!options.recording.is_wanted()) return true;
  constexpr const char* recordings = "--pcap, --timeline, --waves, --clocks or --frames";
  json::Diagnostics diagnostics;
  if (options.batch.out.empty())
    diagnostics.error({"command line", 0, 0, ""}, "a recording without a folder", {recordings, "--out DIR"});
  if (!options.batch.is_single())
    diagnostics.error({"command line", 0, 0, ""}, "a recording of several scenarios",
                      {recordings, "a call for each scenario"});
  tell(diagnostics);
  return !diagnostics.has_errors();
}

}  // namespace

void add_run_command(Command app, ExitStatus& status) {
  const Command command = app.add_subcommand("run", "Simulate a scenario and judge it");
  const auto options = std::make_shared<RunOptions>();
  add_batch_options(command, options->batch);
  command
      .add_option("--out", options->batch.out,
                  "Write result.json, tables and the resolved scenario into this folder; of several scenarios into "
                  "DIR/NAME of each file")
      .type_name("DIR");
  command
      .add_option("--report", options->batch.report,
                  "Write a page with pictures into this file: verdicts, network, gates, latencies, reactions")
      .type_name("FILE.html");
  command
      .add_option("--pcap", options->recording.pcap,
                  "Capture what these ports send, for Wireshark, as DIR/PORT.pcapng: all, NODE, NODE:PORT, or "
                  "stream:NAME for the frames of a stream at each port (repeatable)")
      .type_name("PORT")
      .one_value_each();
  command.add_flag("--timeline", options->recording.timeline,
                   "Write frames, their ways and waits, gates and states as DIR/timeline.json, for ui.perfetto.dev");
  command.add_flag("--waves", options->recording.waves,
                   "Write links, queues, gates, states of Programs and digital outputs as DIR/waves.vcd and "
                   "waves.gtkw, for GTKWave");
  command.add_flag("--clocks", options->recording.clocks,
                   "Write the offsets of all clocks from their grandmasters as DIR/clocks.csv");
  command.add_flag("--frames", options->recording.frames,
                   "Write what became of each frame, and when, as DIR/frames.csv, and where its time went at each hop "
                   "as DIR/hops.csv");
  command.add_option("--from", options->recording.from, "Record from then on").type_name("D").default_text("the start");
  command.add_option("--to", options->recording.to, "Record until then").type_name("D").default_text("the end");
  command.add_option("--stream", options->recording.streams, "Record frames of this stream only (repeatable)")
      .type_name("NAME")
      .one_value_each()
      .default_text("all");
  add_threads_option(command, options->threads);
  command.add_flag("--all", options->all,
                   "Print all changes of state, reactions, streams and so on, however many there are");
  command.add_flag("--quiet", options->batch.quiet, "Print one line");
  command.footer(
      "Examples:\n"
      "  takt run scenarios/robot-arm.json\n"
      "  takt run scenarios/robot-arm.json --seed 7 --duration 1min --quiet\n"
      "  takt run scenarios/robot-arm.json --set programs.0.cycle=1ms --out out/slow\n"
      "  takt run scenarios/robot-arm.json --duration 1100ms --out out/look --pcap all --timeline\n"
      "  takt run scenarios/robot-arm.json --report out/robot-arm.html\n"
      "  takt run scenarios/ring-1000.json --threads 2\n"
      "  takt run scenarios/robot-arm.json --out out/look --frames --stream camera --from 1s --to 1100ms\n"
      "  takt run scenarios/robot-arm.json scenarios/first-cell.json --quiet --junit out/run.xml\n"
      "  takt run scenarios/robot-arm.json --only 'reaction halt*'\n"
      "  takt run scenarios/robot-arm.json --format json | jq .programs.trajectory.reactions\n"
      "Exit status: 0 pass, 1 a requirement failed, 2 bad input, 3 internal error, 4 undecided (clocks that follow "
      "several "
      "grandmasters), 130 interrupted; of several scenarios the gravest.");
  command.callback([options, &status] {
    scenario::put_heap_on_huge_pages();
    status = ExitStatus::bad_input;
    if (!can_record(*options)) return;
    status = run_batch(options->batch, "takt run", [&](const LoadedScenario& each) { return run(*options, each); });
  });
}

}  // namespace takt::cli
