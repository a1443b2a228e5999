// SPDX-License-Identifier: Apache-2.0
// Who knew what when: two counter-examples of the paper word by word, and everything that is said held against the
// models.
#include <gtest/gtest.h>

#include <algorithm>
#include <concepts>
#include <string>
#include <vector>

#include "../ask.hpp"
#include "explore/model/group_model.hpp"
#include "explore/model/roles_model.hpp"
#include "explore/model/tree_model.hpp"
#include "explore/report/account.hpp"

namespace takt::explore {
namespace {

Query paper(std::uint8_t slaves, std::uint32_t commands, std::initializer_list<Fault> faults = {},
            bool finishes = false) {
  Query query;
  query.variant = handshake::Variant::paper;
  query.slaves = slaves;
  query.finishes = finishes;
  return with(query, commands, faults);
}

const Explanation& of(const std::vector<Explanation>& all, std::string_view property, std::string_view ends) {
  const auto found = std::find_if(
      all.begin(), all.end(), [&](const Explanation& each) { return each.property == property && each.ends == ends; });
  EXPECT_NE(found, all.end()) << property;
  return *found;
}

// The master resets and starts before the slave hears of it: what it knows of the slave is true, and it runs all the
// same.
TEST(Knowledge, AStartThatOvertakesAReset) {
  const Query query = paper(1, 4);
  const SearchResult result = ask(query);
  const Trace& trace = *result.traces[index_of(Property::S1)];
  const Chart chart = chart_of(query, result.beginnings[trace.beginning], trace);
  const Explanation explained = explanation(chart, Property::S1);
  EXPECT_EQ(drawn(with_knowledge(chart, explained)) + why_text(explained),
            R"(      master       slave 1
      Suspended    Suspended    at the beginning: Suspended
      |            |              each takes those whom it hears for what they are
   1  *            |            Reset is called at the master
      Ready        Suspended
      |            |              slave 1 takes master for Suspended, heard before the first step; it is Ready since step 1
   2  *            |            Start is called at the master
      Running      Suspended
      |            |              master takes slave 1 for Suspended, heard before the first step; so it is
      |            |            violates S1: master is Running in a run in which not all have been Ready
      |            |            violates S2: master is master and Running before all slaves have been Running
      Why:
      - Step 2: master becomes Running (was Ready since step 1): Start is called at the master.
      - master: all that it knows of slave 1: Suspended, heard before the first step, and so slave 1 still is.
      - Step 1: master becomes Ready (was Suspended since the beginning): Reset is called at the master.
)");
}

// A suspend and a resume that cross: each follows what the other one was.
TEST(Knowledge, ALivelock) {
  const Query query = paper(1, 4);
  const std::vector<Explanation> all = explanations(query, ask(query));
  EXPECT_EQ(why_text(of(all, "L1", "cycle")),
            R"(      Why:
      - Asked for: Suspend is called at the master (step 1) and Resume is called at the master (step 4).
      - Step 7: master becomes Suspended (was Running since step 4): master hears slave 1: Suspended, said in step 5, and so slave 1 still is.
      - Step 8: slave 1 becomes Running (was Suspended since step 3): slave 1 hears master: Running, said in step 6, but master is Suspended by then, since step 7.
      - Step 11: master becomes Running (was Suspended since step 7): master hears slave 1: Running, said in step 9, and so slave 1 still is.
      - Step 12: slave 1 becomes Suspended (was Running since step 8): slave 1 hears master: Suspended, said in step 10, but master is Running by then, since step 11.
      - So steps 5 to 12 come again and again.
      - Step 4: master becomes Running (was Suspended since step 1): Resume is called at the master.
      - Step 3: slave 1 becomes Suspended (was Running since the beginning): slave 1 hears master: Suspended, said in step 2, and so master still is.
      - Step 1: master becomes Suspended (was Running since the beginning): Suspend is called at the master.
)");
}

// A halt and a start between two samples: what the slave knows is true again, and the master waits for a change that it
// has never heard of.
TEST(Knowledge, WhatWasMissed) {
  const Query query = paper(1, 4);
  const std::vector<Explanation> all = explanations(query, ask(query));
  const Explanation& explained = of(all, "L1", "standstill");
  ASSERT_GT(explained.why.size(), 3U);
  EXPECT_EQ(explained.why[2],
            "slave 1 waits: it is Ready since the beginning; all that it knows of master: Ready, heard before the "
            "first step, and so master is again; in between, unheard, it was Halted since step 1 and "
            "Halted.INIT since step 2.");
}

/// What a model says of a participant; null where none is up.
const Participant* participant_in(GroupModel& model, const State& state, std::size_t column) {
  const MemberId member = state.member(column);
  return model.members()[member].down ? nullptr : &model.members().value(member);
}
const Participant* participant_in(TreeModel& model, const State& state, std::size_t column) {
  return model.is_down(state, column) ? nullptr : &model.participant(state, column);
}
const Participant* participant_in(RolesModel& model, const State& state, std::size_t column) {
  return model.is_down(state, model.station_of(column)) ? nullptr : model.participant_at(state, column);
}

/// That is the last word of one of its peers; which one, says the place in a group.
bool remembers(const Participant& participant, const Heard& heard, bool is_group) {
  for (std::size_t peer = 0; peer < participant.peer_count(); ++peer) {
    const Participant::Known known = participant.known_of(peer);
    const bool is_paper = participant.config().variant == handshake::Variant::paper;
    if (is_group && participant.participant_of(peer) != heard.of) continue;
    if (known.state == heard.word.state && known.run == heard.word.run && known.incarnation == heard.word.incarnation &&
        (is_paper || known.heard == heard.ever))
      return true;
  }
  return false;
}

/// The moment is what the model's participants remember, and what is said of it follows from the chart.
void expect_sound(const Chart& chart, const std::vector<Moment>& moments, std::size_t at,
                  const std::vector<Belief>& beliefs) {
  const auto column = [&](const std::string& name) {
    return static_cast<std::size_t>(std::find(chart.names.begin(), chart.names.end(), name) - chart.names.begin());
  };
  const Moment& now = moments[at];
  ASSERT_EQ(beliefs.size(), now.heard.size());
  for (std::size_t i = 0; i < beliefs.size(); ++i) {
    const Belief& belief = beliefs[i];
    const Heard& heard = now.heard[i];
    SCOPED_TRACE(text_of(belief));
    ASSERT_EQ(belief.who, chart.names[heard.who]);
    ASSERT_EQ(belief.of, chart.names[heard.of]);
    const std::size_t of = column(belief.of);
    for (std::size_t m = belief.now_since; m <= at; ++m) EXPECT_EQ(moments[m].says[of], now.says[of]);
    if (belief.now_since > 0 && now.says[of]) {
      EXPECT_NE(moments[belief.now_since - 1].says[of], now.says[of]);
    }
    EXPECT_EQ(belief.heard.has_value(), heard.ever);
    if (!belief.heard) continue;
    ASSERT_LE(*belief.said_in, *belief.heard_in);
    ASSERT_LE(*belief.heard_in, at);
    EXPECT_EQ(*belief.age, at - *belief.said_in);
    EXPECT_EQ(*belief.is_true, now.says[of] == heard.word);
    if (*belief.heard_in > 0) {  // in that step it was heard, by the one of the other
      const ChartStep& step = chart.steps[*belief.heard_in - 1];
      ASSERT_TRUE(step.arrow.has_value());
      EXPECT_EQ(*step.arrow, std::pair(heard.of, heard.who));
      EXPECT_NE(step.sentence.find(": " + *belief.word), std::string::npos) << step.sentence;
    }
    if (*belief.said_in == 0) continue;
    const ChartStep& said = chart.steps[*belief.said_in - 1];
    EXPECT_EQ(said.action.kind == ActionKind::forge, belief.by_stranger);
    EXPECT_EQ(*belief.heard_in > 0 && chart.steps[*belief.heard_in - 1].action.kind == ActionKind::replay,
              belief.is_replayed);
    if (belief.by_stranger) continue;
    EXPECT_TRUE(said.action.kind == ActionKind::send || said.action.kind == ActionKind::reorder) << said.sentence;
    EXPECT_NE(said.sentence.find(belief.of), std::string::npos) << said.sentence;
    EXPECT_EQ(moments[*belief.said_in].says[of], heard.word) << "it said so because it was so";
  }
}

/// Beliefs that are true and that are not, and never heard, in all runs of a result.
struct Count {
  std::size_t runs = 0;
  std::size_t right = 0;
  std::size_t wrong = 0;
  std::size_t never = 0;
};

template <class M>
void expect_sound(const Query& query, Count& count) {
  SCOPED_TRACE(query_line(query));
  const SearchResult result = ask(query);
  for (std::size_t p = 0; p < property_count; ++p) {
    if (!result.traces[p]) continue;
    SCOPED_TRACE(property_names[p]);
    for (const Trace* const trace :
         {&*result.traces[p], p == index_of(Property::L1) && result.livelock ? &*result.livelock : nullptr}) {
      if (trace == nullptr) continue;
      const Chart chart = chart_of(query, result.beginnings[trace->beginning], *trace);
      const Explanation explained = explanation(chart, static_cast<Property>(p));
      EXPECT_FALSE(explained.why.empty());
      std::vector<Moment> moments{chart.moment};
      for (const ChartStep& step : chart.steps) moments.push_back(step.moment);
      M model(query);
      State state = model.beginnings()[trace->beginning].state;
      Next next;
      ++count.runs;
      for (std::size_t at = 0; at <= chart.steps.size(); ++at) {
        SCOPED_TRACE(at);
        if (at > 0) {
          ASSERT_TRUE(model.act(state, trace->actions[at - 1], next) || at == chart.steps.size());
          state = next.state;
        }
        for (std::size_t column = 0; column < chart.names.size(); ++column) {
          const Participant* const participant = participant_in(model, state, column);
          EXPECT_EQ(moments[at].says[column],
                    participant == nullptr ? std::nullopt : std::optional(participant->word()))
              << chart.names[column];
        }
        for (const Heard& heard : moments[at].heard)
          EXPECT_TRUE(remembers(*participant_in(model, state, heard.who), heard, std::same_as<M, GroupModel>));
        const std::vector<Belief>& beliefs = at == 0 ? explained.knowledge : explained.steps[at - 1].knowledge;
        expect_sound(chart, moments, at, beliefs);
        for (const Belief& each : beliefs) ++(!each.heard ? count.never : *each.is_true ? count.right : count.wrong);
        if (testing::Test::HasFailure()) return;
      }
    }
  }
}

TEST(Knowledge, IsWhatTheModelOfAGroupSays) {
  Count count;
  expect_sound<GroupModel>(paper(1, 4), count);
  expect_sound<GroupModel>(paper(2, 1), count);
  expect_sound<GroupModel>(paper(1, 2, {}, true), count);
  expect_sound<GroupModel>(
      paper(1, 1, {Fault::loss, Fault::duplicate, Fault::reorder, Fault::crash, Fault::restart, Fault::timeout}),
      count);
  expect_sound<GroupModel>(paper(1, 2, {Fault::reorder}), count);
  expect_sound<GroupModel>(paper(1, 2, {Fault::restart}), count);
  Query channels = paper(1, 2, {Fault::reorder, Fault::duplicate});
  channels.network = Network::channels;
  expect_sound<GroupModel>(channels, count);
  Query all_to_all = paper(2, 1);
  all_to_all.subscription = handshake::Subscription::all_to_all;
  expect_sound<GroupModel>(all_to_all, count);
  Query robust;
  expect_sound<GroupModel>(with(robust, 1, {{Fault::loss, Fault::crash, Fault::restart, Fault::timeout}}), count);
  expect_sound<GroupModel>(with(robust, 0, {{Fault::forge}}), count);
  Query replays = with(robust, 1, {{Fault::replay, Fault::restart, Fault::crash}});
  expect_sound<GroupModel>(replays, count);
  replays.fault_budget = 2;
  replays.commands = 0;
  expect_sound<GroupModel>(replays, count);
  replays.is_signed = true;
  replays.key_changes = 1;
  expect_sound<GroupModel>(replays, count);
  EXPECT_GT(count.runs, 100U);
  EXPECT_GT(count.right, 100U);
  EXPECT_GT(count.wrong, 100U);
}

TEST(Knowledge, IsWhatTheModelsOfTreesAndRolesSay) {
  Count count;
  Query tree;
  tree.inner_slaves = 1;
  expect_sound<TreeModel>(with(tree, 1, {{Fault::restart}}), count);
  expect_sound<TreeModel>(with(tree, 0, {{Fault::forge}}), count);
  tree.inner_slaves = 0;
  tree.joining = true;
  expect_sound<TreeModel>(with(tree, 1, {{Fault::crash, Fault::loss}}), count);
  Query roles;
  roles.candidates = 2;
  expect_sound<RolesModel>(with(roles, 1, {}), count);
  roles.candidates = 1;
  expect_sound<RolesModel>(with(roles, 1, {{Fault::crash, Fault::restart, Fault::timeout}}), count);
  roles.inner_slaves = 1;
  expect_sound<RolesModel>(with(roles, 1, {}), count);
  EXPECT_GT(count.runs, 50U);
  EXPECT_GT(count.right, 100U);
  EXPECT_GT(count.wrong, 100U);
  EXPECT_GT(count.never, 0U);
}

// A page steps through this.
TEST(Knowledge, AsJson) {
  const Query query = paper(1, 4);
  const json::Node all = explanations_json(query, ask(query));
  ASSERT_EQ(all.items.size(), 5U);  // S1, S2, S3, L1 and the livelock
  const std::string text = json::pretty(all.items.front());
  for (const char* part :
       {"\"property\": \"S1\"", "\"ends\": \"violation\"", "\"sentence\": \"Start is called at the master\"",
        "\"is_cause\": true", "\"said_in\": 0", "\"why\": [", "\"now\": \"Suspended\""})
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
}

}  // namespace
}  // namespace takt::explore
