// SPDX-License-Identifier: Apache-2.0
#include "explore/properties/recurrence.hpp"

#include <algorithm>
#include <numeric>

#include "explore/properties/components.hpp"

namespace takt::explore {
namespace {

using Kind = handshake::Input::Kind;
using Nodes = std::vector<std::uint32_t>;

/// Words of which one may follow the other again and again.
class WordClasses {
 public:
  explicit WordClasses(std::size_t words) : parent_(words) { std::iota(parent_.begin(), parent_.end(), 0U); }
  std::uint32_t of(std::uint32_t word) const {
    while (parent_[word] != word) word = parent_[word];
    return word;
  }
  void join(std::uint32_t a, std::uint32_t b) { parent_[std::max(of(a), of(b))] = std::min(of(a), of(b)); }
  bool operator==(const WordClasses&) const = default;

 private:
  std::vector<std::uint32_t> parent_;
};

struct Step {
  MemberId to = 0;
  Kind kind = Kind::received;
  std::uint8_t peer = 0;
  WordId word = no_word;
};

/// All steps that a fair network takes again and again: what was overtaken comes once.
class Steps {
 public:
  explicit Steps(const Members& members) : first_(members.size() + 1, 0) {
    members.each_step([&](MemberId from, const Stimulus& stimulus, MemberId to) {
      if (recurs(from, stimulus, to)) ++first_[from + 1];
    });
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    steps_.resize(first_.back());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    members.each_step([&](MemberId from, const Stimulus& stimulus, MemberId to) {
      if (recurs(from, stimulus, to)) steps_[next[from]++] = {to, stimulus.kind, stimulus.what, stimulus.word};
    });
  }
  std::span<const Step> from(MemberId member) const {
    return {steps_.data() + first_[member], first_[member + 1] - first_[member]};
  }

 private:
  static bool recurs(MemberId from, const Stimulus& stimulus, MemberId to) {
    return from != to && stimulus.kind != Kind::command && stimulus.kind != Kind::finished && !stimulus.overtaken;
  }
  std::vector<std::uint32_t> first_;
  std::vector<Step> steps_;
};

constexpr std::uint32_t anything = ~0U;  ///< as a class of words: any of them, and silence
constexpr std::uint32_t silent = ~1U;

class Finder {
 public:
  Finder(const Members& members, std::size_t most_peers)
      : members_(&members),
        steps_(members),
        classes_(members.word_count()),
        heard_(most_peers, anything),
        scope_(members.size(), 0),
        goes_round_(members.size(), false) {}

  std::vector<bool> find() {
    Nodes all(members_->size());
    std::iota(all.begin(), all.end(), 0U);
    // First with peers that say anything at any time; then only with what those may say that went round so far.
    each_component(all, [&](const Nodes& component) { note(component); });
    for (bool again = true; again;) {
      const std::vector<bool> before = goes_round_;
      classes_ = WordClasses(members_->word_count());
      for (const Nodes& component : found_) join_words(component);
      std::vector<Nodes> suspects = std::move(found_);
      found_.clear();
      std::fill(goes_round_.begin(), goes_round_.end(), false);
      for (const Nodes& component : suspects) narrow(component, 0);
      again = before != goes_round_;
    }
    return goes_round_;
  }

  void successors(std::uint32_t from, Nodes& to) const {
    to.clear();
    for (const Step& step : steps_.from(from))
      if (scope_[step.to] == scope_[from] && is_heard(step)) to.push_back(step.to);
  }

 private:
  bool is_heard(const Step& step) const {
    if (step.kind == Kind::initialised || heard_[step.peer] == anything) return true;
    if (step.kind == Kind::peer_silent) return heard_[step.peer] == silent;
    return heard_[step.peer] != silent && classes_.of(step.word) == heard_[step.peer];
  }

  /// Each peer in turn is silent, or says words of one class.
  void narrow(const Nodes& component, std::size_t peer) {
    if (peer == heard_.size()) {
      note(component);
      return;
    }
    std::vector<std::uint32_t> choices{silent};
    for (const MemberId member : component)
      for (const Step& step : steps_.from(member))
        if (step.kind == Kind::received && step.peer == peer) choices.push_back(classes_.of(step.word));
    std::sort(choices.begin(), choices.end());
    choices.erase(std::unique(choices.begin(), choices.end()), choices.end());
    for (const std::uint32_t choice : choices) {
      heard_[peer] = choice;
      std::vector<Nodes> parts;
      each_component(component, [&](const Nodes& part) { parts.push_back(part); });
      for (const Nodes& part : parts) narrow(part, peer + 1);
    }
    heard_[peer] = anything;
  }

  /// Components of more than one member among these.
  template <class Found>
  void each_component(const Nodes& nodes, Found&& found) {
    ++scopes_;
    for (const MemberId member : nodes) scope_[member] = scopes_;
    Components<Finder> components(*this, members_->size());
    for (const MemberId member : nodes)
      components.from(member, [&](const Nodes& component) {
        if (component.size() > 1) found(component);
      });
  }

  void note(const Nodes& component) {
    for (const MemberId member : component) goes_round_[member] = true;
    found_.push_back(component);
  }
  void join_words(const Nodes& component) {
    for (const MemberId member : component)
      classes_.join((*members_)[component.front()].word, (*members_)[member].word);
  }

  const Members* members_;
  Steps steps_;
  WordClasses classes_;
  std::vector<std::uint32_t> heard_;  ///< by peer
  std::vector<std::uint32_t> scope_;  ///< by member
  std::uint32_t scopes_ = 0;
  std::vector<bool> goes_round_;
  std::vector<Nodes> found_;
};

}  // namespace

std::vector<bool> members_that_go_round(const Members& members, std::size_t most_peers) {
  return Finder(members, most_peers).find();
}

}  // namespace takt::explore
