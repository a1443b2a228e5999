// SPDX-License-Identifier: Apache-2.0
// A stranger who has recorded all that was said, and hands it over again: what that changes in the network of
// registers.
#include "explore/model/group_model.hpp"

namespace takt::explore {

using handshake::Input;

std::uint32_t GroupModel::hearers_of(std::size_t sender) const {
  std::uint32_t hearers = 0;
  for (std::size_t c = 0; c < wiring_.size(); ++c)
    if (wiring_.sender(c) == sender) hearers |= 1U << wiring_.receiver(c);
  return hearers;
}

void GroupModel::set_recording(std::size_t sender, Recording recording, Next& next) {
  if (query_.is_signed) recording.forget(hearers_of(sender));
  next.state.set_recording(sender, recordings_.intern(recording));
}

/// The sender says its word of now, with its key of now.
bool GroupModel::publish_and_record(const State& state, std::size_t channel, Next& next) {
  const std::size_t from = wiring_.sender(channel);
  const std::size_t to = wiring_.receiver(channel);
  const Members::Traits& sender = members_[state.member(from)];
  if (sender.down) return false;
  Recording recording = recordings_[state.recording(from)];
  const auto life = static_cast<std::uint8_t>(members_.incarnation(state.member(from)));
  if (state.reg(channel) == sender.word && recording.says(sender.word, life) &&
      recording.standing(to) == recording.size())
    return false;
  next = {state, {}};
  recording.set_standing(to, recording.say(sender.word, life));
  next.state.set_reg(channel, sender.word);
  set_recording(from, recording, next);
  return true;
}

/// What stands in the register is heard.
bool GroupModel::sample_recorded(const State& state, std::size_t channel, Next& next) {
  const std::size_t to = wiring_.receiver(channel);
  if (state.reg(channel) == no_word || is_down(state, to)) return false;
  return deliver_recorded(state, channel, recordings_[state.recording(wiring_.sender(channel))].standing(to),
                          state.reg(channel), next);
}

bool GroupModel::deliver_recorded(const State& state, std::size_t channel, std::size_t place, WordId word, Next& next) {
  const std::size_t from = wiring_.sender(channel);
  const std::size_t to = wiring_.receiver(channel);
  Recording recording = recordings_[state.recording(from)];
  if (query_.is_signed && !recording.takes(to, place, recordings_[state.recording(to)].token())) return false;
  const bool is_newer = place > recording.taken(to);
  next = {state, {}};
  const bool changed = step(to, {Input::Kind::received, wiring_.peer(channel), word, false}, next);
  if (is_newer) {
    recording.take(to, place);
    set_recording(from, recording, next);
  }
  return changed || is_newer || next.properties.bits != 0;
}

/// `back`: how many were said after it.
bool GroupModel::replay(const State& state, std::size_t channel, std::size_t back, Next& next) {
  const std::size_t from = wiring_.sender(channel);
  const std::size_t to = wiring_.receiver(channel);
  const Recording recording = recordings_[state.recording(from)];
  if (back >= recording.size() || is_down(state, to)) return false;
  const std::size_t place = recording.size() - back;
  if (!deliver_recorded(state, channel, place, recording[place].word, next)) return false;
  if (place < recording.taken(to) && state_of(state, to) != state_of(next.state, to))
    next.properties.insert(Property::R1);
  return true;
}

/// Clocks differ by less than a lifetime.
bool GroupModel::change_key(const State& state, std::size_t participant, Next& next) {
  Recording recording = recordings_[state.recording(participant)];
  if (recording.token() >= query_.key_changes) return false;
  for (std::size_t i = 0; i <= query_.slaves; ++i)
    if (recordings_[state.recording(i)].token() < recording.token()) return false;
  next = {state, {}};
  recording.change_key();
  set_recording(participant, recording, next);
  return true;
}

/// Nothing of it stands in the register any more; what was recorded stays.
void GroupModel::empty_standing(std::size_t channel, Next& next) {
  const std::size_t from = wiring_.sender(channel);
  Recording recording = recordings_[next.state.recording(from)];
  recording.set_standing(wiring_.receiver(channel), 0);
  set_recording(from, recording, next);
}

}  // namespace takt::explore
