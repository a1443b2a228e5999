// SPDX-License-Identifier: Apache-2.0
#include "explore/report/knowledge.hpp"

#include <algorithm>

#include "explore/report/account.hpp"

namespace takt::explore {

Explanation explanation(const Chart& chart, Property property) {
  const Account account(chart);
  const Ending ending = account.ending(property);
  Explanation made;
  made.property = name_of(property);
  made.text = property_texts[index_of(property)];
  made.ends = ending == Ending::violation ? "violation" : ending == Ending::cycle ? "cycle" : "standstill";
  made.beginning = chart.beginning;
  made.participants = chart.names;
  made.cycle = chart.cycle;
  const auto states_at = [&](const std::vector<std::string>& states) {
    std::vector<std::pair<std::string, std::string>> named;
    for (std::size_t i = 0; i < states.size(); ++i) named.emplace_back(chart.names[i], states[i]);
    return named;
  };
  made.states = states_at(chart.states);
  made.knowledge = account.beliefs(0, std::nullopt);
  for (std::size_t number = 1; number <= chart.steps.size(); ++number) {
    const ChartStep& step = chart.steps[number - 1];
    ExplainedStep& explained = made.steps.emplace_back();
    explained.number = number;
    explained.sentence = step.sentence;
    explained.kind = name_of(step.action.kind);
    explained.who = chart.names[step.actor];
    if (step.arrow) explained.arrow = {chart.names[step.arrow->first], chart.names[step.arrow->second]};
    explained.states = states_at(step.states);
    const bool violates = ending == Ending::violation && number == chart.steps.size();
    explained.knowledge = account.beliefs(number, violates ? std::optional(account.doer(number)) : std::nullopt);
    explained.findings = step.findings;
  }
  made.why = account.why(property);
  return made;
}

namespace {

/// Calls told(property, trace) for each violation of a result, in the order of the report.
template <class Told>
void each_violation(const SearchResult& result, Told&& told) {
  for (std::size_t p = 0; p < property_count; ++p)
    if (result.verdicts[p] == PropertyVerdict::violated && result.traces[p])
      told(static_cast<Property>(p), *result.traces[p]);
  const std::optional<Trace>& first = result.traces[index_of(Property::L1)];
  if (result.livelock && first && first->cycle == 0) told(Property::L1, *result.livelock);
}

}  // namespace

std::vector<Explanation> explanations(const Query& query, const SearchResult& result) {
  std::vector<Explanation> all;
  each_violation(result, [&](Property property, const Trace& trace) {
    all.push_back(explanation(chart_of(query, result.beginnings[trace.beginning], trace), property));
  });
  return all;
}

Chart with_knowledge(Chart chart, const Explanation& explanation) {
  const auto say = [](const std::vector<Belief>& knowledge, bool all, std::vector<std::string>& notes) {
    for (const Belief& each : knowledge)
      if (all || each.is_new || each.is_cause) notes.push_back("  " + text_of(each));
  };
  const bool all_true = std::all_of(explanation.knowledge.begin(), explanation.knowledge.end(),
                                    [](const Belief& each) { return each.is_true == true; });
  if (all_true && !explanation.knowledge.empty())
    chart.notes.emplace_back("  each takes those whom it hears for what they are");
  else
    say(explanation.knowledge, true, chart.notes);
  for (std::size_t i = 0; i < chart.steps.size(); ++i) say(explanation.steps[i].knowledge, false, chart.steps[i].notes);
  return chart;
}

std::string why_text(const Explanation& explanation) {
  std::string text = "      Why:\n";
  for (const std::string& sentence : explanation.why) text += "      - " + sentence + "\n";
  return text;
}

}  // namespace takt::explore
