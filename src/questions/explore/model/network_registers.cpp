// SPDX-License-Identifier: Apache-2.0
// The network of registers: each channel holds the last published word, and one delayed copy may be under way.
#include "explore/model/group_model.hpp"

namespace takt::explore {

using handshake::Input;
using handshake::PublishedState;

bool GroupModel::act_on_registers(const State& state, Action action, Next& next) {
  switch (action.kind) {
    case ActionKind::send:
      return query_.has_recordings() ? publish_and_record(state, action.who, next)
                                     : publish_to_register(state, action.who, next);
    case ActionKind::receive:
      return query_.has_recordings() ? sample_recorded(state, action.who, next) : sample(state, action.who, next);
    case ActionKind::deliver_late:
      return sample_late(state, next);
    case ActionKind::lose:
      return empty_register(state, action.who, next);
    case ActionKind::duplicate:
      return keep_copy(state, action.who, false, next);
    case ActionKind::reorder:
      return keep_copy(state, action.who, true, next);
    default:
      return false;
  }
}

bool GroupModel::publish_to_register(const State& state, std::size_t channel, Next& next) const {
  const Members::Traits& sender = members_[state.member(wiring_.sender(channel))];
  if ((sender.word == state.reg(channel) && !state.outdated(channel)) || sender.down) return false;
  next = {state, {}};
  next.state.set_reg(channel, sender.word);
  next.state.set_outdated(channel, false);
  if (state.late() == Late::same && state.late_channel() == channel) next.state.set_late(Late::newer_sent);
  return true;
}

/// It stands there like one that was published. False if there is no room.
bool GroupModel::put_into_channel(const State& state, std::size_t channel, WordId word, Next& next) {
  if (query_.network == Network::channels) {
    Content content = contents_[state.content(channel)];
    if (content.size() >= query_.capacity) return false;
    content.push(word);
    next.state.set_content(channel, contents_.intern(content));
    return true;
  }
  next.state.set_reg(channel, word);
  next.state.set_outdated(channel, false);
  if (state.late() == Late::same && state.late_channel() == channel) next.state.set_late(Late::newer_sent);
  return true;
}

bool GroupModel::sample(const State& state, std::size_t channel, Next& next) {
  const WordId word = state.reg(channel);
  const std::size_t receiver = wiring_.receiver(channel);
  if (word == no_word || is_down(state, receiver)) return false;
  const MemberId before = state.member(receiver);
  const Stepped stepped = members_.step(before, {Input::Kind::received, wiring_.peer(channel), word, false});
  const bool overtakes = state.late() == Late::newer_sent && state.late_channel() == channel;
  const bool is_stale = stepped.data_counts && state.outdated(channel);
  if (stepped.member == before && stepped.effect == 0 && !overtakes && !is_stale) return false;
  next = {state, {}};
  next.state.set_member(receiver, stepped.member);
  if (overtakes) next.state.set_late(Late::overtaken);
  if (is_stale) next.properties.insert(Property::S3);
  if (stepped.effect != 0) watch(receiver, stepped.effect, next);
  return stepped.member != before || overtakes || next.properties.bits != 0;
}

bool GroupModel::sample_late(const State& state, Next& next) {
  if (state.late() == Late::none) return false;
  next = {state, {}};
  const std::size_t channel = state.late_channel();
  const std::size_t receiver = wiring_.receiver(channel);
  if (!is_down(state, receiver)) {
    bool data_counts = false;
    step(receiver, {Input::Kind::received, wiring_.peer(channel), state.late_word(), state.late() == Late::overtaken},
         next, data_counts);
    if (data_counts && state.outdated(State::late_data)) next.properties.insert(Property::S3);
  }
  next.state.clear_late();
  next.state.set_outdated(State::late_data, false);
  return true;
}

bool GroupModel::empty_register(const State& state, std::size_t channel, Next& next) {
  if (state.reg(channel) == no_word) return false;
  next = {state, {}};
  next.state.set_reg(channel, no_word);
  next.state.set_outdated(channel, false);
  if (query_.has_recordings()) empty_standing(channel, next);
  return true;
}

/// A copy of what stands in the register stays behind; if it is to be overtaken, the next word is published at once.
bool GroupModel::keep_copy(const State& state, std::size_t channel, bool overtaken, Next& next) const {
  if (state.late() != Late::none || state.reg(channel) == no_word) return false;
  State kept = state;
  kept.set_late(Late::same, channel, state.reg(channel));
  kept.set_outdated(State::late_data, state.outdated(channel));
  next = {kept, {}};
  return !overtaken || publish_to_register(kept, channel, next);
}

/// Nothing of it is under way any more. The delayed copy may still come.
bool GroupModel::forget_channel(std::size_t channel, Next& next) {
  if (query_.network == Network::channels) {
    if (next.state.content(channel) == Contents::empty) return false;
    next.state.set_content(channel, Contents::empty);
    return true;
  }
  if (next.state.reg(channel) == no_word) return false;
  next.state.set_reg(channel, no_word);
  next.state.set_outdated(channel, false);
  if (query_.has_recordings()) empty_standing(channel, next);
  return true;
}

/// `paper`: a round of this participant begins, and all data that is under way to it is from before.
void GroupModel::outdate(std::size_t participant, Next& next) {
  for (std::size_t c = 0; c < wiring_.size(); ++c) {
    if (wiring_.receiver(c) != participant) continue;
    if (query_.network == Network::channels) {
      Content content = contents_[next.state.content(c)];
      for (std::size_t i = 0; i < content.size(); ++i)
        content[i].outdated = content[i].outdated || members_.word(content[i].word).state == PublishedState::Running;
      next.state.set_content(c, contents_.intern(content));
    } else if (next.state.reg(c) != no_word && members_.word(next.state.reg(c)).state == PublishedState::Running) {
      next.state.set_outdated(c, true);
    }
  }
  if (next.state.late() != Late::none && wiring_.receiver(next.state.late_channel()) == participant)
    next.state.set_outdated(State::late_data, true);
}

bool GroupModel::is_up_to_date(const State& state, std::size_t channel) const {
  const WordId said = members_[state.member(wiring_.sender(channel))].word;
  if (query_.network == Network::registers) return state.reg(channel) == said;
  const Content& content = contents_[state.content(channel)];
  for (std::size_t i = 0; i < content.size(); ++i)
    if (content[i].word != said) return false;
  return true;
}

}  // namespace takt::explore
