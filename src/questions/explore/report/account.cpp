// SPDX-License-Identifier: Apache-2.0
#include "explore/report/account.hpp"

#include <algorithm>

namespace takt::explore {
namespace {

std::string step_text(std::size_t step) {
  return step == 0 ? "before the first step" : "in step " + std::to_string(step);
}
std::string since_text(std::size_t step) {
  return step == 0 ? "since the beginning" : "since step " + std::to_string(step);
}

std::string said_text(std::size_t said_in, std::size_t heard_in, bool forged, bool replayed) {
  if (replayed) return "said " + step_text(said_in) + ", replayed by a stranger " + step_text(heard_in);
  if (heard_in == 0) return "heard before the first step";
  return std::string("said ") + (forged ? "by a stranger " : "") + step_text(said_in) + ", heard " +
         step_text(heard_in);
}

std::string listed(const std::vector<std::string>& items) {
  std::string text;
  for (std::size_t i = 0; i < items.size(); ++i)
    text += (i == 0 ? "" : i + 1 == items.size() ? " and " : ", ") + items[i];
  return text;
}

}  // namespace

std::string text_of(const Belief& belief) {
  const std::string truth = belief.now + " " + since_text(belief.now_since);
  if (!belief.word) return belief.who + " has heard nothing of " + belief.of + ", which is " + truth;
  return belief.who + " takes " + belief.of + " for " + *belief.word + ", " +
         said_text(*belief.said_in, *belief.heard_in, belief.by_stranger, belief.is_replayed) +
         (*belief.is_true ? "; so it is" : "; it is " + truth);
}

const Heard* Account::heard(std::size_t at, std::size_t who, std::size_t of) const {
  for (const Heard& each : moment(at).heard)
    if (each.who == who && each.of == of) return &each;
  return nullptr;
}

std::string Account::word_text(const handshake::Word& word, std::size_t of) const {
  const std::vector<std::string>& names = chart_->origins[of];
  return explore::text_of(word, word.intent.origin < names.size() ? names[word.intent.origin] : "a stranger");
}

std::string Account::says(std::size_t at, std::size_t column) const {
  const std::optional<handshake::Word>& word = moment(at).says[column];
  if (word) return word_text(*word, column);
  const std::string& cell = state(at, column);
  return cell == down_state ? cell : "without a role (" + cell + ")";
}

bool Account::says_the_same(std::size_t at, std::size_t other, std::size_t column) const {
  const std::optional<handshake::Word>& word = moment(at).says[column];
  return word == moment(other).says[column] && (word || state(at, column) == state(other, column));
}

bool Account::is_true(std::size_t at, const Heard& heard) const { return moment(at).says[heard.of] == heard.word; }

std::size_t Account::since(std::size_t at, std::size_t column) const {
  while (at != 0 && says_the_same(at, at - 1, column)) --at;
  return at;
}

std::string Account::missed(std::size_t at, const Heard& heard) const {
  std::vector<std::string> all;
  const std::size_t last = since(at, heard.of);
  for (std::size_t begin = heard.said_in + 1; begin < last;) {
    std::size_t end = begin + 1;
    while (says_the_same(end, end - 1, heard.of)) ++end;  // at the latest at `last` it says something else
    const bool is_another = !says_the_same(begin, begin - 1, heard.of);
    bool was_heard = false;
    for (std::size_t m = 0; m <= at; ++m)
      if (const Heard* const then = this->heard(m, heard.who, heard.of))
        was_heard = was_heard || (then->ever && !then->forged && then->said_in >= begin && then->said_in < end);
    if (is_another && !was_heard) all.push_back(says(begin, heard.of) + " " + since_text(begin));
    begin = end;
  }
  return listed(all);
}

Belief Account::belief(std::size_t at, const Heard& heard) const {
  Belief made;
  made.who = chart_->names[heard.who];
  made.of = chart_->names[heard.of];
  if (heard.ever) {
    made.heard = handshake::name_of(heard.word.state);
    made.word = word_text(heard.word, heard.of);
    made.said_in = heard.said_in;
    made.heard_in = heard.heard_in;
    made.age = at - heard.said_in;
    made.by_stranger = heard.forged;
    made.is_replayed = heard.replayed;
    made.is_true = is_true(at, heard);
  }
  made.now = says(at, heard.of);
  made.now_since = since(at, heard.of);
  return made;
}

std::vector<Belief> Account::beliefs(std::size_t at, std::optional<std::size_t> cause) const {
  std::vector<Belief> all;
  for (const Heard& each : moment(at).heard) {
    Belief& made = all.emplace_back(belief(at, each));
    made.is_cause = cause == each.who;
    if (at == 0) continue;
    const Heard* const before = heard(at - 1, each.who, each.of);
    made.is_new = before == nullptr || before->ever != each.ever ||
                  (each.ever && (before->word != each.word || before->forged != each.forged ||
                                 before->replayed != each.replayed || is_true(at - 1, *before) != is_true(at, each)));
  }
  return all;
}

Ending Account::ending(Property property) const {
  if (chart_->cycle != 0) return Ending::cycle;
  if (property == Property::L1 || chart_->steps.empty()) return Ending::standstill;
  if (property != Property::F1) return Ending::violation;
  const ChartStep& last = chart_->steps.back();
  const bool expires = last.action.kind == ActionKind::silence || last.action.kind == ActionKind::timeout;
  return expires && last.states[last.actor] != handshake::name_of(handshake::PublishedState::Halted)
             ? Ending::violation
             : Ending::standstill;
}

std::vector<std::size_t> Account::changing(std::size_t step) const {
  const std::size_t actor = chart_->steps[step - 1].actor;
  std::vector<std::size_t> columns;
  for (std::size_t column = 0; column < chart_->names.size(); ++column)
    if (state(step, column) != state(step - 1, column)) columns.push_back(column);
  if (columns.empty()) return {actor};
  const auto first = std::find(columns.begin(), columns.end(), actor);
  if (first != columns.end()) std::rotate(columns.begin(), first, first + 1);
  return columns;
}

std::size_t Account::doer(std::size_t step) const { return changing(step).front(); }

std::string Account::truth(std::size_t at, const Heard& heard, Steps& earlier) const {
  const std::size_t now = since(at, heard.of);
  const std::string between = missed(at, heard);
  const std::string unheard = between.empty() ? "" : "; in between, unheard, it was " + between;
  const std::string& name = chart_->names[heard.of];
  if (heard.ever && is_true(at, heard))
    return "and so " + name + (now <= heard.said_in ? " still is" : " is again" + unheard);
  earlier.insert(now);
  return (heard.ever ? "but " + name : name) + " is " + says(at, heard.of) + (heard.ever ? " by then, " : " ") +
         since_text(now) + unheard;
}

std::string Account::trigger(std::size_t step, Steps& earlier) const {
  const ChartStep& done = chart_->steps[step - 1];
  const auto taken = std::find_if(done.moment.heard.begin(), done.moment.heard.end(),
                                  [step](const Heard& each) { return each.ever && each.heard_in == step; });
  if (taken == done.moment.heard.end()) return done.sentence;
  earlier.insert(taken->forged ? taken->said_in : since(taken->said_in, taken->of));
  return done.sentence + ", said " + (taken->forged ? "by a stranger " : "") + step_text(taken->said_in) + ", " +
         truth(step, *taken, earlier);
}

std::string Account::change(std::size_t step, Steps& earlier) const {
  std::vector<std::string> changes;
  for (const std::size_t column : changing(step)) {
    const std::string& before = state(step - 1, column);
    const std::string& after = state(step, column);
    if (before != after)
      changes.push_back(chart_->names[column] + (after == down_state ? " is " : " becomes ") + after + " (was " +
                        before + " " + since_text(since(step - 1, column)) + ")");
    else if (says_the_same(step, step - 1, column))
      changes.push_back(chart_->names[column] + " stays " + says(step, column));
    else
      changes.push_back(chart_->names[column] + " says from now on " + says(step, column));
    earlier.insert(since(step - 1, column));
  }
  return "Step " + std::to_string(step) + ": " + listed(changes) + ": " + trigger(step, earlier) + ".";
}

std::string Account::known(std::size_t at, const Heard& heard, Steps& earlier) const {
  const std::string of = "all that it knows of " + chart_->names[heard.of] + ": ";
  if (!heard.ever) return of + "nothing, never heard; " + truth(at, heard, earlier);
  return of + word_text(heard.word, heard.of) + ", " +
         said_text(heard.said_in, heard.heard_in, heard.forged, heard.replayed) + ", " + truth(at, heard, earlier);
}

void Account::describe_knowledge(std::size_t step, std::vector<std::string>& told, Steps& earlier) const {
  const std::vector<std::size_t> whos = changing(step);
  for (const std::size_t who : whos)
    for (const Heard& each : moment(step).heard)
      if (each.who == who && !(each.ever && each.heard_in == step))
        told.push_back(chart_->names[who] + ": " + known(step, each, earlier) + ".");
  for (std::size_t of = 0; of < chart_->names.size(); ++of) {
    if (std::any_of(whos.begin(), whos.end(),
                    [&](std::size_t who) { return who == of || heard(step, who, of) != nullptr; }))
      continue;
    told.push_back(chart_->names[whos.front()] + " does not hear " + chart_->names[of] + ", which is " +
                   says(step, of) + " " + since_text(since(step, of)) + ".");
    earlier.insert(since(step, of));
  }
}

void Account::describe_query(std::vector<std::string>& told) const {
  std::vector<std::string> calls;
  for (std::size_t i = 0; i < chart_->steps.size(); ++i)
    if (const ActionKind kind = chart_->steps[i].action.kind; kind == ActionKind::call || kind == ActionKind::finish)
      calls.push_back(chart_->steps[i].sentence + " (step " + std::to_string(i + 1) + ")");
  told.push_back(calls.empty() ? "Nothing is asked for after the beginning." : "Asked for: " + listed(calls) + ".");
}

void Account::describe_deadlock(std::vector<std::string>& told, Steps& earlier) const {
  const std::size_t end = chart_->steps.size();
  for (std::size_t who = 0; who < chart_->names.size(); ++who) {
    const std::size_t began = since(end, who);
    std::string text = chart_->names[who] + (moment(end).says[who] ? " waits: it is " : " is ") + says(end, who) + " " +
                       since_text(began);
    for (const Heard& each : moment(end).heard)
      if (each.who == who) text += "; " + known(end, each, earlier);
    told.push_back(text + ".");
    earlier.insert(began);
  }
  told.emplace_back("Whatever is still published and heard changes nothing of that, so it stays so for ever.");
}

void Account::describe_cycle(std::vector<std::string>& told, Steps& earlier) const {
  const std::size_t end = chart_->steps.size();
  const std::size_t begin = end - chart_->cycle;
  for (std::size_t step = begin + 1; step <= end; ++step)
    if (chart_->steps[step - 1].states != (step == 1 ? chart_->states : chart_->steps[step - 2].states))
      told.push_back(change(step, earlier));
  for (const Heard& each : moment(begin).heard) {
    bool stays = true;
    for (std::size_t at = begin + 1; at <= end; ++at) {
      const Heard* const then = heard(at, each.who, each.of);
      stays = stays && then != nullptr && then->ever == each.ever && then->word == each.word;
    }
    if (stays) told.push_back("All the while, of " + chart_->names[each.who] + ": " + known(end, each, earlier) + ".");
  }
  told.push_back("So steps " + std::to_string(begin + 1) + " to " + std::to_string(end) + " come again and again.");
  while (!earlier.empty() && *earlier.rbegin() > begin) earlier.erase(*earlier.rbegin());  // told already
}

std::vector<std::string> Account::why(Property property) const {
  std::vector<std::string> told;
  Steps earlier;
  std::size_t from = chart_->steps.size() + 1;
  const Ending how = ending(property);
  if (how == Ending::violation) {
    from = chart_->steps.size();
    told.push_back(change(from, earlier));
    describe_knowledge(from, told, earlier);
  } else {
    describe_query(told);
    how == Ending::cycle ? describe_cycle(told, earlier) : describe_deadlock(told, earlier);
  }
  // What that refers to, backwards.
  while (!earlier.empty()) {
    const std::size_t step = *earlier.rbegin();
    earlier.erase(step);
    if (step != 0 && step < from) {
      told.push_back(change(step, earlier));
      from = step;
    }
  }
  return told;
}

}  // namespace takt::explore
