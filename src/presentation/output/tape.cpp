// SPDX-License-Identifier: Apache-2.0
#include "output/tape.hpp"

#include <algorithm>

namespace takt::output {

using models::Occurrence;

Tape::Tape(models::Network& network, std::uint32_t part, const TapeWants& wants)
    : network_(&network),
      part_(part),
      wants_(wants),
      directory_(network),
      node_of_component_(network.nodes_of_components()) {
  if (!wants.gates) return;
  gates_ = std::make_unique<GateFollower>(network, directory_, network.simulation().now());
  for (std::uint32_t position = 0; position < directory_.ports().size(); ++position) {
    show_gates(position, network.simulation().now(), true);
    const models::NodeIndex node = directory_.ports()[position].id.node;
    if (!network.has(node) || network.node_clock(node) == nullptr) continue;
    if (clocks_.empty() || clocks_.back()->node != node) {
      clocks_.push_back(std::make_unique<ClockOfGates>());
      clocks_.back()->tape = this;
      clocks_.back()->node = node;
      network.add_clock_listener(node, *clocks_.back());
    }
    clocks_.back()->positions.push_back(position);
  }
}

Tape::~Tape() {
  for (const auto& clock : clocks_) network_->remove_clock_listener(clock->node, *clock);
}

/// What the lists say before `until`. Not at that time itself: lists or the clock may yet change at that instant, and
/// what changes so has no say then.
void Tape::follow_gates(sim::TrueTime until) {
  while (gates_->next_time() < until) {
    const GateFollower::Change change = gates_->pop();
    show_gates(change.position, change.time);
  }
}

void Tape::show_gates(std::uint32_t position, sim::TrueTime at, bool is_there_already) {
  if (!gates_->has_gates(position)) return;
  const models::PortDirectory::Port& port = directory_.ports()[position];
  Note& note = notes_.emplace_back();
  note.record = {at, static_cast<std::uint32_t>(Occurrence::gates_shown), port.component, gates_->states(position, at),
                 0};
  note.node = port.id.node.value;
  note.is_there_already = is_there_already;
}

void Tape::clock_changed(const ClockOfGates& clock, sim::TrueTime now) {
  for (const std::uint32_t position : clock.positions) {
    gates_->look_at(position, now);
    show_gates(position, now);
  }
}

std::uint32_t Tape::node_of(const sim::TraceRecord& record) const {
  if (record.kind == static_cast<std::uint32_t>(Occurrence::output_changed)) return Note::none;
  TAKT_CHECK(record.where.index < node_of_component_.size() && !node_of_component_[record.where.index].is_none(),
             "what is recorded happens at a node");
  return node_of_component_[record.where.index].value;
}

void Tape::record(const sim::TraceRecord& record) {
  const auto kind = static_cast<Occurrence>(record.kind);
  if (gates_ && kind == Occurrence::gates_changed) {
    follow_gates(record.time);
    const std::uint32_t position = directory_.find(record.where);
    gates_->look_at(position, record.time);
    show_gates(position, record.time);
  }
  if (!wants_.ways && ((wants_.kinds >> record.kind & 1) == 0 || record.time < wants_.from || record.time > wants_.to))
    return;
  Note note;
  note.record = record;
  note.node = node_of(record);
  if (kind == Occurrence::separated) {
    note.parent = life_of(static_cast<std::uint32_t>(record.detail));
    note.life = begin_life(static_cast<std::uint32_t>(record.what));
  } else if (models::names_a_frame(kind)) {
    const models::Frame& frame = network_->traffic().frame({static_cast<std::uint32_t>(record.what)});
    if (wants_.ways) name_life(note, frame);
    keep_frame(note, frame);
  }
  const std::uint32_t position =
      wants_.queues || kind == Occurrence::started ? directory_.find(record.where) : models::PortDirectory::none;
  if (position != models::PortDirectory::none) {
    const models::PortId id = directory_.ports()[position].id;
    if (wants_.queues) note.queued_frames = models::View::queued_frames_now(*network_, id.node, id.port);
    if (wants_.ways && kind == Occurrence::started) {
      const models::LinkEnd& far_end = network_->ports(id.node)[id.port].link().reception().far_end;
      note.delays = static_cast<std::uint32_t>(delays_.size());
      delays_.push_back({far_end.delay, far_end.node_delay});
    }
  }
  notes_.push_back(note);
}

void Tape::keep_frame(Note& note, const models::Frame& frame) {
  note.frame = static_cast<std::uint32_t>(frames_.size());
  frames_.push_back(frame);
  if (!wants_.payloads || note.record.kind != static_cast<std::uint32_t>(Occurrence::started) ||
      frame.payload.is_none())
    return;
  const std::span<const std::byte> octets = network_->traffic().payload(frame.payload).view();
  note.octets_from = static_cast<std::uint32_t>(octets_.size());
  note.octets = static_cast<std::uint32_t>(octets.size());
  octets_.insert(octets_.end(), octets.begin(), octets.end());
}

/// Messages of gPTP, which end at the next node, are not followed, and nobody says when one is produced.
void Tape::name_life(Note& note, const models::Frame& frame) {
  if (frame.link_local) return;
  const auto kind = static_cast<Occurrence>(note.record.kind);
  const auto handle = static_cast<std::uint32_t>(note.record.what);
  note.life = kind == Occurrence::produced ? begin_life(handle) : life_of(handle);
  note.is_last = (kind == Occurrence::drop || kind == Occurrence::received) && frame.references == 1;
}

std::uint32_t Tape::begin_life(std::uint32_t handle) {
  if (free_lives_.empty()) free_lives_.push_back(static_cast<std::uint32_t>(lives_++));
  if (handle >= life_of_handle_.size()) life_of_handle_.resize(handle + std::size_t{1}, Note::none);
  life_of_handle_[handle] = free_lives_.back();
  free_lives_.pop_back();
  return life_of_handle_[handle];
}

void Tape::left(std::uint32_t to, const sim::Event& arrival, models::FrameIndex frame) {
  const std::uint64_t number = left_for_[to]++;
  if (network_->traffic().frame(frame).link_local) return;
  Note& note = notes_.emplace_back();
  note.kind = Note::Kind::left;
  note.record = {network_->simulation().now(), 0, {to}, number, 0};
  note.node = node_of_component_[arrival.source().index].value;
  note.life = life_of(frame.value);
}

void Tape::came(std::uint32_t from, const sim::Event& arrival, models::FrameIndex frame) {
  const std::uint64_t number = came_from_[from]++;
  if (network_->traffic().frame(frame).link_local) return;
  Note& note = notes_.emplace_back();
  note.kind = Note::Kind::came;
  note.record = {arrival.time, 0, {from}, number, 0};
  note.node = node_of_component_[arrival.target().index].value;
  note.life = begin_life(frame.value);
}

void Tape::over(models::FrameIndex frame) {
  if (network_->traffic().frame(frame).link_local) return;
  Note& note = notes_.emplace_back();
  note.kind = Note::Kind::over;
  note.record = {network_->simulation().now(), 0, {}, 0, 0};
  note.life = life_of(frame.value);
  note.is_last = true;
}

void Tape::forget(sim::TrueTime until, const std::vector<std::uint32_t>& ended_lives) {
  std::erase_if(notes_, [&](const Note& note) { return note.record.time <= until; });
  frames_.clear();
  octets_.clear();
  delays_.clear();
  free_lives_.insert(free_lives_.end(), ended_lives.begin(), ended_lives.end());
}

}  // namespace takt::output
