// SPDX-License-Identifier: Apache-2.0
#include "emulate/invariant_check.hpp"

#include <algorithm>
#include <deque>

#include "handshake/observer.hpp"
#include "plant/protocol.hpp"
#include "scenario/resolve/nesting.hpp"

namespace takt::emulate {
namespace {

/// Where a Program's steps go: to the observer of its tree, which may be itself alone.
struct Watched {
  handshake::Observer* observer = nullptr;
  std::size_t group = 0;                          ///< of the tree
  std::vector<handshake::PublishedState> states;  ///< by participant
};

class Checker {
 public:
  explicit Checker(const scenario::Resolved& resolved) : resolved_(resolved), watched_(resolved.programs.size()) {
    for (const std::vector<std::uint32_t>& tree : scenario::trees_of(resolved)) watch(tree);
    for (std::uint32_t p = 0; p < watched_.size(); ++p) {
      watched_[p].states.assign(resolved.programs[p].participant_names.size(), handshake::PublishedState::Halted);
      if (watched_[p].observer == nullptr) watch({p});
    }
  }

  void take(const LoggedStep& step) {
    Watched& watched = watched_[step.program];
    if (step.is_crash) {
      watched.states[step.participant] = handshake::PublishedState::Halted;
      watched.observer->on_restart(watched.observer->tree().number_of(watched.group, step.participant));
      return;
    }
    handshake::Outputs outputs;
    outputs.publish = true;  // what is logged has changed the word
    outputs.raised = step.raised.has_value();
    if (step.raised) outputs.raised_kind = *step.raised;
    if (step.change) outputs.add(*step.change);
    if (step.change) watched.states[step.participant] = step.change->to;
    handshake::Word after;
    after.state = watched.states[step.participant];
    after.run = step.run;
    after.intent.run = step.intent_run;
    watched.observer->on_step(watched.observer->tree().number_of(watched.group, step.participant), outputs, after);
  }

  std::vector<std::string> violated() const {
    std::vector<std::string> texts;
    // Programs that stand alone come first.
    for (const bool is_nested : {false, true})
      for (const Tree& tree : trees_)
        for (const handshake::Violation& each : tree.observer.violations())
          if ((tree.programs.size() > 1) == is_nested)
            texts.push_back(text_of(tree.programs[each.group], each) + (each.of_tree ? " (of the tree)" : ""));
    return texts;
  }

 private:
  struct Tree {
    std::vector<std::uint32_t> programs;
    handshake::Observer observer;
  };

  void watch(const std::vector<std::uint32_t>& tree) {
    std::vector<handshake::TreeGroup> groups;
    for (const std::uint32_t number : tree) {
      handshake::TreeGroup group{resolved_.programs[number].participant_names.size(), 0, 0};
      if (const auto& outer = resolved_.programs[number].outer) {
        group.outer = static_cast<std::size_t>(std::find(tree.begin(), tree.end(), outer->program) - tree.begin());
        group.outer_index = outer->participant;
      }
      groups.push_back(group);
    }
    trees_.push_back({tree, handshake::Observer(resolved_.programs[tree.front()].description->variant,
                                                handshake::GroupTree(std::move(groups)))});
    for (std::size_t g = 0; g < tree.size(); ++g) {
      watched_[tree[g]].observer = &trees_.back().observer;
      watched_[tree[g]].group = g;
    }
  }

  std::string text_of(std::size_t program, const handshake::Violation& violation) const {
    return std::string(name_of(violation.invariant)) + ": " +
           resolved_.programs[program].participant_names[violation.participant] + " of " +
           resolved_.programs[program].name + " " + std::string(handshake::text_of(violation.finding));
  }

  const scenario::Resolved& resolved_;
  std::vector<Watched> watched_;
  std::deque<Tree> trees_;  // a deque, because they are pointed at
};

}  // namespace

InvariantCheck check_invariants(const scenario::Resolved& resolved, std::vector<LoggedStep> steps) {
  std::stable_sort(steps.begin(), steps.end(),
                   [](const LoggedStep& a, const LoggedStep& b) { return a.time < b.time; });
  Checker checker(resolved);
  for (const LoggedStep& step : steps) checker.take(step);
  return {steps.size(), checker.violated()};
}

}  // namespace takt::emulate
