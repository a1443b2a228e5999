#include "explore/ghost.hpp"

#include <algorithm>

#include "explore/hash_index.hpp"
#include "sim/check.hpp"

namespace takt::explore {

using handshake::PublishedState;
using handshake::StateChange;

namespace {

bool begins_round(const StateChange& change) {
  return change.to == PublishedState::HaltedInit || (change.to == PublishedState::Ready && change.from != PublishedState::HaltedInit);
}
std::uint8_t with(std::uint8_t set, std::size_t participant) { return static_cast<std::uint8_t>(set | 1U << participant); }
std::uint8_t without(std::uint8_t set, std::size_t participant) { return static_cast<std::uint8_t>(set & ~(1U << participant)); }

}  // namespace

bool Effect::begins_round() const {
  return std::any_of(change.begin(), change.begin() + change_count, [](const StateChange& each) { return explore::begins_round(each); });
}

Ghost::Ghost(handshake::Variant variant, std::size_t participants)
    : paper_(variant == handshake::Variant::Paper ? 1 : 0), participants_(static_cast<std::uint8_t>(participants)) {
  TAKT_CHECK(participants >= 2 && participants <= most_slaves + 1, "a group to explore is small");
  if (!is_paper()) return;
  for (std::uint32_t i = 0; i < participants; ++i) facts_.of(i);
  asked_ = static_cast<std::uint8_t>(1U << handshake::index_of(PublishedState::Halted));
}

PropertySet Ghost::on_effect(std::size_t participant, const Effect& effect) {
  PropertySet violated;
  for (std::size_t i = 0; i < effect.change_count; ++i) {
    const StateChange& change = effect.change[i];
    if (is_paper()) ready_now_ = change.to == PublishedState::Ready ? with(ready_now_, participant) : without(ready_now_, participant);
    if (change.to == PublishedState::Halted) passed_init_ = without(passed_init_, participant);
    if (change.to == PublishedState::HaltedInit) passed_init_ = with(passed_init_, participant);
    if (is_paper() && explore::begins_round(change)) begin_round(participant);
    if (change.to == PublishedState::Ready) became_ready(participant, effect.run);
    if (change.to == PublishedState::Running) violated.bits |= became_running(participant, effect.run).bits;
  }
  if (effect.joins && !is_paper()) became_ready(participant, effect.run);
  if (effect.raised && is_paper()) asked_ = static_cast<std::uint8_t>(asked_ | 1U << handshake::index_of(handshake::goal_of(effect.kind)));
  return violated;
}

void Ghost::on_restart(std::size_t participant) {
  passed_init_ = without(passed_init_, participant);
  ready_now_ = without(ready_now_, participant);
  if (is_paper()) asked_ = static_cast<std::uint8_t>(asked_ | 1U << handshake::index_of(PublishedState::Halted));
}

void Ghost::begin_round(std::size_t participant) {
  facts_[participant].ready = ready_now_;
  facts_[participant].running = 0;
}

void Ghost::became_ready(std::size_t participant, std::uint32_t run) {
  if (is_paper()) {
    for (Facts& facts : facts_) facts.ready = with(facts.ready, participant);
  } else {
    Facts& facts = facts_.of(run);
    facts.ready = with(facts.ready, participant);
  }
}

PropertySet Ghost::became_running(std::size_t participant, std::uint32_t run) {
  if (is_paper()) {
    for (Facts& facts : facts_) facts.running = with(facts.running, participant);
  } else {
    Facts& facts = facts_.of(run);
    facts.running = with(facts.running, participant);
  }
  const Facts& facts = facts_.of(is_paper() ? static_cast<std::uint32_t>(participant) : run);
  PropertySet violated;
  if (facts.ready != everybody()) violated.insert(Property::S1);
  if (participant == 0 && facts.running != everybody()) violated.insert(Property::S2);
  if (((passed_init_ >> participant) & 1U) == 0) violated.insert(Property::S4);
  return violated;
}

Ghost Ghost::renamed(const Renaming& renaming) const {
  Ghost result = *this;
  result.passed_init_ = renamed_set(passed_init_, renaming);
  result.ready_now_ = renamed_set(ready_now_, renaming);
  for (std::size_t i = 0; i < facts_.size(); ++i) {
    Facts& facts = result.facts_[is_paper() ? renaming.to[i] : i];
    facts = facts_[i];
    if (is_paper()) facts.run = renaming.to[i];
    facts.ready = renamed_set(facts_[i].ready, renaming);
    facts.running = renamed_set(facts_[i].running, renaming);
  }
  return result;
}

std::uint64_t Ghost::hash() const {
  std::uint64_t digest = static_cast<std::uint64_t>(facts_.size()) | std::uint64_t{passed_init_} << 8 | std::uint64_t{ready_now_} << 16 |
                         std::uint64_t{asked_} << 24;
  for (const Facts& each : facts_) digest = mixed(digest) ^ (each.run | std::uint64_t{each.ready} << 32 | std::uint64_t{each.running} << 40);
  return mixed(digest);
}

}  // namespace takt::explore
