// SPDX-License-Identifier: Apache-2.0
#include "studio/timeline_sink.hpp"

#include <algorithm>

#include "models/egress/preemption.hpp"
#include "models/ethernet/sizes.hpp"
#include "output/program_states.hpp"

namespace takt::studio {
namespace {

constexpr int class_shift = 8;

}  // namespace

TimelineSink::TimelineSink(const scenario::Run& run, const Timeline::Limits& limits, Timeline& timeline)
    : run_(&run),
      limits_(limits),
      timeline_(&timeline),
      directory_(run.network()),
      gates_(run.network(), directory_),
      drops_(run.network(), directory_) {
  const auto& nodes = run.network().plan().nodes;
  for (const models::PortDirectory::Port& port : directory_.ports())
    timeline.rows_.push_back({nodes[port.id.node.value].name,
                              port.id.port,
                              port.peer.is_none() ? std::string() : nodes[port.peer.value].name,
                              {},
                              {}});
  for (const models::Stream& stream : run.network().traffic().streams()) timeline.streams_.push_back(stream.name);
  for (std::uint32_t position = 0; position < directory_.ports().size(); ++position)
    show_gates(position, sim::TrueTime());
}

void TimelineSink::show_gates(std::uint32_t position, sim::TrueTime at) {
  if (!gates_.has_gates(position)) return;
  auto& shown = timeline_->rows_[position].gates;
  const auto open = static_cast<std::uint32_t>(gates_.states(position, at) & 0xFF);
  if (!shown.empty() && shown.back().open == open) return;
  // Before the stretch that is kept only the last state counts.
  if (!shown.empty() && at <= timeline_->from_) {
    shown.back() = {at.ps(), open};
    return;
  }
  shown.push_back({at.ps(), open});
  is_full_ = is_full_ || ++changes_ >= limits_.gate_changes;
}

void TimelineSink::follow_gates(sim::TrueTime now) {
  while (gates_.next_time() <= now) {
    const output::GateFollower::Change change = gates_.pop();
    show_gates(change.position, change.time);
  }
}

void TimelineSink::record(const sim::TraceRecord& record) {
  if (is_full_) return;
  last_ = record.time;
  follow_gates(record.time);
  const auto kind = static_cast<models::Occurrence>(record.kind);
  const bool begins = kind == models::Occurrence::started || kind == models::Occurrence::resumed;
  // A copy that came twice is no loss.
  const bool is_drop =
      kind == models::Occurrence::drop && record.detail != static_cast<std::uint64_t>(models::DropReason::duplicate);
  drops_.record(record);
  if (!begins && !is_drop && kind != models::Occurrence::cut && kind != models::Occurrence::gates_changed) return;
  const std::uint32_t position = is_drop ? drops_.of(record).port : directory_.find(record.where);
  if (position == models::PortDirectory::none) return;
  if (kind == models::Occurrence::gates_changed) {
    gates_.look_at(position, record.time);
    show_gates(position, record.time);
    return;
  }
  const models::PortDirectory::Port& port = directory_.ports()[position];
  auto& sent = timeline_->rows_[position].sent;
  const auto detail = models::TransmissionDetail::unpack(record.detail);
  const auto length = [&](std::uint32_t octets) {
    return static_cast<float>((port.octet_time * (std::int64_t{models::preamble_and_sfd.count} + octets)).ps());
  };
  if (kind == models::Occurrence::cut) {
    const auto last = std::find_if(sent.rbegin(), sent.rend(), [](const Timeline::Sent& each) {
      return (each.flags & Timeline::Sent::dropped) == 0;
    });
    if (last == sent.rend()) return;
    last->length = length(detail.octets + models::mcrc.count);
    last->flags |= Timeline::Sent::cut;
    return;
  }
  if (record.time < timeline_->from_) return;
  const models::Frame& frame = run_->network().traffic().frame({static_cast<std::uint32_t>(record.what)});
  const std::uint32_t flags = is_drop ? Timeline::Sent::dropped
                                      : static_cast<std::uint32_t>(detail.traffic_class) << class_shift |
                                            (kind == models::Occurrence::resumed ? Timeline::Sent::continued : 0);
  sent.push_back({record.time.ps(), is_drop ? 0.0F : length(detail.octets), frame.stream.value,
                  static_cast<std::uint32_t>(frame.sequence), flags});
  is_full_ = ++timeline_->frames_ >= limits_.frames;
}

void TimelineSink::finish(sim::TrueTime now) {
  if (!is_full_) follow_gates(now);
  timeline_->to_ = is_full_ ? last_ : now;
  timeline_->is_whole_ = !is_full_ && now >= run_->end();
  for (std::size_t p = 0; p < run_->resolved().programs.size(); ++p) add_program(p);
}

void TimelineSink::add_program(std::size_t program) {
  const scenario::ResolvedProgram& described = run_->resolved().programs[program];
  const scenario::ProgramMonitor& monitor = run_->monitor(program);
  for (std::size_t i = 0; i < described.participant_names.size(); ++i) {
    Timeline::Track track{described.name, described.participant_names[i], {}};
    for (const auto& [time, state] : output::states_of(monitor, i)) {
      // What is over at the instant at which it began is not seen.
      if (!track.states.empty() && track.states.back().first == time.ps()) track.states.pop_back();
      track.states.emplace_back(time.ps(), std::string(state));
    }
    timeline_->tracks_.push_back(std::move(track));
  }
  Timeline::Track reactions{described.name, "reactions", {}};
  sim::TrueTime free;
  for (const handshake::Reaction& reaction : monitor.reactions()) {
    if (reaction.began < free || reaction.outcome != handshake::ReactionOutcome::completed)
      continue;  // it has come while another one was under way
    reactions.states.emplace_back(reaction.began.ps(), std::string(handshake::name_of(reaction.kind)));
    reactions.states.emplace_back(reaction.completed.ps(), std::string());
    free = reaction.completed;
  }
  timeline_->tracks_.push_back(std::move(reactions));
}

}  // namespace takt::studio
