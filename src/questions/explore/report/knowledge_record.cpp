// SPDX-License-Identifier: Apache-2.0
#include "explore/report/knowledge.hpp"
#include "json/record.hpp"

namespace takt::explore {

const json::Record& describe(json::Type<Belief>) {
  static constexpr json::Output outputs[] = {
      json::output<&Belief::who>("who", "Who knows it."),
      json::output<&Belief::of>("of", "Of whom."),
      json::output<&Belief::heard>(
          "heard", "The state that the last word said; null: nothing was ever heard (which counts as Halted)."),
      json::output<&Belief::word>("word", "All that it said: with `robust` also intent and run."),
      json::output<&Belief::said_in>("said_in", "The step in which it was published; 0: before the first one."),
      json::output<&Belief::heard_in>("heard_in", "The step in which it was heard last; 0: before the first one."),
      json::output<&Belief::age>("age", "Steps since it was said."),
      json::output<&Belief::by_stranger>("by_stranger", "A stranger has said it, in the name of the other one."),
      json::output<&Belief::is_replayed>(
          "is_replayed", "The other one has said it in that step, but it was heard of a stranger, who replayed it."),
      json::output<&Belief::is_true>("is_true", "The other one would say the same now."),
      json::output<&Belief::now>(
          "now", "What it would say now, or `down`; of a candidate `without a role (joins)` or `(away)`."),
      json::output<&Belief::now_since>("now_since", "The step since which it would say so; 0: since the beginning."),
      json::output<&Belief::is_new>("is_new", "Another word than before the step, or no more as true as before."),
      json::output<&Belief::is_cause>("is_cause", "Of the one whose step violates, in that step: what it knew."),
  };
  static constexpr json::Record record{"belief", "What one participant knows of another one.", outputs};
  return record;
}

const json::Record& describe(json::Type<ExplainedStep>) {
  static constexpr json::Output outputs[] = {
      json::output<&ExplainedStep::number>("step", "From 1."),
      json::output<&ExplainedStep::sentence>("sentence", "What happens."),
      json::output<&ExplainedStep::kind>("kind",
                                         "`send`, `receive`, `deliver_late`, `initialised`, `silence`; "
                                         "of the adversary `call`, `finish`, `join`, `leave`, `change_key`, `lose`, "
                                         "`duplicate`, `reorder`, `crash`, `restart`, `timeout`, `forge`, `replay`."),
      json::output<&ExplainedStep::who>("who", "Who takes the step, or whose message it is."),
      json::output<&ExplainedStep::arrow>("arrow", "Of what is heard: from whom, and who hears it. Else empty."),
      json::output<&ExplainedStep::states>("states", "Of all, after it.", {.keys = "participant"}),
      json::output<&ExplainedStep::knowledge>("knowledge", "Of all who are up, of each whom they hear, after it."),
      json::output<&ExplainedStep::findings>("findings", "What is violated by it."),
  };
  static constexpr json::Record record{"explained_step", "One step of a run that violates something.", outputs};
  return record;
}

const json::Record& describe(json::Type<Explanation>) {
  static constexpr json::Output outputs[] = {
      json::output<&Explanation::property>("property", "Which is violated."),
      json::output<&Explanation::text>("text", "What it demands."),
      json::output<&Explanation::ends>("ends",
                                       "`violation` by the last step; `standstill`: nothing changes any more; `cycle`: "
                                       "the last steps repeat for ever."),
      json::output<&Explanation::beginning>("beginning", "How the run begins."),
      json::output<&Explanation::participants>("participants", "In the order of the chart."),
      json::output<&Explanation::states>("states", "Of all, at the beginning.", {.keys = "participant"}),
      json::output<&Explanation::knowledge>("knowledge", "At the beginning."),
      json::output<&Explanation::steps>("steps", "After it."),
      json::output<&Explanation::cycle>("cycle", "The last so many steps repeat for ever; 0: none."),
      json::output<&Explanation::why>(
          "why",
          "Sentences: who did the last step by which knowledge, and what had led to it; or what each waits for."),
  };
  static constexpr json::Record record{"explained_violation",
                                       "A shortest run that violates a property, and who knew what when.", outputs};
  return record;
}

json::Node explanations_json(const Query& query, const SearchResult& result) {
  return json::ShapeOf<std::vector<Explanation>>::write(explanations(query, result));
}

}  // namespace takt::explore
