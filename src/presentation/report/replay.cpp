// SPDX-License-Identifier: Apache-2.0
#include "report/replay.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "output/text_report.hpp"

namespace takt::report {
namespace {

constexpr std::size_t most_sequences = 12;     // of a program
constexpr std::size_t most_participants = 24;  // more would not be legible

/// The slowest of each kind, in the order of time.
std::vector<const results::ReactionResult*> chosen(const std::vector<results::ReactionResult>& reactions) {
  std::map<std::string, const results::ReactionResult*> slowest;
  for (const results::ReactionResult& reaction : reactions) {
    if (!reaction.completed) continue;
    const auto [found, is_new] = slowest.emplace(reaction.kind + reaction.initiator + reaction.cause, &reaction);
    if (!is_new && *reaction.duration() > *found->second->duration()) found->second = &reaction;
  }
  std::vector<const results::ReactionResult*> all;
  for (const auto& [kind, reaction] : slowest) all.push_back(reaction);
  std::stable_sort(all.begin(), all.end(), [](const auto* a, const auto* b) { return a->began < b->began; });
  if (all.size() > most_sequences) all.resize(most_sequences);
  return all;
}

}  // namespace

Replay::Replay(const scenario::Resolved& resolved, const results::RunResult& result)
    : run_(resolved), ways_(run_.network(), result), end_(std::min(run_.end(), sim::TrueTime() + result.simulated)) {
  for (std::size_t p = 0; p < resolved.programs.size(); ++p) {
    logs_.emplace_back();
    const scenario::ResolvedProgram& program = resolved.programs[p];
    if (program.has_roles() || program.members.size() > most_participants) continue;
    std::vector<Span> spans;
    for (const results::ReactionResult* reaction : chosen(result.programs[p].reactions)) {
      const bool is_command = reaction->cause == "command";
      excerpts_.push_back(
          {fmt::format("{}: {} from {} at {}, {}", program.name, reaction->kind, reaction->initiator,
                       output::readable(reaction->began.since_start()), output::readable(*reaction->duration())),
           p, reaction->began, *reaction->completed, is_command ? "called" : reaction->cause, Numbers::none});
      spans.push_back({reaction->began, *reaction->completed + program.description->cycle * 2});
    }
    if (spans.empty()) continue;
    logs_.back() = std::make_unique<MessageLog>(run_, p, std::move(spans));
    sinks_.add(*logs_.back());
  }
  if (const auto longest = longest_gate_cycle(resolved); longest || has_discarded(result)) {
    watch_ = std::make_unique<GateWatch>(run_, longest, end_);
    sinks_.add(*watch_);
  }
  if (!result.clocks.empty()) run_.set_clock_sink(&clocks_.emplace(run_, result));
  if (!ways_.is_complete()) sinks_.add(way_recorder_.emplace(run_.network(), ways_));
}

bool Replay::run_until(sim::TrueTime time, const std::function<bool()>& is_interrupted) {
  constexpr std::uint64_t events_a_slice = 200'000;
  while (!run_.simulation().run(std::min(time, run_.end()), events_a_slice))
    if (is_interrupted()) return false;
  return true;
}

bool Replay::watch_gates(const std::function<bool()>& is_interrupted) {
  if (!run_until(watch_->begin(), is_interrupted)) return false;
  watch_->start();
  if (watch_->shows_gates()) {
    if (!run_until(watch_->middle(), is_interrupted)) return false;
    watch_->choose_cycle();
  } else {
    constexpr std::uint64_t events_a_slice = 20'000;
    while (!watch_->until() && !run_.simulation().run(end_, events_a_slice))
      if (is_interrupted()) return false;
  }
  if (const auto until = watch_->until(); until && !run_until(*until, is_interrupted)) return false;
  watch_->finish();
  return true;
}

/// On to the end, if need be: when the slowest frames come is in no result, nor are the offsets of clocks.
bool Replay::go_to_end(const std::function<bool()>& is_interrupted) {
  constexpr std::uint64_t events_a_slice = 200'000;
  while ((clocks_ || !ways_.is_complete()) && !run_.simulation().run(end_, events_a_slice))
    if (is_interrupted()) return false;
  return true;
}

bool Replay::advance(const std::function<bool()>& is_interrupted) {
  if (sinks_.empty() && !clocks_) return true;
  way_recorder_ || watch_ ? run_.explain_to(&sinks_) : run_.simulation().set_trace(&sinks_);
  sim::TrueTime last;
  for (const Excerpt& excerpt : excerpts_)
    last = std::max(last, excerpt.to + run_.resolved().programs[excerpt.program].description->cycle * 2);
  bool goes_on = watch_ == nullptr || watch_gates(is_interrupted);
  if (goes_on) goes_on = run_until(last, is_interrupted) && go_to_end(is_interrupted);
  run_.simulation().set_trace(nullptr);
  if (clocks_) clocks_->finish();
  return goes_on;
}

std::vector<chart::SequenceChart> Replay::sequences() const {
  std::vector<chart::SequenceChart> all;
  for (const Excerpt& excerpt : excerpts_) all.push_back(sequence_of(run_, *logs_[excerpt.program], excerpt));
  return all;
}

std::optional<chart::Gantt> Replay::gates() const { return watch_ ? watch_->figure() : std::nullopt; }

}  // namespace takt::report
