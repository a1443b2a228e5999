// SPDX-License-Identifier: Apache-2.0
// The breadth-first search of any Model, as a template; included only where one is searched (group_search.cpp,
// tree_search.cpp, roles_search.cpp).
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "explore/model/model.hpp"
#include "explore/properties/liveness.hpp"
#include "explore/report/chart.hpp"
#include "explore/search/search.hpp"
#include "explore/search/trace_builder.hpp"
#include "sim/check.hpp"

namespace takt::explore {

template <Model M>
class Search {
 public:
  Search(const Query& query, const Watcher& watcher)
      : watcher_(watcher), model_(query), store_(model_.shape(), query.states) {}

  /// False if the result would depend on the names of slaves: try again without symmetry.
  bool run(SearchResult& result) {
    begin();
    while (expanded_ < store_.size() && !ended_) step();
    result_.exhausted = !ended_ && !cut_;
    if (result_.exhausted && loops_back_ && !judge()) return false;
    if (!model_.symmetric() || !trace_all()) return false;
    finish();
    result = std::move(result_);
    return true;
  }

 private:
  using Position = StateStore::Position;

  /// Where something was seen first: in the state itself, or on the way out of it.
  struct Sighting {
    Position state = StateStore::nowhere;
    bool on_the_way_out = false;
    std::optional<FairCycle> cycle;
  };
  struct Candidate {
    State state;
    std::uint64_t hash = 0;
    Position parent = 0;
    bool network = false;
  };

  void begin() {
    for (const Beginning& beginning : model_.beginnings()) {
      const State state = model_.canonical(beginning.state);
      store_.insert(state, state.hash(), StateStore::nowhere);
    }
    level_end_ = store_.size();
  }

  /// In actions of a group on its network: some models leave out what follows from the others.
  template <class Run>
  Run told(const Run& run) {
    if constexpr (requires { model_.told(run); })
      return model_.told(run);
    else
      return run;
  }

  /// Expands some states of one level, then inserts what was found; meanwhile memory has time to arrive.
  void step() {
    constexpr std::size_t enough = 192;
    candidates_.clear();
    if (expanded_ == level_end_) {
      ++depth_;
      level_end_ = store_.size();
    }
    if (depth_ >= model_.query().depth) {
      cut_ = true;
      ended_ = true;
      return;
    }
    while (expanded_ < level_end_ && candidates_.size() < enough) expand(static_cast<Position>(expanded_++));
    for (const Candidate& each : candidates_) store_.prefetch_state(each.hash);
    for (const Candidate& each : candidates_) insert(each);
    if (store_.is_full() && overflowed_) {
      cut_ = true;
      ended_ = true;
    }
    if (!model_.symmetric()) ended_ = true;
    if (expanded_ - watched_ >= 0x8000) {
      watched_ = expanded_;
      if (!watcher_({store_.size(), expanded_, depth_, store_.memory(), false})) {
        ended_ = true;
        result_.interrupted = true;
      }
    }
  }

  void expand(Position position) {
    const State state = store_[position];
    bool quiescent = true;
    const std::span<const Action> network = model_.network_actions();
    for (const Action& action : network)
      if (take(state, position, action, true)) quiescent = false;
    if (quiescent) {
      ++result_.quiescent;
      if (!model_.settled(state)) see(model_.anybody_down(state) ? Property::F1 : Property::L1, position, false);
    }
    for (const Action& action : model_.calls(state)) take(state, position, action, false);
    for (const Action& action : model_.faults(state)) take(state, position, action, false);
  }

  bool take(const State& state, Position position, Action action, bool network) {
    if (!act(state, position, action)) return false;
    ++result_.transitions;
    if ((next_.properties.bits & ~seen_.bits) != 0) {
      for (std::size_t p = 0; p < property_count; ++p)
        if (next_.properties.contains(static_cast<Property>(p))) see(static_cast<Property>(p), position, true);
    }
    Candidate& candidate = candidates_.emplace_back();
    candidate.state = model_.canonical(next_.state);
    candidate.hash = candidate.state.hash();
    candidate.parent = position;
    candidate.network = network;
    store_.prefetch_slot(candidate.hash);
    return !(next_.state == state);
  }

  /// A broken CHECK of the handshake is told with the run that leads to it.
  bool act(const State& state, Position position, Action action) {
    try {
      return model_.act(state, action, next_);
    } catch (const sim::InvariantBroken& broken) {
      std::optional<Trace> trace = TraceBuilder<M>(model_, store_).to(position);
      if (!trace) throw;
      trace->actions.push_back(action);
      throw sim::InvariantBroken(std::string(broken.what()) + "\n\n" +
                                 chart(model_.query(), told(model_.beginnings()[trace->beginning]), told(*trace)));
    }
  }

  void insert(const Candidate& candidate) {
    const StateStore::Inserted inserted = store_.insert(candidate.state, candidate.hash, candidate.parent);
    if (inserted.position == StateStore::nowhere) {
      overflowed_ = true;
      return;
    }
    if (candidate.network && inserted.position <= candidate.parent) loops_back_ = true;
    if (candidate.network && inserted.position == candidate.parent && model_.with_symmetry() &&
        !model_.settled(candidate.state))
      turns_ = true;
    if (inserted.is_new && !seen_.contains(Property::all_running) && model_.all_running(candidate.state))
      see(Property::all_running, inserted.position, false);
  }

  void see(Property property, Position position, bool on_the_way_out) {
    if (seen_.contains(property)) return;
    seen_.insert(property);
    sightings_[index_of(property)] = {position, on_the_way_out, std::nullopt};
  }

  /// Cycles of network steps. With symmetry a cycle may come back under other names, so a suspicious one is judged
  /// without.
  bool judge() {
    const Liveness liveness = judge_cycles(model_, store_, watcher_);
    result_.interrupted = liveness.interrupted;
    judged_ = !liveness.interrupted;
    result_.cyclic_states = liveness.cyclic_states;
    if (model_.with_symmetry() && (liveness.unsettled || liveness.unhalted || turns_)) return false;
    livelock_ = liveness.unsettled;
    see_cycle(Property::L1, liveness.unsettled);
    see_cycle(Property::F1, liveness.unhalted);
    return true;
  }
  void see_cycle(Property property, const std::optional<FairCycle>& cycle) {
    if (!cycle || seen_.contains(property)) return;
    see(property, cycle->state, false);
    sightings_[index_of(property)].cycle = cycle;
  }

  bool trace_all() {
    TraceBuilder<M> builder(model_, store_);
    for (std::size_t p = 0; p < property_count; ++p) {
      const Sighting& sighting = sightings_[p];
      if (sighting.state == StateStore::nowhere) continue;
      std::optional<Trace> trace = sighting.cycle ? builder.around(once_around(model_, store_, *sighting.cycle))
                                   : sighting.on_the_way_out ? builder.to(sighting.state, static_cast<Property>(p))
                                                             : builder.to(sighting.state);
      if (!trace && model_.with_symmetry()) return false;
      result_.traces[p] = std::move(trace);
    }
    if (livelock_) result_.livelock = builder.around(once_around(model_, store_, *livelock_));
    return true;
  }

  void finish() {
    result_.states = store_.size();
    result_.depth = depth_;
    result_.symmetry = model_.with_symmetry();
    for (const Beginning& each : model_.beginnings()) result_.beginnings.push_back(told(each));
    for (std::optional<Trace>& each : result_.traces)
      if (each) each = told(*each);
    if (result_.livelock) result_.livelock = told(*result_.livelock);
    result_.octets = store_.memory();
    result_.participants = model_.value_count();
    result_.words = model_.word_count();
    for (std::size_t p = 0; p < property_count; ++p) {
      const auto property = static_cast<Property>(p);
      PropertyVerdict& verdict = result_.verdicts[p];
      if ((is_of_silence(property) && !model_.query().asks_for_silence()) ||
          (is_of_roles(property) && !model_.query().has_roles()) ||
          (is_of_replays(property) && !model_.query().has_recordings())) {
        verdict = PropertyVerdict::not_asked;
        continue;
      }
      if (must_always_hold(property)) {
        verdict = seen_.contains(property) ? PropertyVerdict::violated : PropertyVerdict::holds;
        const bool is_liveness = property == Property::L1 || property == Property::F1;
        const bool decided = result_.exhausted && (judged_ || !loops_back_);
        if (is_liveness && verdict == PropertyVerdict::holds && !decided) verdict = PropertyVerdict::unknown;
      } else {
        verdict = seen_.contains(property) ? PropertyVerdict::reached : PropertyVerdict::unreached;
      }
    }
  }

  const Watcher& watcher_;
  M model_;
  StateStore store_;
  SearchResult result_;
  Next next_;
  std::vector<Candidate> candidates_;
  std::array<Sighting, property_count> sightings_;
  PropertySet seen_;
  std::optional<FairCycle> livelock_;
  std::size_t expanded_ = 0;
  std::size_t level_end_ = 0;
  std::size_t watched_ = 0;
  std::uint32_t depth_ = 0;
  bool loops_back_ = false;  ///< some network step leads to an earlier state, so there may be cycles
  bool turns_ = false;       ///< an unsettled state follows itself under other names
  bool judged_ = false;
  bool overflowed_ = false;
  bool cut_ = false;
  bool ended_ = false;
};

template <class M>
SearchResult search(const Query& query, const Watcher& watcher) {
  static_assert(Model<M>);
  SearchResult result;
  if (Search<M>(query, watcher).run(result)) return result;
  Query plain = query;
  plain.symmetry = false;
  if (Search<M>(plain, watcher).run(result)) return result;
  result.verdicts.fill(
      PropertyVerdict::unknown);  // a model of slaves without names, whose slaves turned out not to be equal
  return result;
}

}  // namespace takt::explore
