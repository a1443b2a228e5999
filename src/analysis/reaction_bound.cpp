#include "analysis/reaction_bound.hpp"

#include <algorithm>
#include <array>

#include "analysis/flow_graph.hpp"

namespace takt::analysis {
namespace {

using scenario::Reaction;
using sim::Duration;

/// By participant: what an inner group adds between hearing and being ready to answer.
std::vector<MaxPlus> with_inner(const ReactionGroup& group, std::vector<MaxPlus> own, MaxPlus (*of_inner)(const ReactionGroup&)) {
  for (const ReactionGroup::Inner& inner : group.inner) own[inner.slave] += of_inner(inner.group);
  return own;
}

/// The master tells the slaves, each does its part, and tells the master: up * diagonal(part) * down.
MaxPlus there_and_back(const ReactionGroup& group, const std::vector<MaxPlus>& part) {
  const std::size_t slaves = group.initialise.size() - 1;
  MaxPlusMatrix down(slaves, 1);
  MaxPlusMatrix up(1, slaves);
  MaxPlusMatrix acts(slaves, slaves);
  for (std::size_t s = 0; s < slaves; ++s) {
    down(s, 0) = group.notify(s + 1, 0);
    up(0, s) = group.notify(0, s + 1);
    acts(s, s) = part[s + 1];
  }
  return (up * acts * down)(0, 0);
}

/// All participants of a tree of groups as one matrix of notifications; an inner master is its outer slave.
void lay_out(const ReactionGroup& group, std::size_t master, std::vector<std::vector<std::pair<std::size_t, Ps>>>& heard_from, const auto& self) {
  std::vector<std::size_t> number{master};
  for (std::size_t s = 1; s < group.initialise.size(); ++s) {
    number.push_back(heard_from.size());
    heard_from.emplace_back();
  }
  for (std::size_t i = 0; i < number.size(); ++i)
    for (std::size_t j = 0; j < number.size(); ++j)
      if (i != j && group.notify(i, j).happens()) heard_from[number[i]].push_back({number[j], group.notify(i, j).ps()});
  for (const ReactionGroup::Inner& inner : group.inner) self(inner.group, number[inner.slave], heard_from, self);
}

}  // namespace

MaxPlus ready_bound(const ReactionGroup& group) { return group.initialise[0] + there_and_back(group, with_inner(group, group.initialise, ready_bound)); }

MaxPlus run_bound(const ReactionGroup& group) { return there_and_back(group, with_inner(group, std::vector(group.initialise.size(), MaxPlus::one()), run_bound)); }

MaxPlus start_bound(const ReactionGroup& group) { return ready_bound(group) * run_bound(group); }

std::vector<SpreadStep> slowest_spread(const ReactionGroup& group) {
  std::vector<std::vector<std::pair<std::size_t, Ps>>> heard_from(1);
  lay_out(group, 0, heard_from, [](const auto& g, std::size_t master, auto& all, const auto& self) -> void { lay_out(g, master, all, self); });
  // Whoever hears first acts: the shortest of the longest ways. Few participants, so by relaxation from each.
  const std::size_t n = heard_from.size();
  std::vector<SpreadStep> slowest;
  Ps latest = -1;
  for (std::size_t origin = 0; origin < n; ++origin) {
    std::vector<Ps> at(n, unbounded_ps);
    std::vector<SpreadStep> last(n);
    at[origin] = 0;
    for (bool changed = true; changed;) {
      changed = false;
      for (std::size_t to = 0; to < n; ++to)
        for (const auto& [from, ps] : heard_from[to])
          if (const Ps heard = sum(at[from], ps); heard < at[to]) {
            at[to] = heard;
            last[to] = {from, to, MaxPlus(ps)};
            changed = true;
          }
    }
    const auto to = static_cast<std::size_t>(std::max_element(at.begin(), at.end()) - at.begin());
    if (at[to] <= latest) continue;
    latest = at[to];
    slowest.clear();
    if (!is_bounded(latest)) return {{origin, to, MaxPlus::unbounded()}};
    for (std::size_t step = to; step != origin; step = last[step].from) slowest.insert(slowest.begin(), last[step]);
  }
  return slowest;
}

MaxPlus spread_bound(const ReactionGroup& group) {
  MaxPlus all = MaxPlus::one();
  for (const SpreadStep& step : slowest_spread(group)) all *= step.takes;
  return all;
}

namespace {

constexpr std::array<Reaction, 5> all_reactions = {Reaction::start, Reaction::halt, Reaction::suspend, Reaction::resume, Reaction::reset};

class ProgramReactions {
 public:
  ProgramReactions(const scenario::Resolved& r, std::size_t number, const BoundOptions& options, Bounds& bounds)
      : r_(r), number_(number), program_(r.programs[number]), options_(options), bounds_(bounds) {}

  void make() {
    const std::size_t n = program_.participants.size();
    group_.notify = MaxPlusMatrix(n, n);
    for (std::size_t p = 0; p < n; ++p) {
      const Ps initialisation = stretched(p, program_.description->initialisation.ps());
      group_.initialise.push_back(MaxPlus(sum(initialisation, os_of(p).wake_up.greatest().ps())));
      add_notifications(p);
    }
    for (const Reaction kind : all_reactions) add(kind);
    const MaxPlus spread = spread_bound(group_);
    SilenceBound silence{number_, {}};
    Ps time_out = 0;
    for (std::size_t p = 0; p < n; ++p) time_out = std::max(time_out, sum(stretched(p, program_.receive_timeout.ps()), os_of(p).wake_up.greatest().ps()));
    Ps last_word = 0;   // that is still under way when the peer falls silent
    for (std::size_t j = 0; j < n; ++j)
      for (const auto& latency : bounds_.streams[program_.state_streams[j].value].by_listener) last_word = latency ? std::max(last_word, latency->ps()) : unbounded_ps;
    if (const Ps all = sum(last_word, time_out, spread.ps()); is_bounded(all)) silence.bound = Duration::from_ps(all);
    bounds_.silences.push_back(silence);
  }

 private:
  const models::OsLatency& os_of(std::size_t p) const { return r_.plan.os_latencies[r_.plan.nodes[program_.participants[p].value].os_latency]; }
  Ps stretched(std::size_t p, Ps local) const {
    const ClockQuality clock = clock_quality(r_, program_.participants[p], options_);
    return sum(scaled_up(local, 1'000'000'000'000 + clock.rate_ppt, 1'000'000'000'000), 2 * clock.error);
  }
  Ps publish_wait(std::size_t p) const {
    if (program_.description->publish == scenario::Publish::on_change) return 0;
    return sum(stretched(p, program_.description->cycle.ps()), os_of(p).wake_up.greatest().ps());
  }

  void add_notifications(std::size_t from) {
    const StreamBound& stream = bounds_.streams[program_.state_streams[from].value];
    const models::StreamPlan& plan = r_.plan.streams[stream.index.value];
    for (std::size_t l = 0; l < plan.listeners.size(); ++l) {
      const auto to = static_cast<std::size_t>(std::find(program_.participants.begin(), program_.participants.end(), plan.listeners[l]) - program_.participants.begin());
      if (to == program_.participants.size()) continue;
      const Ps latency = stream.by_listener[l] ? stream.by_listener[l]->ps() : unbounded_ps;
      group_.notify(to, from) = MaxPlus(sum(publish_wait(from), latency));
      if (!stream.latency && reason_.empty()) reason_ = "stream " + stream.name + " is unbounded: " + stream.reason;
      assumptions_.add(stream.assumptions);
    }
  }

  void add(Reaction kind) {
    ReactionBound made;
    made.program = number_;
    made.kind = kind;
    made.assumptions = assumptions_;
    made.assumptions.add(Assumption::no_loss);
    made.assumptions.add(Assumption::one_command);
    if (program_.description->variant == scenario::Variant::paper) made.assumptions.add(Assumption::sampled_states);
    const MaxPlus whole = kind == Reaction::start ? start_bound(group_) : spread_bound(group_);
    if (kind == Reaction::start) {
      made.assumptions.add(Assumption::initialisation);
      add_start_parts(made);
    } else {
      add_spread_parts(made);
    }
    if (is_bounded(whole.ps()))
      made.bound = Duration::from_ps(whole.ps());
    else
      made.reason = reason_.empty() ? "a notification is unbounded" : reason_;
    if (!made.bound) made.parts.clear();
    bounds_.reactions.push_back(std::move(made));
  }

  const std::string& name(std::size_t p) const { return r_.topology.nodes[program_.participants[p].value].name; }
  void add_part(ReactionBound& made, std::string what, Ps ps) const { made.parts.push_back({std::move(what), Duration::from_ps(ps)}); }

  void add_start_parts(ReactionBound& made) const {
    const auto chain = [&](std::size_t s, Ps middle) { return sum(group_.notify(s, 0).ps(), middle, group_.notify(0, s).ps()); };
    std::size_t slowest = 1;
    std::size_t last = 1;
    for (std::size_t s = 1; s < program_.participants.size(); ++s) {
      if (chain(s, group_.initialise[s].ps()) > chain(slowest, group_.initialise[slowest].ps())) slowest = s;
      if (chain(s, 0) > chain(last, 0)) last = s;
    }
    if (group_.initialise[0].ps() > chain(slowest, group_.initialise[slowest].ps())) {
      add_part(made, name(0) + " initialises", group_.initialise[0].ps());
    } else {
      add_part(made, name(slowest) + " hears of INIT", group_.notify(slowest, 0).ps());
      add_part(made, name(slowest) + " initialises", group_.initialise[slowest].ps());
      add_part(made, name(0) + " hears of Ready", group_.notify(0, slowest).ps());
    }
    add_part(made, name(last) + " hears of Ready", group_.notify(last, 0).ps());
    add_part(made, name(0) + " hears of Running", group_.notify(0, last).ps());
  }

  void add_spread_parts(ReactionBound& made) const {
    for (const SpreadStep& step : slowest_spread(group_)) add_part(made, name(step.to) + " hears of " + name(step.from), step.takes.ps());
  }

  const scenario::Resolved& r_;
  std::size_t number_;
  const scenario::ResolvedProgram& program_;
  const BoundOptions& options_;
  Bounds& bounds_;
  ReactionGroup group_;
  Assumptions assumptions_;
  std::string reason_;
};

}  // namespace

void add_reactions(const scenario::Resolved& resolved, const BoundOptions& options, Bounds& bounds) {
  for (std::size_t p = 0; p < resolved.programs.size(); ++p) ProgramReactions(resolved, p, options, bounds).make();
}

}  // namespace takt::analysis
