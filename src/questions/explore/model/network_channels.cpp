// SPDX-License-Identifier: Apache-2.0
// The network of bounded channels: each holds the messages in flight, oldest first (Contents).
#include "explore/model/group_model.hpp"

namespace takt::explore {

using handshake::Input;

bool GroupModel::act_on_channels(const State& state, Action action, Next& next) {
  const std::size_t channel = action.who;
  switch (action.kind) {
    case ActionKind::send:
      return publish_to_channel(state, channel, next);
    case ActionKind::receive: {
      const std::optional<std::size_t> position = contents_[state.content(channel)].next();
      return position && hear(state, channel, *position, next);
    }
    case ActionKind::deliver_late: {
      const Content& content = contents_[state.content(channel)];
      return action.what < content.size() && content[action.what].strays && hear(state, channel, action.what, next);
    }
    default:
      return change_content(state, action, next);
  }
}

/// Who publishes the same again while that is still in flight changes nothing; what finds the channel full is lost.
bool GroupModel::publish_to_channel(const State& state, std::size_t channel, Next& next) {
  const Members::Traits& sender = members_[state.member(wiring_.sender(channel))];
  const Content& before = contents_[state.content(channel)];
  if (sender.down || before.size() >= query_.capacity) return false;
  const Message* last = before.last();
  if (last != nullptr && last->word == sender.word && !last->outdated && !last->strays) return false;
  Content content = before;
  content.push(sender.word);
  next = {state, {}};
  next.state.set_content(channel, contents_.intern(content));
  return true;
}

/// Whoever is down hears nothing: what arrives there is gone.
bool GroupModel::hear(const State& state, std::size_t channel, std::size_t position, Next& next) {
  const std::size_t receiver = wiring_.receiver(channel);
  Content content = contents_[state.content(channel)];
  const Message message = content.take(position);
  next = {state, {}};
  next.state.set_content(channel, contents_.intern(content));
  if (is_down(state, receiver)) return true;
  bool data_counts = false;
  step(receiver, {Input::Kind::received, wiring_.peer(channel), message.word, message.overtaken}, next, data_counts);
  if (data_counts && message.outdated) next.properties.insert(Property::S3);
  return true;
}

bool GroupModel::change_content(const State& state, Action action, Next& next) {
  Content content = contents_[state.content(action.who)];
  const bool has_room = content.size() < query_.capacity;
  const std::optional<std::size_t> first = content.next();
  switch (action.kind) {
    case ActionKind::lose:
      if (action.what >= content.size()) return false;
      content.remove(action.what);
      break;
    case ActionKind::duplicate:
      if (!first || !has_room) return false;
      content.copy(*first);
      break;
    case ActionKind::reorder:
      if (!first) return false;
      content[*first].strays = true;
      break;
    default:
      return false;
  }
  next = {state, {}};
  next.state.set_content(action.who, contents_.intern(content));
  return true;
}

}  // namespace takt::explore
