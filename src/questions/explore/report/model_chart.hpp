// SPDX-License-Identifier: Apache-2.0
// A run once more with the model that it was found with, as a chart: for models whose values replay.hpp does not know.
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "explore/model/forgery.hpp"
#include "explore/model/model.hpp"
#include "explore/report/chart.hpp"
#include "sim/check.hpp"

namespace takt::explore {

/// Who hears a register, whose word it takes it for, and the word, if there is one for its participant.
struct Hearing {
  std::size_t who = 0;
  std::size_t of = 0;
  std::optional<Letter> letter;
};

/// What there is to say of a model's states and actions: a class made from a Query, with
///   M model                                    whose runs are told
///   width                                      of a column
///   names()                                    of the columns
///   states(state)                              the cells of the columns
///   step(state, action)                        a step before it is taken
///   origins()                                  as in a Chart
///   pairs()                                    (who, of) of all that may hear each other, columns
///   participant(state, column)                 null where none is up
///   peer(state, who, of)                       the number under which `who` remembers it; nothing if it is none of its
///   peers now channels                                   how many registers there are speaker(channel) column
///   heard(state, channel)                      what hearing it tells the participant there: a Hearing

/// Who has heard what, kept beside a model's states: they say what a participant remembers, and this says since when.
template <class W>
class Ledger {
 public:
  explicit Ledger(W& words) : words_(&words), said_(words.channels), forged_(words.channels, false) {
    for (const auto& [who, of] : words.pairs()) {
      Heard& heard = heard_.emplace_back();
      heard.who = who;
      heard.of = of;
    }
  }

  /// Step `number` led from one state to the other one.
  void note(const State& before, Action action, const State& after, std::size_t number) {
    if (action.kind == ActionKind::receive) hear(before, action.who, number);
    for (std::size_t c = 0; c < said_.size(); ++c) {
      const bool is_put = before.content(c) != after.content(c) ||
                          (action.kind == ActionKind::forge && words_->speaker(c) == action.who);
      if (!is_put) continue;
      said_[c] = number;
      forged_[c] = action.kind == ActionKind::forge;
    }
    forget(after);
  }

  Moment moment(const State& state) const {
    Moment made;
    for (std::size_t column = 0; column < words_->names().size(); ++column) {
      const Participant* const participant = words_->participant(state, column);
      made.says.push_back(participant == nullptr ? std::nullopt : std::optional(participant->word()));
    }
    for (const Heard& heard : heard_)
      if (words_->peer(state, heard.who, heard.of)) made.heard.push_back(heard);
    return made;
  }

 private:
  void hear(const State& before, std::size_t channel, std::size_t number) {
    const auto [who, of, letter] = words_->heard(before, channel);
    const std::optional<std::size_t> peer = words_->peer(before, who, of);
    if (!letter || !peer) return;
    // Whether it takes notice is what a copy of it does with the word.
    Participant copy = *words_->participant(before, who);
    if (copy.step(handshake::Input::received(*peer, letter->word, letter->ahead ? sequence_ahead : usual_sequence))
            .ignored)
      return;
    for (Heard& heard : heard_)
      if (heard.who == who && heard.of == of)
        heard = {who, of, true, letter->word, said_[channel], number, forged_[channel], false};
  }
  /// Who is new, down or has another peer instead remembers nothing.
  void forget(const State& after) {
    for (Heard& heard : heard_) {
      const std::optional<std::size_t> peer = words_->peer(after, heard.who, heard.of);
      if (!peer || !words_->participant(after, heard.who)->known_of(*peer).heard)
        heard = {heard.who, heard.of, false, {}, 0, 0, false, false};
      else
        TAKT_CHECK(is_remembered(*words_->participant(after, heard.who), *peer, heard),
                   "what was heard is what its hearer remembers");
    }
  }

  W* words_;
  std::vector<std::size_t> said_;  ///< by channel: in which step what stands there was put there
  std::vector<bool> forged_;
  std::vector<Heard> heard_;
};

template <class W>
Chart chart_with(const Query& query, const Beginning& beginning, const Trace& trace) {
  W words(query);
  auto& model = words.model;
  Chart chart;
  chart.names = words.names();
  chart.width = W::width;
  State state = model.switched_on();
  // Numbers of states belong to one model, so the beginning is gone through again.
  state.set_commands_left(most_commands);
  Next next;
  Ledger<W> ledger(words);
  for (const Action action : beginning.actions) {
    if (!model.act(state, action, next)) continue;
    ledger.note(state, action, next.state, 0);
    state = next.state;
  }
  state.set_commands_left(model.query().commands);
  state.set_faults_left(model.query().fault_budget);
  chart.beginning = beginning.name;
  chart.states = words.states(state);
  chart.origins = words.origins();
  chart.moment = ledger.moment(state);
  chart.cycle = trace.cycle;
  for (const Action action : trace.actions) {
    ChartStep& step = chart.steps.emplace_back(words.step(state, action));
    step.mark = mark_of(action.kind);
    step.action = action;
    step.actor = step.arrow ? step.arrow->second : step.marked.front();
    step.moment = ledger.moment(state);
    try {
      model.act(state, action, next);
    } catch (const sim::InvariantBroken& broken) {
      step.states = words.states(state);
      step.findings.push_back(std::string("breaks ") + broken.what());
      break;
    }
    for (std::size_t p = 0; p < property_count; ++p) {
      const auto property = static_cast<Property>(p);
      if (must_always_hold(property) && next.properties.contains(property))
        step.findings.push_back("violates " + std::string(name_of(property)));
    }
    ledger.note(state, action, next.state, chart.steps.size());
    state = next.state;
    step.states = words.states(state);
    step.moment = ledger.moment(state);
  }
  return chart;
}

}  // namespace takt::explore
