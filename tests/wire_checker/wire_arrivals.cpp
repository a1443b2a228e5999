// SPDX-License-Identifier: Apache-2.0
// What becomes of the frames that come to a node: each must go on, be delivered or be dropped for a reason, and nothing
// may come from nowhere.
#include "tests/wire_checker/wire_checker_parts.hpp"

namespace takt::wire_checker {

using models::DropReason;
using models::Occurrence;

namespace {

bool is_policing(DropReason reason) {
  return reason == DropReason::stream_max_sdu || reason == DropReason::stream_gate ||
         reason == DropReason::flow_meter || reason == DropReason::residence_time;
}

bool is_same(const models::Frame& frame, models::StreamIndex stream, std::uint64_t sequence) {
  return frame.stream == stream && frame.sequence == sequence;
}

}  // namespace

/// Which record is whose: of a frame that waited at a port, of one that a node has just taken from a link (or made), of
/// one that a link has lost. Then settles the nodes, which says from when on a frame may be sent.
void WireChecker::attribute(Ps now, std::vector<Recorded>& batch) {
  std::set<std::uint32_t> nodes;
  while (!wakes_.empty() && wakes_.begin()->first <= now) {
    nodes.insert(wakes_.begin()->second);
    wakes_.erase(wakes_.begin());
  }
  std::map<std::uint32_t, std::uint64_t> dequeued;  // by direction: the frame that left its queue last
  for (std::size_t i = 0; i < batch.size(); ++i) {
    Recorded& recorded = batch[i];
    const sim::TraceRecord& record = recorded.record;
    const auto occurrence = static_cast<Occurrence>(record.kind);
    if (occurrence == Occurrence::produced) {
      ++accounts_[recorded.frame.stream.value].produced;
      continue;
    }
    const Place place = record.where.index < places_.size() ? places_[record.where.index] : Place{};
    const bool drops = occurrence == Occurrence::drop;
    Node::Outcome outcome{recorded.frame.stream, recorded.frame.sequence, place.direction, {}, i};
    if (drops) outcome.drop = static_cast<DropReason>(record.detail);
    if (place.node != 0xFFFF'FFFF && drops) {
      nodes_[place.node]->outcomes.push_back(outcome);
      nodes.insert(place.node);
      continue;
    }
    if (place.direction == 0xFFFF'FFFF) continue;
    Direction& direction = *directions_[place.direction];
    const models::FrameIndex handle{static_cast<std::uint32_t>(record.what)};
    if (occurrence == Occurrence::dequeued) dequeued[place.direction] = record.what;
    if (!drops && occurrence != Occurrence::started && occurrence != Occurrence::enqueued) continue;
    const auto left = dequeued.find(place.direction);
    recorded.is_of_queue = left != dequeued.end() && left->second == record.what;
    if (left != dequeued.end()) dequeued.erase(left);
    if (drops && !recorded.is_of_queue && direction.checker.has_rest_of(handle))
      recorded.is_of_queue = !direction.checker.is_up();
    if (recorded.is_of_queue) {
      // Its eligibility time stood with the record that put it into the queue.
      continue;
    }
    if (drops && (*outcome.drop == DropReason::link_loss || *outcome.drop == DropReason::link_down)) {
      std::vector<Arrival>& coming = nodes_[direction.to]->arrivals;
      const auto lost = std::find_if(coming.begin(), coming.end(), [&](const Arrival& arrival) {
        return arrival.direction == place.direction && arrival.handle == handle &&
               (arrival.looked_at == now || arrival.complete == now) && !arrival.lost;
      });
      if (lost != coming.end()) {
        lost->lost = lost->has_outcome = true;
        nodes.insert(direction.to);
        continue;
      }
    }
    nodes_[direction.from]->outcomes.push_back(outcome);
    nodes.insert(direction.from);
  }
  for (const std::uint32_t node : nodes) {
    if (nodes_[node]->forwards) finish_bridge_instant(node, now);
    if (nodes_[node]->is_end_station) finish_host_instant(node, now);
    for (const Node::Outcome& outcome : nodes_[node]->outcomes) {
      Recorded& recorded = batch[outcome.recorded];
      if (!nodes_[node]->ingress || is_own(node, outcome.stream, outcome.direction)) {  // a launch time
        if (recorded.frame.marked) recorded.eligible = recorded.frame.eligible.ps();
        continue;
      }
      const auto may_be = [&](const Arrival& arrival) {
        return is_same(arrival.frame, outcome.stream, outcome.sequence) && arrival.acts_at(now) &&
               !arrival.verdicts.empty();
      };
      const bool is_one_of_many =
          std::ranges::count_if(nodes_[node]->arrivals, may_be) > 1 && nodes_[node]->greatest_jitter > 0;
      for (Arrival& arrival : nodes_[node]->arrivals) {
        if (!may_be(arrival)) continue;
        const IngressOracle::Verdict& verdict = arrival.verdicts.front();
        if (arrival.verdicts.size() > 1 || is_one_of_many) {  // copies that can't be told apart
          recorded.eligible = recorded.frame.marked ? recorded.frame.eligible.ps() : long_ago;
          break;
        }
        recorded.eligible = verdict.eligible.value_or(long_ago);
        if (outcome.drop) break;
        const models::Priority expected = verdict.ipv.value_or(recorded.frame.priority);
        if (recorded.frame.queue_priority != expected)
          violations_.add(now, nodes_[node]->name,
                          wire_checker::name_of(outcome.stream, outcome.sequence) + " is queued by priority " +
                              std::to_string(recorded.frame.queue_priority) + " instead of " +
                              std::to_string(expected));
        if (verdict.eligible && recorded.frame.eligible.ps() != *verdict.eligible)
          violations_.add(now, nodes_[node]->name,
                          wire_checker::name_of(outcome.stream, outcome.sequence) + " is eligible at " +
                              std::to_string(recorded.frame.eligible.ps()) + " ps instead of " +
                              std::to_string(*verdict.eligible));
        break;
      }
    }
    nodes_[node]->outcomes.clear();
    forget_arrivals(node, now);
  }
}

/// A frame that the node has made itself leaves it.
bool WireChecker::is_own(std::uint32_t node, models::StreamIndex stream, std::uint32_t direction) const {
  return nodes_[node]->is_end_station && direction != 0xFFFF'FFFF && plan_.streams[stream.value].talker.value == node;
}

/// Whether the frame is for the host: in a station only what it listens to.
bool WireChecker::is_taken_in(std::uint32_t node, const Arrival& arrival) const {
  const std::vector<models::NodeIndex>& listeners = plan_.streams[arrival.frame.stream.value].listeners;
  return !nodes_[node]->forwards ||
         std::find(listeners.begin(), listeners.end(), models::NodeIndex{node}) != listeners.end();
}

void WireChecker::finish_host_instant(std::uint32_t index, Ps now) {
  Node& node = *nodes_[index];
  for (Arrival& arrival : node.arrivals) {
    if (arrival.complete != now || !is_taken_in(index, arrival)) continue;
    arrival.has_outcome = true;
    if (arrival.lost || arrival.was_dropped) continue;
    const auto dropped = std::find_if(node.outcomes.begin(), node.outcomes.end(), [&](const Node::Outcome& outcome) {
      return outcome.drop && outcome.direction == 0xFFFF'FFFF &&
             is_same(arrival.frame, outcome.stream, outcome.sequence);
    });
    // Where a link doubles frames, the one that is delivered can't be told from the one that is dropped.
    if (dropped != node.outcomes.end()) {
      node.outcomes.erase(dropped);
      continue;
    }
    ++accounts_[arrival.frame.stream.value].delivered;
    const auto recovery = node.recoveries.find(arrival.frame.stream.value);
    if (recovery != node.recoveries.end()) check_at_most_once(*recovery->second, index, arrival.frame, now);
    check_order(arrival, now);
  }
  for (const Node::Outcome& outcome : node.outcomes) {
    if (outcome.direction == 0xFFFF'FFFF) continue;  // of a frame that waited for the operating system
    if (node.forwards && !is_own(index, outcome.stream, outcome.direction)) continue;
    if (outcome.sequence >= accounts_[outcome.stream.value].produced)
      violations_.add(
          now, node.name,
          wire_checker::name_of(outcome.stream, outcome.sequence) + " leaves a host that has not produced it");
    if (plan_.streams[outcome.stream.value].talker.value != index)
      violations_.add(
          now, node.name,
          wire_checker::name_of(outcome.stream, outcome.sequence) + " leaves a host that is not its talker");
  }
}

void WireChecker::finish_bridge_instant(std::uint32_t index, Ps now) {
  Node& node = *nodes_[index];
  for (const Node::Outcome& outcome : node.outcomes) {
    if (is_own(index, outcome.stream, outcome.direction)) continue;
    bool found = node.is_end_station &&
                 outcome.drop == DropReason::node_down;  // of a frame that waited for the operating system
    for (Arrival& arrival : node.arrivals) {
      if (!is_same(arrival.frame, outcome.stream, outcome.sequence) || !arrival.acts_at(now) || arrival.lost) continue;
      found = arrival.has_outcome = true;
      if (outcome.drop && outcome.direction == 0xFFFF'FFFF && arrival.complete != now) arrival.was_dropped = true;
      if (arrival.complete != now && arrival.greatest_jitter == 0 && !outcome.drop && arrival.frame.length != 0 &&
          directions_[outcome.direction]->checker.octet_time() != directions_[arrival.direction]->checker.octet_time())
        violations_.add(
            now, node.name,
            wire_checker::name_of(outcome.stream, outcome.sequence) + " is cut through to a link of another rate");
      if (!outcome.drop && arrival.complete == now) check_why_stored(index, arrival, outcome.direction, now);
    }
    if (!found)
      violations_.add(now, node.name, wire_checker::name_of(outcome.stream, outcome.sequence) + " comes from nowhere");
  }
  if (node.greatest_jitter > 0) check_nobody_overtakes(index, now);
  std::vector<Arrival*> arrived;
  for (Arrival& arrival : node.arrivals)
    if (arrival.looked_at == now && !arrival.lost) arrived.push_back(&arrival);
  if (node.ingress) run_ingress(index, now, arrived);
}

/// A frame that goes on when it has come wholly, although nothing kept it from being cut through.
void WireChecker::check_why_stored(std::uint32_t index, const Arrival& arrival, std::uint32_t direction, Ps now) {
  if (std::ranges::find(arrival.missed, direction) == arrival.missed.end()) return;
  // Which of several copies goes on can't be told.
  const auto is_copy = [&](const Arrival& other) {
    return is_same(other.frame, arrival.frame.stream, arrival.frame.sequence);
  };
  if (std::ranges::count_if(nodes_[index]->arrivals, is_copy) > 1) return;
  violations_.add(now, nodes_[index]->name,
                  wire_checker::name_of(arrival.frame.stream, arrival.frame.sequence) +
                      " is stored although it could be cut through");
}

/// What comes in by one port goes on in that order, whatever the jitter.
void WireChecker::check_nobody_overtakes(std::uint32_t index, Ps now) {
  Node& node = *nodes_[index];
  for (const Arrival& arrival : node.arrivals) {
    const bool goes_on = std::any_of(node.outcomes.begin(), node.outcomes.end(), [&](const Node::Outcome& outcome) {
      return !outcome.drop && is_same(arrival.frame, outcome.stream, outcome.sequence);
    });
    // Which of several copies goes on can't be told.
    const auto copies = std::count_if(node.arrivals.begin(), node.arrivals.end(), [&](const Arrival& other) {
      return is_same(other.frame, arrival.frame.stream, arrival.frame.sequence);
    });
    if (!goes_on || !arrival.acts_at(now) || arrival.lost || copies > 1) continue;
    for (const Arrival& before : node.arrivals)
      if (before.direction == arrival.direction && before.complete < arrival.complete && !before.has_outcome &&
          !before.lost && !is_same(before.frame, arrival.frame.stream, arrival.frame.sequence))
        violations_.add(now, node.name,
                        wire_checker::name_of(arrival.frame.stream, arrival.frame.sequence) + " overtakes " +
                            wire_checker::name_of(before.frame.stream, before.frame.sequence));
  }
}

/// The frames of an instant pass the functions of the bridge by the number of the port through which they come.
void WireChecker::run_ingress(std::uint32_t index, Ps now, std::vector<Arrival*>& arrived) {
  Node& node = *nodes_[index];
  std::stable_sort(arrived.begin(), arrived.end(),
                   [](const Arrival* a, const Arrival* b) { return a->port < b->port; });
  std::set<std::pair<std::uint32_t, std::uint64_t>> done;
  struct Group {
    std::vector<Arrival*> arrivals;
    std::size_t entered = 0;  // frames, with those that a link has doubled
    std::size_t copies = 0;   // taken out as copies
    std::size_t passed = 0;
    std::map<DropReason, std::size_t> drops;
  };
  std::map<std::pair<std::uint32_t, std::uint64_t>, Group> groups;
  std::vector<Group*> order;
  for (Arrival* const arrival : arrived) {
    Group& group = groups[{arrival->frame.stream.value, arrival->frame.sequence}];
    group.arrivals.push_back(arrival);
    order.push_back(&group);
  }
  for (auto& [key, group] : groups) {
    std::map<std::uint32_t, std::size_t> at_port;
    std::size_t dropped = 0, damaged = 0, most = 0;
    bool doubled = false;
    for (const Node::Outcome& outcome : node.outcomes) {
      if (outcome.stream.value != key.first || outcome.sequence != key.second) continue;
      if (outcome.direction != 0xFFFF'FFFF) {
        most = std::max(most, ++at_port[outcome.direction]);
        continue;
      }
      if (*outcome.drop == DropReason::bad_fcs) {
        ++damaged;
        continue;
      }
      ++dropped;
      if (*outcome.drop == DropReason::duplicate) ++group.copies;
      if (is_policing(*outcome.drop)) ++group.drops[*outcome.drop];
    }
    for (const Arrival* const arrival : group.arrivals) doubled |= directions_[arrival->direction]->duplicates;
    group.entered = group.arrivals.size() - std::min(damaged, group.arrivals.size());
    if (doubled) group.entered = std::max(group.entered, dropped + most);
  }
  for (Group* const group : order) {
    Arrival& arrival = *group->arrivals[std::min(group->passed, group->arrivals.size() - 1)];
    const std::size_t times =
        group->passed == 0 ? 1 + group->entered - std::min(group->entered, group->arrivals.size()) : 1;
    for (std::size_t i = 0; i < times && group->passed < group->entered; ++i) {
      ++group->passed;
      const models::StreamRecoveryConfig* const recovery = node.ingress->recovery_of(arrival.frame);
      if (recovery != nullptr && group->passed > group->entered - std::min(group->copies, group->entered)) continue;
      if (recovery != nullptr) check_at_most_once(*recovery, index, arrival.frame, now);
      IngressOracle::Verdict verdict = node.ingress->pass(arrival.frame, arrival.port, now - node.fixed_delay);
      // A frame may be selected no earlier than the forwarding delay after its eligibility time.
      if (verdict.eligible) *verdict.eligible += node.fixed_delay;
      arrival.verdicts.push_back(verdict);
      if (!verdict.drop) continue;
      if (group->drops[*verdict.drop]-- == 0)
        violations_.add(now, node.name,
                        wire_checker::name_of(arrival.frame.stream, arrival.frame.sequence) + " is not dropped for " +
                            name_of(*verdict.drop));
    }
  }
  for (const auto& [key, group] : groups)
    for (const auto& [reason, count] : group.drops)
      if (count != 0 && count < std::size_t{1} << 32)
        violations_.add(now, node.name,
                        wire_checker::name_of(models::StreamIndex{key.first}, key.second) + " is dropped for " +
                            name_of(reason) + ", which the configuration does not ask for");
}

void WireChecker::check_at_most_once(const models::StreamRecoveryConfig& recovery, std::uint32_t index,
                                     const models::Frame& frame, Ps now) {
  if (recovery.recovery.algorithm != models::RecoveryAlgorithm::vector || !frame.r_tagged) return;
  Node::Recovered& recovered = nodes_[index]->recovered[frame.stream.value];
  const bool was_reset = recovered.last != long_ago && now - recovered.last >= recovery.reset_timeout.ps();
  if (was_reset) recovered.passed.clear();
  if (!recovered.passed.insert({frame.r_tag_sequence, frame.sequence}).second)
    violations_.add(
        now, nodes_[index]->name,
        wire_checker::name_of(frame.stream, frame.sequence) + " passes the sequence recovery a second time");
  recovered.last = now;
}

/// A stream that has one path and one class all the way arrives in order.
bool WireChecker::order_is_kept(models::StreamIndex stream) const {
  if (routes_change_ || duplicates_) return false;
  for (const models::HostSplitPlan& split : plan_.host_splits)
    if (split.stream == stream) return false;
  for (const models::IngressConfig& config : plan_.ingress_configs) {
    if (!config.splits.empty() || !config.stream_gates.empty()) return false;
  }
  // A babbling talker neither waits for the launch times nor for the same operating system as the stream's own.
  std::size_t talkers = 0;
  bool launches = false;
  for (const models::TalkerPlan& talker : plan_.talkers) {
    if (talker.stream != stream) continue;
    ++talkers;
    launches = launches || talker.launch.has_value();
  }
  return talkers <= 1 || (plan_.os_latencies.size() == 1 && !launches);
}

void WireChecker::check_order(const Arrival& arrival, Ps now) {
  if (!order_is_kept(arrival.frame.stream)) return;
  std::uint64_t& next = nodes_[directions_[arrival.direction]->to]->next_sequence[arrival.frame.stream.value];
  if (arrival.frame.sequence < next)
    violations_.add(now, nodes_[directions_[arrival.direction]->to]->name,
                    wire_checker::name_of(arrival.frame.stream, arrival.frame.sequence) + " arrives after a later one");
  next = std::max(next, arrival.frame.sequence + 1);
}

void WireChecker::forget_arrivals(std::uint32_t index, Ps now) {
  Node& node = *nodes_[index];
  std::erase_if(node.arrivals, [&](const Arrival& arrival) {
    if (arrival.latest() > now) return false;
    if (!arrival.has_outcome)
      violations_.add(now, node.name,
                      wire_checker::name_of(arrival.frame.stream, arrival.frame.sequence) +
                          " has arrived and neither goes on nor is dropped");
    return true;
  });
}

}  // namespace takt::wire_checker
