// SPDX-License-Identifier: Apache-2.0
// What the digest of a whole run covers beyond its frames: transitions, words and what the script does. Its frames:
// tests/models/run_digest_test.cpp.
#include <set>

#include "scenario/programs/program_monitor.hpp"
#include "scenario/run/action_content.hpp"
#include "tests/simulation/scenario/support.hpp"

namespace takt::scenario {
namespace {

using namespace test;

// At and above the rate of the link what arrives, and when, is the same: the frames of `hi` one after the other. Only
// production differs.
TEST(RunDigest, StarvedStreamsDifferByWhatWasProduced) {
  std::set<std::uint64_t> digests;
  std::set<std::uint64_t> delivered;
  for (const char* const every : {"117us", "110us", "100us"}) {
    json::Diagnostics diagnostics;
    const auto resolved = load_file(std::string(TAKT_SOURCE_DIR) + "/tests/findings/starved-stream.json",
                                    {std::string("/streams/0/every=") + every}, diagnostics);
    ASSERT_TRUE(resolved) << diagnostics.to_text();
    LiveRun run(*resolved);
    run.advance();
    digests.insert(run.simulation().digest().value());
    delivered.insert(run.network().traffic().stream(models::StreamIndex{0}).delivered);
    EXPECT_EQ(digest_of(*resolved, 7), run.simulation().digest().value());
  }
  EXPECT_EQ(delivered.size(), 1u);
  EXPECT_EQ(digests.size(), 3u);
}

std::uint64_t digest_of_step(std::uint8_t transition, handshake::PublishedState to, handshake::Word word,
                             std::int64_t at = 0) {
  sim::Simulation simulation(1);
  simulation.run(sim::TrueTime::from_ps(at));
  Observations observations;
  observations.watch(simulation);
  ProgramMonitor monitor(simulation, observations, 0, handshake::Variant::robust, 2, {});
  handshake::Outputs outputs;
  outputs.change_count = 1;
  outputs.change[0] = {transition, handshake::PublishedState::Halted, to};
  word.state = to;
  monitor.on_step(0, outputs, word);
  simulation.run(sim::TrueTime::from_ps(at));  // to the end of the instant
  return simulation.digest().value();
}

TEST(RunDigest, CoversTransitionsAndWords) {
  using handshake::PublishedState;
  const handshake::Word plain;
  handshake::Word other_run = plain, other_number = plain, other_origin = plain, other_kind = plain, other_life = plain,
                  other_intent_run = plain;
  other_run.run = 1;
  other_number.intent.number = 1;
  other_origin.intent.origin = 1;
  other_kind.intent.kind = handshake::IntentKind::Start;
  other_intent_run.intent.run = 1;
  other_life.incarnation = 1;
  std::set<std::uint64_t> digests;
  digests.insert(digest_of_step(1, PublishedState::Ready, plain));
  digests.insert(digest_of_step(2, PublishedState::Ready, plain));
  digests.insert(digest_of_step(1, PublishedState::HaltedInit, plain));
  digests.insert(digest_of_step(1, PublishedState::Ready, plain, 1));
  for (const handshake::Word& word : {other_run, other_number, other_origin, other_kind, other_intent_run, other_life})
    digests.insert(digest_of_step(1, PublishedState::Ready, word));
  EXPECT_EQ(digests.size(), 10u);
}

// A link that fails where nobody sends, another one, later, or not at all.
TEST(RunDigest, CoversFaultsThatNoFrameNotices) {
  std::set<std::uint64_t> digests;
  for (const char* const faults :
       {R"([])", R"([{"kind": "link-down", "link": ["a", "sw"], "at": "1ms", "for": "1ms"}])",
        R"([{"kind": "link-down", "link": ["b", "sw"], "at": "1ms", "for": "1ms"}])",
        R"([{"kind": "link-down", "link": ["a", "sw"], "at": "1ms", "for": "2ms"}])"})
    digests.insert(digest_of(*sound(over_one_switch(std::string(R"(, "faults": )") + faults))));
  EXPECT_EQ(digests.size(), 4u);
}

TEST(ActionContent, DiffersWhereActionsDiffer) {
  models::GateConfig gates;
  gates.admin_control_list = {{models::GateOperation::set_gate_states, 1, sim::Duration::from_ps(1000)}};
  models::GateConfig later = gates, shorter = gates, closed = gates, longer_list = gates;
  later.admin_base_time = sim::LocalTime::from_ps(5);
  shorter.admin_cycle_time = sim::Duration::from_ps(5);
  closed.admin_control_list[0].gate_states = 0;
  longer_list.admin_control_list.push_back(gates.admin_control_list[0]);
  const models::NodeIndex n1{1};
  const models::AddressIndex a1{1};
  const sim::TrueTime at;
  const std::vector<ResolvedAction> actions = {
      {at, ResolvedGates{n1, 0, gates}},
      {at, ResolvedGates{n1, 1, gates}},
      {at, ResolvedGates{n1, 0, later}},
      {at, ResolvedGates{n1, 0, shorter}},
      {at, ResolvedGates{n1, 0, closed}},
      {at, ResolvedGates{n1, 0, longer_list}},
      {at, ResolvedRoutes{{{n1, 0, a1, {1}}}}},
      {at, ResolvedRoutes{{{n1, 0, a1, {2}}}}},
      {at, ResolvedRoutes{{{n1, 0, a1, {1, 2}}}}},
      {at, ResolvedRoutes{{{n1, 1, a1, {1}}}}},
      {at, ResolvedRoutes{{{n1, 0, a1, {1}}, {n1, 0, a1, {1}}}}},
      {at, ResolvedStuckGate{n1, 0, 1, true}},
      {at, ResolvedStuckGate{n1, 0, 1, false}},
      {at, ResolvedStuckGate{n1, 0, 1, std::nullopt}},
      {at, ResolvedStuckGate{n1, 0, 2, true}},
      {at, ResolvedClockFault{n1, sim::Duration::from_ps(1), std::nullopt}},
      {at, ResolvedClockFault{n1, std::nullopt, sim::FrequencyOffset{1}}},
      {at, ResolvedClockFault{n1, sim::Duration::from_ps(2), std::nullopt}},
      {at, ResolvedBypass{n1, true}},
      {at, ResolvedBypass{n1, false}},
  };
  std::set<std::uint64_t> contents;
  for (const ResolvedAction& action : actions) contents.insert(content_of(action));
  EXPECT_EQ(contents.size(), actions.size());
}

}  // namespace
}  // namespace takt::scenario
