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
  count_ = participants_;
  for (std::uint32_t i = 0; i < participants; ++i) facts_[i].run = i;
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
    for (std::size_t i = 0; i < count_; ++i) facts_[i].ready = with(facts_[i].ready, participant);
  } else {
    Facts& facts = facts_of(run);
    facts.ready = with(facts.ready, participant);
  }
}

PropertySet Ghost::became_running(std::size_t participant, std::uint32_t run) {
  if (is_paper()) {
    for (std::size_t i = 0; i < count_; ++i) facts_[i].running = with(facts_[i].running, participant);
  } else {
    Facts& facts = facts_of(run);
    facts.running = with(facts.running, participant);
  }
  const Facts& facts = facts_of(is_paper() ? static_cast<std::uint32_t>(participant) : run);
  PropertySet violated;
  if (facts.ready != everybody()) violated.insert(Property::S1);
  if (participant == 0 && facts.running != everybody()) violated.insert(Property::S2);
  if (((passed_init_ >> participant) & 1U) == 0) violated.insert(Property::S4);
  return violated;
}

auto Ghost::facts_of(std::uint32_t run) -> Facts& {
  std::size_t at = 0;
  while (at < count_ && facts_[at].run < run) ++at;
  if (at < count_ && facts_[at].run == run) return facts_[at];
  TAKT_CHECK(!is_paper() && count_ < most_runs, "the runs of an exploration are few: a start costs a call");
  for (std::size_t i = count_; i > at; --i) facts_[i] = facts_[i - 1];
  ++count_;
  facts_[at] = Facts{run, 0, 0};
  return facts_[at];
}

Ghost Ghost::renamed(const Renaming& renaming) const {
  Ghost result = *this;
  result.passed_init_ = renamed_set(passed_init_, renaming);
  result.ready_now_ = renamed_set(ready_now_, renaming);
  for (std::size_t i = 0; i < count_; ++i) {
    Facts& facts = result.facts_[is_paper() ? renaming.to[i] : i];
    facts = facts_[i];
    if (is_paper()) facts.run = renaming.to[i];
    facts.ready = renamed_set(facts_[i].ready, renaming);
    facts.running = renamed_set(facts_[i].running, renaming);
  }
  return result;
}

std::uint64_t Ghost::hash() const {
  std::uint64_t digest = static_cast<std::uint64_t>(count_) | std::uint64_t{passed_init_} << 8 | std::uint64_t{ready_now_} << 16 |
                         std::uint64_t{asked_} << 24;
  for (std::size_t i = 0; i < count_; ++i)
    digest = mixed(digest) ^ (facts_[i].run | std::uint64_t{facts_[i].ready} << 32 | std::uint64_t{facts_[i].running} << 40);
  return mixed(digest);
}

}  // namespace takt::explore
