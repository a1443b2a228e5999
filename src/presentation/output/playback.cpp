// SPDX-License-Identifier: Apache-2.0
#include "output/playback.hpp"

#include <algorithm>
#include <tuple>

namespace takt::output {

using models::Occurrence;

void Playback::add(Tape& tape) {
  TAKT_CHECK(tape.part() == parts_.size(), "tapes are added in the order of their parts");
  parts_.push_back({&tape, {}, {}});
}

void Playback::play(sim::TrueTime until) {
  places_.clear();
  for (std::uint32_t p = 0; p < parts_.size(); ++p) {
    parts_[p].tape->complete(until);
    const std::vector<Note>& notes = parts_[p].tape->notes();
    for (std::uint32_t n = 0; n < notes.size(); ++n)
      if (notes[n].record.time <= until)
        places_.push_back({notes[n].record.time, !notes[n].is_there_already, notes[n].node, p, n});
  }
  std::ranges::sort(places_, [](const Place& a, const Place& b) {
    return std::tie(a.time, a.is_happening, a.node, a.tape, a.note) <
           std::tie(b.time, b.is_happening, b.node, b.tape, b.note);
  });
  for (std::size_t i = 0; i < places_.size(); ++i) {
    Part& part = parts_[places_[i].tape];
    tell(part, part.tape->notes()[places_[i].note]);
    if (i + 1 == places_.size() || places_[i + 1].time != places_[i].time) end_instant(places_[i].time);
  }
  for (Part& part : parts_) {
    part.tape->forget(until, part.ended);
    part.ended.clear();
  }
}

std::uint32_t Playback::begin_record() {
  if (free_records_.empty()) {
    free_records_.push_back(static_cast<std::uint32_t>(holders_.size()));
    holders_.push_back(0);
  }
  const std::uint32_t record = free_records_.back();
  free_records_.pop_back();
  holders_[record] = 1;
  return record;
}

std::uint32_t& Playback::record_of(Part& part, std::uint32_t life) {
  if (life >= part.record_of_life.size()) part.record_of_life.resize(part.tape->lives(), Note::none);
  return part.record_of_life[life];
}

void Playback::tell(Part& part, const Note& note) {
  switch (note.kind) {
    case Note::Kind::told:
      emit_record(part, note);
      break;
    case Note::Kind::left: {
      const std::uint32_t record = record_of(part, note.life);
      ++holders_[record];
      under_way_[way_of(part.tape->part(), note.record.where.index)].emplace(note.record.what, record);
      break;
    }
    case Note::Kind::came: {
      auto& crossing = under_way_[way_of(note.record.where.index, part.tape->part())];
      const auto found = crossing.find(note.record.what);
      TAKT_CHECK(found != crossing.end(), "what comes from another part has left there");
      record_of(part, note.life) = found->second;
      crossing.erase(found);
      break;
    }
    case Note::Kind::over:
      break;
  }
  if (!note.is_last) return;
  ends_.push_back(record_of(part, note.life));
  part.ended.push_back(note.life);
}

void Playback::emit_record(Part& part, const Note& note) {
  sim::TraceRecord record = note.record;
  if (note.frame != Note::none) moment_.frame = part.tape->frame(note);
  moment_.payload = part.tape->octets(note);
  moment_.queued_frames = note.queued_frames;
  moment_.delay = part.tape->delays(note).delay;
  moment_.node_delay = part.tape->delays(note).node_delay;
  if (note.life != Note::none) {
    const auto kind = static_cast<Occurrence>(record.kind);
    if (kind == Occurrence::separated)
      record.detail = note.parent == Note::none ? Note::none : record_of(part, note.parent);
    if (kind == Occurrence::produced || kind == Occurrence::separated) record_of(part, note.life) = begin_record();
    record.what = record_of(part, note.life);
  } else if (note.frame != Note::none) {
    record.what = Note::none;
  }
  sink_->record(record);
}

/// Only now: of two copies that end at one instant, the one that comes first here may be the one that ended last.
void Playback::end_instant(sim::TrueTime time) {
  for (const std::uint32_t record : ends_)
    if (--holders_[record] == 0) {
      sink_->record({time, static_cast<std::uint32_t>(Occurrence::ended), {}, record, 0});
      free_records_.push_back(record);
    }
  ends_.clear();
}

}  // namespace takt::output
