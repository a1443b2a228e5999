// SPDX-License-Identifier: Apache-2.0
#include "explore/properties/small_observer.hpp"

#include <algorithm>

namespace takt::explore {

using handshake::Finding;
using handshake::GroupTree;
using handshake::Invariant;
using handshake::PublishedState;
using handshake::StateChange;

bool Effect::begins_round() const {
  return std::any_of(changes().begin(), changes().end(),
                     [](const StateChange& each) { return handshake::RunHistory<SmallStorage>::begins_round(each); });
}

SmallObserver::SmallObserver(handshake::Variant variant, const GroupTree& tree)
    : is_paper_(variant == handshake::Variant::paper), history_(variant, tree) {
  if (is_paper_) ask(PublishedState::Halted);
}

PropertySet SmallObserver::on_effect(const GroupTree& tree, std::size_t participant, const Effect& effect) {
  PropertySet violated;
  const auto found = [&](Invariant invariant, Finding, bool) { violated.insert(static_cast<Property>(invariant)); };
  if (effect.started_run != 0) history_.on_started(tree, participant, effect.started_run, effect.outer_run);
  for (const StateChange& change : effect.changes())
    history_.on_transition(tree, participant, change, effect.run, found);
  if (effect.joins && !is_paper_) history_.on_ready(tree, participant, effect.run, found);
  if (effect.raised && is_paper_) ask(handshake::goal_of(effect.kind));
  return violated;
}

void SmallObserver::on_restart(std::size_t participant) {
  history_.on_restart(participant);
  if (is_paper_) ask(PublishedState::Halted);
}

SmallObserver SmallObserver::renamed(const Renaming& renaming) const {
  SmallObserver result = *this;
  result.history_ = history_.renamed([&](std::size_t i) { return std::size_t{renaming.to[i]}; });
  return result;
}

std::uint64_t SmallObserver::hash() const {
  std::uint64_t digest = asked_;
  history_.hash_into([&digest](std::uint64_t value) { digest = mixed(digest ^ value); });
  return digest;
}

}  // namespace takt::explore
