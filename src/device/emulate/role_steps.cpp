// SPDX-License-Identifier: Apache-2.0
#include "emulate/role_steps.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "handshake/role_observer.hpp"

namespace takt::emulate {
namespace {

using handshake::Binding;
using handshake::PublishedState;

class Merger {
 public:
  explicit Merger(const scenario::Resolved& resolved) : resolved_(resolved) {
    for (const scenario::ResolvedProgram& program : resolved.programs) {
      groups_.push_back({std::vector<handshake::RoleObserver>(program.description->roles.size()), {}});
      result_.histories.emplace_back(program.description->roles.size());
    }
  }

  void take(const LoggedStep& step) {
    if (step.bound)
      bind(step);
    else if (step.self)
      read_candidate(step);
    else
      result_.steps.push_back(step);
  }
  RoleSteps result() { return std::move(result_); }

 private:
  struct Group {
    std::vector<handshake::RoleObserver> observers;  ///< by role
    std::map<std::pair<std::uint8_t, std::uint32_t>, PublishedState>
        lives;  ///< the states of participants on candidates
  };

  void bind(const LoggedStep& step) {
    Group& group = groups_[step.program];
    const std::size_t role = step.participant - std::size_t{1};
    const auto known = group.lives.find({step.bound->candidate, step.bound->life});
    const auto change = group.observers[role].on_bound(
        *step.bound, known == group.lives.end() ? std::nullopt : std::optional(known->second));
    if (change.gone) crash(step, *change.gone);
    if (!change.is_another) return;
    const auto& candidates = resolved_.programs[step.program].candidates();
    result_.histories[step.program][role].nodes.push_back(
        step.bound->bound() ? resolved_.topology.nodes[candidates[step.bound->candidate].node.value].name
                            : std::string());
  }

  void read_candidate(const LoggedStep& step) {
    Group& group = groups_[step.program];
    const std::size_t role = step.participant - std::size_t{1};
    const std::pair life{step.self->candidate, step.self->life};
    if (step.is_crash) {
      group.lives.erase(life);
      if (const auto before = group.observers[role].on_dropped(*step.self)) crash(step, *before);
      return;
    }
    PublishedState& state = group.lives.try_emplace(life, PublishedState::Halted).first->second;
    if (step.change) state = step.change->to;
    if (group.observers[role].on_step(*step.self, state)) result_.steps.push_back(step);
  }

  void crash(const LoggedStep& step, PublishedState before) {
    LoggedStep crash;
    crash.time = step.time;
    crash.program = step.program;
    crash.participant = step.participant;
    crash.is_crash = true;
    if (before != PublishedState::Halted) crash.change = handshake::StateChange{0, before, PublishedState::Halted};
    result_.steps.push_back(crash);
  }

  const scenario::Resolved& resolved_;
  std::vector<Group> groups_;
  RoleSteps result_;
};

}  // namespace

RoleSteps steps_of_roles(const scenario::Resolved& resolved, std::vector<LoggedStep> steps) {
  std::stable_sort(steps.begin(), steps.end(),
                   [](const LoggedStep& a, const LoggedStep& b) { return a.time < b.time; });
  Merger merger(resolved);
  for (const LoggedStep& step : steps) merger.take(step);
  return merger.result();
}

}  // namespace takt::emulate
