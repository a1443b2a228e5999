// SPDX-License-Identifier: Apache-2.0
#include "papers/handshakes.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "evaluation/evaluate.hpp"
#include "papers/charts.hpp"
#include "report/sequence_figure.hpp"
#include "scenario/resolve.hpp"

namespace takt::papers {
namespace {

using handshake::PublishedState;

/// A figure: the call of the script that it shows, and the changes of state in their order.
struct Sequence {
  const char* name;
  const char* title;
  std::int64_t at_us;  // of the call
  const char* call;
  char side;
  std::vector<std::pair<std::size_t, PublishedState>> changes;
  /// With the handshake of the paper it goes on so, against the figure.
  std::vector<std::pair<std::size_t, PublishedState>> flaw = {};
};

const std::vector<Sequence>& sequences() {
  using enum PublishedState;
  static const std::vector<Sequence> all = {
      {"fig-3", "Fig. 3: starting", 100'050, "Start", 0, {{1, Ready}, {0, Ready}, {1, Running}, {0, Running}}},
      {"fig-4a", "Fig. 4 (a): halted by the master", 900'050, "Halt", 'a', {{0, Halted}, {1, Halted}}},
      {"fig-4b", "Fig. 4 (b): halted by the slave", 1'050'050, "Halt", 'b', {{1, Halted}, {0, Halted}}},
      {"fig-5a", "Fig. 5 (a): resumed by the master", 350'050, "Resume", 'a', {{0, Running}, {1, Running}}},
      {"fig-5b", "Fig. 5 (b): resumed by the slave", 250'050, "Resume", 'b', {{1, Running}, {0, Running}}},
      {"fig-6a", "Fig. 6 (a): SUSPENDED to READY by the master", 450'050, "Reset", 'a', {{0, Ready}, {1, Ready}}},
      {"fig-6b",
       "Fig. 6 (b): SUSPENDED to READY by the slave",
       700'050,
       "Reset",
       'b',
       {{1, Ready}, {0, Ready}},
       {{1, Running}, {0, Running}}},
  };
  return all;
}

constexpr sim::Duration shown = sim::Duration::from_ps(40'000'000'000);  // no script entry comes sooner

std::vector<std::pair<std::size_t, PublishedState>> changes_in(const scenario::ProgramMonitor& monitor,
                                                               const Sequence& sequence) {
  const sim::TrueTime from = sim::TrueTime() + sim::Duration::from_ps(sequence.at_us * 1'000'000);
  std::vector<std::pair<std::size_t, PublishedState>> seen;
  for (const scenario::StateRecord& record : monitor.history())
    if (record.time >= from && record.time < from + shown && record.change.transition != 0)
      seen.emplace_back(record.participant, record.change.to);
  return seen;
}

Comparison order_of(const Sequence& sequence, bool is_paper, const scenario::ProgramMonitor& monitor) {
  auto expected = sequence.changes;
  const bool has_flaw = is_paper && !sequence.flaw.empty();
  if (has_flaw) expected.insert(expected.end(), sequence.flaw.begin(), sequence.flaw.end());
  Comparison made;
  made.what = fmt::format("{}, {} handshake",
                          std::string_view(sequence.title).substr(0, std::string_view(sequence.title).find(':')),
                          is_paper ? "paper's" : "robust");
  made.published = "as drawn";
  made.holds = changes_in(monitor, sequence) == expected;
  made.reproduced = !made.holds ? "another order" : has_flaw ? "drawn, then starts" : "as drawn";
  if (has_flaw) {
    made.standing = Standing::flaw;
    made.remark =
        "the slave hears the master's READY of Fig. 6 (b) as (4) of Fig. 3 and runs; see "
        "scenarios/findings/paper-reset-restarts-L1.json";
  }
  return made;
}

}  // namespace

bool reproduce_handshakes(const ProgramsOptions& options, Reproduction& made, json::Diagnostics& diagnostics) {
  made.figures.push_back({"fig-1", state_machine_chart()});
  for (const char* variant : {"paper", "robust"}) {
    const auto resolved = scenario::load_file(options.scenarios + "/handshakes.json",
                                              {std::string("/programs/0/variant=") + variant}, diagnostics);
    if (!resolved) return false;
    if (options.progress) options.progress(fmt::format("Fig. 3 to 6, {} handshake", variant));
    scenario::Run run(*resolved);
    report::MessageLog log(run, 0);
    run.simulation().set_trace(&log);
    run.advance();
    for (const Sequence& sequence : sequences()) {
      made.comparisons.push_back(order_of(sequence, std::string_view(variant) == "paper", run.monitor(0)));
      if (std::string_view(variant) != "paper") continue;
      report::Excerpt excerpt;
      excerpt.title = sequence.title;
      excerpt.from = sim::TrueTime() + sim::Duration::from_ps(sequence.at_us * 1'000'000);
      excerpt.to = excerpt.from + shown;
      excerpt.call = sequence.call;
      excerpt.numbers = sequence.side == 0     ? report::Numbers::start
                        : sequence.side == 'a' ? report::Numbers::side_a
                                               : report::Numbers::side_b;
      made.figures.push_back({sequence.name, chart::sequence_chart(report::sequence_of(run, log, excerpt))});
    }
  }
  return true;
}

}  // namespace takt::papers
