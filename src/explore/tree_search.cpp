#include "explore/tree_search.hpp"

#include <algorithm>
#include <deque>
#include <utility>

#include "explore/components.hpp"
#include "explore/tree_chart.hpp"
#include "explore/tree_model.hpp"
#include "sim/check.hpp"

namespace takt::explore {
namespace {

using Position = StateStore::Position;

/// Where the network actions lead from a state; itself where nothing changes.
class Graph {
 public:
  Graph(TreeModel& model, const StateStore& store) : model_(&model), store_(&store) {}
  void successors(Position from, std::vector<Position>& to) {
    const State state = (*store_)[from];
    const std::span<const Action> actions = model_->network_actions();
    to.assign(actions.size(), from);
    Next next;
    for (std::size_t a = 0; a < actions.size(); ++a) {
      if (!model_->act(state, actions[a], next) || next.state == state) continue;
      to[a] = store_->find(next.state, next.state.hash());
      TAKT_CHECK(to[a] != StateStore::nowhere, "every successor of a searched state is stored");
    }
  }

 private:
  TreeModel* model_;
  const StateStore* store_;
};

class Search {
 public:
  Search(const Question& question, const Watcher& watcher) : watcher_(watcher), model_(question), store_(model_.shape(), question.states) {}

  Answer run() {
    for (const Beginning& beginning : model_.beginnings()) store_.insert(beginning.state, beginning.state.hash(), StateStore::nowhere);
    std::size_t level_end = store_.size();
    for (; expanded_ < store_.size() && !ended_; ++expanded_) {
      if (expanded_ == level_end) {
        ++depth_;
        level_end = store_.size();
      }
      if (depth_ >= model_.question().depth) ended_ = true;
      else expand(static_cast<Position>(expanded_));
      if ((expanded_ & 0x7FFFU) == 0x7FFFU && !watcher_({store_.size(), expanded_, depth_, store_.memory(), false})) ended_ = answer_.interrupted = true;
    }
    answer_.exhausted = !ended_;
    if (answer_.exhausted && loops_back_) judge();
    finish();
    return std::move(answer_);
  }

 private:
  void expand(Position position) {
    const State state = store_[position];
    const std::span<const Action> actions = model_.actions(state);
    const std::size_t network = model_.network_actions().size();
    bool quiescent = true;
    for (std::size_t a = 0; a < actions.size() && !ended_; ++a)
      if (take(state, position, actions[a]) && a < network) quiescent = false;
    if (!quiescent) return;
    ++answer_.quiescent;
    if (!model_.settled(state)) see(model_.anybody_down(state) ? Property::F1 : Property::L1, position);
  }

  /// True if it leads to another state.
  bool take(const State& state, Position position, Action action) {
    if (!act(state, position, action)) return false;
    ++answer_.transitions;
    if ((next_.properties.bits & ~seen_.bits) != 0) {
      for (std::size_t p = 0; p < property_count; ++p)
        if (next_.properties.contains(static_cast<Property>(p))) see(static_cast<Property>(p), position, action);
    }
    if (next_.state == state) return false;
    const StateStore::Inserted inserted = store_.insert(next_.state, next_.state.hash(), position);
    if (inserted.position == StateStore::nowhere) ended_ = true;
    else if (inserted.position <= position && is_network(action.kind)) loops_back_ = true;
    if (inserted.is_new && !seen_.contains(Property::all_running) && model_.all_running(next_.state)) see(Property::all_running, inserted.position);
    return true;
  }

  /// A broken CHECK of the handshake (both groups of a node are in step) is told with the run that leads to it.
  bool act(const State& state, Position position, Action action) {
    try {
      return model_.act(state, action, next_);
    } catch (const sim::InvariantBroken& broken) {
      Trace trace = way_to(position);
      trace.actions.push_back(action);
      throw sim::InvariantBroken(std::string(broken.what()) + "\n\n" + tree_chart(model_.question(), model_.beginnings()[trace.beginning], trace));
    }
  }

  void see(Property property, Position position, std::optional<Action> then = std::nullopt) {
    if (seen_.contains(property)) return;
    seen_.insert(property);
    Trace trace = way_to(position);
    if (then) trace.actions.push_back(*then);
    answer_.traces[index_of(property)] = std::move(trace);
  }

  /// The actions that lead to a state, by its ancestors.
  Trace way_to(Position target) {
    std::vector<Position> way{target};
    while (store_.parent(way.back()) != StateStore::nowhere) way.push_back(store_.parent(way.back()));
    Trace trace{way.back(), {}, 0};  // the beginnings stand first
    for (std::size_t i = way.size() - 1; i-- > 0;) trace.actions.push_back(action_between(way[i + 1], way[i]));
    return trace;
  }
  Action action_between(Position from, Position to) {
    const State before = store_[from];
    const State after = store_[to];
    Next next;
    for (const Action action : model_.actions(before))
      if (model_.act(before, action, next) && next.state == after) return action;
    sim::check_failed("action", "every state but the first ones follows from its parent", __FILE__, __LINE__);
  }

  /// Fair cycles of network steps outside the goal, as in liveness.hpp.
  void judge() {
    Graph graph(model_, store_);
    Components<Graph> components(graph, store_.size());
    for (auto root = static_cast<Position>(store_.size()); root-- > 0;) {
      if ((root & 0x7FFFU) == 0 && !watcher_({store_.size(), store_.size() - root, depth_, store_.memory(), true})) {
        answer_.interrupted = true;
        return;
      }
      components.from(root, [&](const std::vector<Position>& component) {
        if (component.size() < 2) return;
        answer_.cyclic_states += component.size();
        const auto outside = std::find_if(component.begin(), component.end(), [&](Position each) { return !model_.settled(store_[each]); });
        if (outside == component.end() || !is_fair(graph, component)) return;
        const Property property = model_.anybody_down(store_[*outside]) ? Property::F1 : Property::L1;
        if (seen_.contains(property)) return;
        see(property, *outside);
        go_round(graph, component, *outside, *answer_.traces[index_of(property)]);
      });
    }
    judged_ = true;
  }

  static bool contains(const std::vector<Position>& component, Position state) { return std::binary_search(component.begin(), component.end(), state); }

  /// Each network action leads from some state of the component into it.
  bool is_fair(Graph& graph, const std::vector<Position>& component) const {
    std::vector<bool> stays(model_.network_actions().size(), false);
    std::vector<Position> to;
    for (const Position each : component) {
      graph.successors(each, to);
      for (std::size_t a = 0; a < to.size(); ++a) stays[a] = stays[a] || contains(component, to[a]);
    }
    return std::find(stays.begin(), stays.end(), false) == stays.end();
  }

  /// Appends a shortest way from a state of the component back to itself.
  void go_round(Graph& graph, const std::vector<Position>& component, Position state, Trace& trace) {
    std::vector<Position> from(component.size(), StateStore::nowhere);
    const auto place = [&](Position each) { return static_cast<std::size_t>(std::lower_bound(component.begin(), component.end(), each) - component.begin()); };
    std::deque<Position> open{state};
    std::vector<Position> to;
    while (from[place(state)] == StateStore::nowhere) {
      const Position now = open.front();
      open.pop_front();
      graph.successors(now, to);
      for (const Position each : to) {
        if (each == now || !contains(component, each) || from[place(each)] != StateStore::nowhere) continue;
        from[place(each)] = now;
        open.push_back(each);
      }
    }
    std::vector<Position> way{state};
    do way.push_back(from[place(way.back())]);
    while (way.back() != state);
    for (std::size_t i = way.size() - 1; i-- > 0;) trace.actions.push_back(action_between(way[i + 1], way[i]));
    trace.cycle = way.size() - 1;
  }

  void finish() {
    answer_.states = store_.size();
    answer_.depth = depth_;
    answer_.beginnings = model_.beginnings();
    answer_.octets = store_.memory();
    answer_.participants = model_.nodes().size();
    answer_.words = model_.nodes().word_count() - 1;
    for (std::size_t p = 0; p < property_count; ++p) {
      const auto property = static_cast<Property>(p);
      Verdict& verdict = answer_.verdicts[p];
      const bool seen = seen_.contains(property);
      const bool is_liveness = property == Property::L1 || property == Property::F1;
      const bool decided = answer_.exhausted && (judged_ || !loops_back_);
      if (is_of_silence(property) && !model_.question().asks_for_silence()) verdict = Verdict::not_asked;
      else if (!must_always_hold(property)) verdict = seen ? Verdict::reached : Verdict::unreached;
      else if (seen) verdict = Verdict::violated;
      else verdict = is_liveness && !decided ? Verdict::unknown : Verdict::holds;
    }
  }

  const Watcher& watcher_;
  TreeModel model_;
  StateStore store_;
  Answer answer_;
  Next next_;
  PropertySet seen_;
  std::size_t expanded_ = 0;
  std::uint32_t depth_ = 0;
  bool loops_back_ = false;   ///< some network step leads to an earlier state, so there may be cycles
  bool judged_ = false;
  bool ended_ = false;
};

}  // namespace

Answer explore_tree(const Question& question, const Watcher& watcher) { return Search(question, watcher).run(); }

}  // namespace takt::explore
