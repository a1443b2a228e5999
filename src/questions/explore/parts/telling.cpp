// SPDX-License-Identifier: Apache-2.0
#include "explore/parts/telling.hpp"

#include <algorithm>

namespace takt::explore {

namespace {

/// A step that needs a word in its register.
bool uses_register(ActionKind kind) {
  return kind == ActionKind::receive || kind == ActionKind::duplicate || kind == ActionKind::reorder;
}

}  // namespace

Telling::Telling(PartsModel& model, const State& state)
    : model_(&model), state_(state), chances_(2U * model.query().slaves) {
  const std::size_t slaves = model.query().slaves;
  const Parts& parts = model.parts();
  for (std::size_t c = 0; c < chances_.size(); ++c) {
    const SlaveId slave = model.slave(state, c % slaves + 1);
    const bool is_heard = c < slaves ? parts.known(slave).peer.heard : parts.slave_value(slave).known_of(0).heard;
    chances_[c].assign(said(state, c).size(), Chance{is_heard, false, 0});
  }
}

const Said& Telling::said(const State& state, std::size_t channel) const {
  const std::size_t slaves = model_->query().slaves;
  const SlaveId slave = model_->slave(state, channel % slaves + 1);
  return channel < slaves ? model_->parts().up(slave) : model_->parts().down(slave);
}

bool Telling::sender_is_up(const State& state, std::size_t channel) const {
  const std::size_t slaves = model_->query().slaves;
  return channel < slaves ? !model_->parts().of_slave(model_->slave(state, channel + 1)).down
                          : !model_->parts().of_master(model_->master(state)).down;
}

void Telling::take(Action action) {
  Next next;
  Action told = action;
  if (uses_register(action.kind)) {
    told.what = 0;
    const std::size_t count = said(state_, action.who).size();
    if (action.what < count) send_in_time(action.who, count - 1 - action.what);
  }
  steps_.push_back(told);
  is_over_ = is_over_ || !model_->act(state_, action, next);
  if (is_over_) return;
  for (std::size_t c = 0; c < chances_.size(); ++c) note(c, state_, next.state);
  state_ = next.state;
  if (!uses_register(action.kind)) return;
  // Now it stands there; where it was overtaken, the next one does.
  std::vector<Chance>& chances = chances_[action.who];
  chances.resize(said(state_, action.who).size());
  if (!chances.empty()) chances.front() = {true, false, 0};
  if (chances.size() > 1) chances.back() = {};
}

void Telling::note(std::size_t channel, const State& before, const State& after) {
  std::vector<Chance>& chances = chances_[channel];
  const std::size_t count = said(after, channel).size();
  const bool has_more = count > said(before, channel).size() ||
                        (count != 0 && said(after, channel).last() != said(before, channel).last());
  const bool is_over = has_more || (sender_is_up(before, channel) && !sender_is_up(after, channel));
  if (is_over && !chances.empty() && !chances.back().is_over) {
    chances.back().is_over = true;
    chances.back().until = steps_.size() - 1;
  }
  if (count == 0)
    chances.clear();
  else if (has_more)
    chances.push_back({});
}

void Telling::send_in_time(std::size_t channel, std::size_t at) {
  const Chance& chance = chances_[channel][at];
  if (!chance.stands) sendings_.push_back({chance.is_over ? chance.until : steps_.size(), channel});
}

std::vector<Action> Telling::actions() const {
  std::vector<Action> all;
  for (std::size_t step = 0; step <= steps_.size(); ++step) {
    for (const Sending& each : sendings_)
      if (each.before == step) all.push_back({ActionKind::send, static_cast<std::uint8_t>(each.channel), 0});
    if (step < steps_.size()) all.push_back(steps_[step]);
  }
  return all;
}

}  // namespace takt::explore
