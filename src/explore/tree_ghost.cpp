#include "explore/tree_ghost.hpp"

#include "explore/hash_index.hpp"
#include "sim/check.hpp"

namespace takt::explore {

using handshake::PublishedState;
using handshake::StateChange;

namespace {

std::uint16_t bit(std::size_t participant) { return static_cast<std::uint16_t>(1U << participant); }

/// All members of a group but the first `without`.
std::uint16_t members_of(const TreeShape& shape, std::size_t group, std::size_t without) {
  std::uint16_t set = 0;
  for (std::size_t i = without; i < shape.size(group); ++i) set = static_cast<std::uint16_t>(set | bit(shape.number_of(group, i)));
  return set;
}
bool contains_all(std::uint16_t set, std::uint16_t part) { return (set & part) == part; }

}  // namespace

TreeGhost::TreeGhost(const TreeShape& shape)
    : groups_{Ghost(handshake::Variant::Robust, shape.size(0)), Ghost(handshake::Variant::Robust, shape.groups() == 2 ? shape.size(1) : 2)} {}

PropertySet TreeGhost::on_effect(const TreeShape& shape, std::size_t participant, const TreeEffect& effect) {
  const std::size_t group = shape.group_of(participant);
  PropertySet violated = groups_[group].on_effect(shape.index_of(participant), effect.effect);
  if (shape.groups() == 1) return violated;
  if (effect.inner_run != 0) links_.of(effect.inner_run).outer = effect.outer_run;
  const auto is_ready_now = [&](const StateChange& change) { return change.to == PublishedState::Ready; };
  bool was_ready = effect.effect.joins;
  for (std::size_t i = 0; i < effect.effect.change_count; ++i) was_ready = was_ready || is_ready_now(effect.effect.change[i]);
  if (was_ready && !became_ready(shape, participant, effect.effect.run)) violated.insert(Property::S1);
  for (std::size_t i = 0; i < effect.effect.change_count; ++i)
    if (effect.effect.change[i].to == PublishedState::Running) violated.bits |= became_running(shape, participant, effect.effect.run).bits;
  return violated;
}

void TreeGhost::on_restart(const TreeShape& shape, std::size_t participant) { groups_[shape.group_of(participant)].on_restart(shape.index_of(participant)); }

/// False: a node before its inner group.
bool TreeGhost::became_ready(const TreeShape& shape, std::size_t participant, std::uint32_t run) {
  const std::uint32_t of_tree = tree_run(shape.group_of(participant), run);
  if (of_tree == 0) return true;  // in a run of its group alone; there Running is forbidden
  Facts& facts = facts_.of(of_tree);
  facts.ready = static_cast<std::uint16_t>(facts.ready | bit(participant));
  const bool is_node = shape.group_of(participant) == 0 && shape.is_nested(shape.node_of(participant));
  return !is_node || contains_all(facts.ready, members_of(shape, 1, 1));
}

PropertySet TreeGhost::became_running(const TreeShape& shape, std::size_t participant, std::uint32_t run) {
  PropertySet violated;
  const std::size_t group = shape.group_of(participant);
  const std::uint32_t of_tree = tree_run(group, run);
  if (of_tree == 0) {
    violated.insert(Property::S1);
    return violated;
  }
  Facts& facts = facts_.of(of_tree);
  facts.running = static_cast<std::uint16_t>(facts.running | bit(participant));
  // A node is Ready as the slave of the outer group; the inner master shows INIT while it waits for the outer barrier.
  const auto nodes = static_cast<std::uint16_t>(members_of(shape, 0, 0) | members_of(shape, 1, 1));
  if (!contains_all(facts.ready, nodes)) violated.insert(Property::S1);
  std::uint16_t below = 0;
  if (group == 0 && shape.index_of(participant) == 0) below = static_cast<std::uint16_t>(members_of(shape, 0, 1) | members_of(shape, 1, 0));
  if (group == 0 && shape.is_nested(shape.node_of(participant))) below = members_of(shape, 1, 0);
  if (group == 1 && shape.index_of(participant) == 0) below = members_of(shape, 1, 1);
  if (!contains_all(facts.running, below)) violated.insert(Property::S2);
  return violated;
}

/// 0 if it was started for none.
std::uint32_t TreeGhost::tree_run(std::size_t group, std::uint32_t run) const {
  if (group == 0) return run;
  for (const Link& each : links_)
    if (each.run == run) return each.outer;
  return 0;
}

std::uint64_t TreeGhost::hash() const {
  std::uint64_t digest = groups_[0].hash() * 31 + groups_[1].hash();
  for (const Link& each : links_) digest = mixed(digest ^ (std::uint64_t{each.run} << 32 | each.outer));
  for (const Facts& each : facts_) digest = mixed(mixed(digest ^ each.run) ^ (std::uint64_t{each.ready} | std::uint64_t{each.running} << 16));
  return mixed(digest);
}

}  // namespace takt::explore
