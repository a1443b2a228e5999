// SPDX-License-Identifier: Apache-2.0
#include "scenario/programs/program_monitor.hpp"

#include <utility>

namespace takt::scenario {
namespace {
// Kinds of digest records, apart from those of the network (models::Occurrence).
constexpr std::uint32_t state_changed = 100;
constexpr std::uint32_t method_called = 101;
constexpr std::uint32_t data_received = 102;
constexpr std::uint32_t crashed = 103;
constexpr std::uint32_t word_changed = 105;  // 104: see role_monitor.cpp

/// All that a word says.
std::uint64_t content_of(const handshake::Word& word) {
  const handshake::Intent& intent = word.intent;
  return sim::Content(word.incarnation, word.state, word.run, intent.number, intent.kind, intent.origin, intent.run)
      .value();
}
}  // namespace

ProgramMonitor::ProgramMonitor(sim::Simulation& simulation, Observations& observations, std::uint32_t number,
                               handshake::Variant variant, std::size_t participants,
                               std::vector<sim::Duration> instants)
    : simulation_(&simulation),
      observations_(&observations),
      variant_(variant),
      sending_(participants),
      number_(number),
      observer_(variant, participants),
      tracker_(participants),
      nodes_(participants),
      is_dead_(participants, false),
      instants_(std::move(instants)),
      counts_(instants_) {}

void ProgramMonitor::judge(const Observation& what) {
  std::visit([this](const auto& each) { judge(each); }, what);
}

void ProgramMonitor::on_step(std::size_t participant, const handshake::Outputs& outputs, const handshake::Word& after) {
  if (outputs.is_quiet()) return;
  for (const handshake::StateChange& change : outputs.changes()) {
    sending_[participant] = change.to;
    if (variant_ == handshake::Variant::paper && handshake::RunHistory<handshake::AnyStorage>::begins_round(change))
      ++rounds_;
  }
  observe(observed::Step{participant, outputs, after});
}

void ProgramMonitor::judge(const observed::Step& step) {
  const auto& [participant, outputs, after] = step;
  observer_.on_step(participant, outputs, after);
  const handshake::Origin origin = outputs.raised ? origin_of(outputs) : handshake::Origin();
  if (tree_ != nullptr) tree_->on_step(group_, participant, outputs, after, origin);
  tracker_.on_step(participant, outputs, after, simulation_->now(), origin);
  if (outputs.alarm == handshake::Alarm::peer_left) last_leave_ = sim::TrueTime::never();
  for (const handshake::StateChange& change : outputs.changes()) {
    ++changes_;
    counts_.add(simulation_->now(), [](Counts& counts) { ++counts.changes; });
    if (history_.size() < most_records)
      history_.push_back({simulation_->now(), static_cast<std::uint8_t>(participant), change});
    simulation_->digest().add(state_changed, static_cast<std::uint64_t>(number_) << 32 | participant,
                              simulation_->now(),
                              static_cast<std::uint64_t>(change.transition) << 16 |
                                  static_cast<std::uint64_t>(change.from) << 8 | static_cast<std::uint64_t>(change.to));
  }
  simulation_->digest().add(word_changed, static_cast<std::uint64_t>(number_) << 32 | participant, simulation_->now(),
                            content_of(after));
  note_violations();
}

handshake::Origin ProgramMonitor::origin_of(const handshake::Outputs& outputs) const {
  using handshake::Cause;
  switch (outputs.alarm) {
    case handshake::Alarm::none:
      return {Cause::command, sim::TrueTime::never(),
              !is_called_ && outputs.raised_kind == handshake::IntentKind::Start};
    case handshake::Alarm::peer_silent:
      return silence_;
    case handshake::Alarm::peer_restarted:
      return {Cause::restart, last_back_};
    case handshake::Alarm::peer_left:
      return {Cause::leave, last_leave_};
    case handshake::Alarm::mismatch:
      return {Cause::mismatch};
    case handshake::Alarm::other_group:
      return {Cause::nested};
  }
  return {};
}

void ProgramMonitor::judge(const observed::Silence& silence) {
  silence_ =
      explain_silence(faults_, nodes_[silence.peer], nodes_[silence.participant], silence.since, simulation_->now());
}

void ProgramMonitor::judge(const observed::Call& call) {
  const auto& [participant, method, status] = call;
  is_called_ = false;
  calls_.push_back({simulation_->now(), static_cast<std::uint8_t>(participant), method, status});
  simulation_->digest().add(method_called, static_cast<std::uint64_t>(number_) << 32 | participant, simulation_->now(),
                            static_cast<std::uint64_t>(method) << 32 | static_cast<std::uint32_t>(status));
}

void ProgramMonitor::on_crash(std::size_t participant, handshake::PublishedState before) {
  sending_[participant] = handshake::PublishedState::Halted;
  observe(observed::Crash{participant, before});
}

void ProgramMonitor::on_gone(std::size_t participant, handshake::PublishedState before) {
  sending_[participant] = handshake::PublishedState::Halted;
  observe(observed::Gone{participant, before});
}

void ProgramMonitor::judge(const observed::Crash& crash) {
  const auto& [participant, before] = crash;
  is_dead_[participant] = true;
  lives_.push_back({simulation_->now(), static_cast<std::uint8_t>(participant), false});
  if (tree_ != nullptr) tree_->on_crash(group_, participant);
  tracker_.on_crash(participant, simulation_->now());
  note_gone(participant, before);
}

void ProgramMonitor::judge(const observed::Gone& gone) {
  const auto& [participant, before] = gone;
  if (tree_ != nullptr) tree_->on_gone(group_, participant);
  tracker_.on_leave(participant, simulation_->now());
  note_gone(participant, before);
}

void ProgramMonitor::judge(const observed::Back& back) {
  const auto& [participant, node] = back;
  nodes_[participant] = node;
  if (is_dead_[participant]) {
    last_back_ = simulation_->now();
    lives_.push_back({simulation_->now(), static_cast<std::uint8_t>(participant), true});
  }
  is_dead_[participant] = false;
  if (tree_ != nullptr) tree_->on_back(group_, participant);
  tracker_.on_restart(participant, simulation_->now());
}

void ProgramMonitor::note_gone(std::size_t participant, handshake::PublishedState before) {
  observer_.on_restart(participant);
  simulation_->digest().add(crashed, static_cast<std::uint64_t>(number_) << 32 | participant, simulation_->now(),
                            static_cast<std::uint64_t>(before));
  if (before == handshake::PublishedState::Halted) return;
  ++changes_;
  counts_.add(simulation_->now(), [](Counts& counts) { ++counts.changes; });
  if (history_.size() < most_records)
    history_.push_back(
        {simulation_->now(), static_cast<std::uint8_t>(participant), {0, before, handshake::PublishedState::Halted}});
}

void ProgramMonitor::judge(const observed::ProcessData& data) {
  const auto& [from, to, sent_in] = data;
  ++process_data_received_;
  counts_.add(simulation_->now(), [](Counts& counts) { ++counts.process_data_received; });
  observer_.on_process_data(from, to, sent_in);
  simulation_->digest().add(data_received, static_cast<std::uint64_t>(number_) << 32 | from << 8 | to,
                            simulation_->now(), sent_in);
  if (!observer_.violations().empty()) [[unlikely]]
    note_violations();
}

void ProgramMonitor::note_violations() {
  const std::span<const handshake::Violation> all = observer_.violations();
  if (violations_.size() == all.size()) [[likely]]
    return;
  for (std::size_t i = violations_.size(); i < all.size(); ++i) violations_.push_back({simulation_->now(), all[i]});
}

}  // namespace takt::scenario
