// SPDX-License-Identifier: Apache-2.0
// Applications with threads: criteria, values, signals and gateways against numbers worked out by hand, over both
// protocols.
#include <cmath>

#include "application/opc_ua_topic.hpp"
#include "evaluation/evaluate.hpp"
#include "support.hpp"

namespace takt::scenario::test::applications_test {
namespace {

/// Two hosts on a wire; `threads` of the publisher on a, of the subscriber on b.
std::string pair(const std::string& topic, const std::string& publisher, const std::string& subscriber,
                 const std::string& more = "", const std::string& duration = "1s") {
  return R"({"name": "t", "duration": ")" + duration +
         R"(", "network": {"nodes": {"a": {"kind": "host"}, "b": {"kind": "host"}}, "links": [{"ends": ["a", "b"], "delay": "100ns"}]},
 "topics": [{"name": "x", "fields": {"level": "UInt32"}, )" +
         topic + R"(}],
 "applications": [{"name": "p", "on": "a", "threads": [{"name": "publish", "publish": "x", )" +
         publisher + R"(}]},
                  {"name": "s", "on": "b", "threads": [{"name": "subscribe", "subscribe": "x", )" +
         subscriber + R"(}]}])" + more + "}";
}
const std::string opc_ua = R"("protocol": "opc-ua")";

results::RunResult result_of(const std::string& text) {
  const auto resolved = sound(text);
  LiveRun run(*resolved);
  run.advance();
  return evaluation::evaluate(run, false);
}

/// An application that publishes x and takes what comes back as y, and one that copies; `there` are the fields of what
/// it subscribes with.
std::string there_and_back(const std::string& back, const std::string& payload = R"("counter")") {
  return R"({"name": "t", "duration": "1s", "network": {"nodes": {"a": {"kind": "host"}, "b": {"kind": "host"}}, "links": [{"ends": ["a", "b"], "delay": "100ns"}]},
 "topics": [{"name": "x", "protocol": "opc-ua", "fields": {"level": "UInt32"}}, {"name": "y", "protocol": "opc-ua", "fields": {"level": "UInt32"}}],
 "applications": [{"name": "p", "on": "a", "threads": [{"name": "out", "publish": "x", "every": "1ms", "payload": )" +
         payload + R"(},
                                                       {"name": "back", "subscribe": "y", "every": "1ms", )" +
         back + R"(}]},
                  {"name": "s", "on": "b", "threads": [{"name": "in", "subscribe": "x", "every": "1ms", "offset": "300us"},
                                                       {"name": "again", "publish": "y", "every": "1ms", "offset": "500us", "payload": {"copy_of": "x"}}]}]})";
}

// Out at 0, taken at 300 us, sent again at 500 us, back at 800 us; the value of 999 ms comes back at the end of the
// run.
TEST(Applications, ARoundTripIsFromTheCallThatPublishesToTheCallThatTakesItBack) {
  const results::RunResult result = result_of(there_and_back(R"("offset": "800us", "round_trip": "x")"));
  const results::ThreadResult& back = result.applications[0].threads[1];
  ASSERT_TRUE(back.round_trip);
  EXPECT_EQ(back.round_trip->count, 1000u);
  EXPECT_EQ(back.round_trip->min.ps(), 800'000'000);
  EXPECT_EQ(back.round_trip->max.ps(), 800'000'000);
}

// At 400 us nothing of this cycle is there yet: what went out a cycle before comes back.
TEST(Applications, ARoundTripThatMissesItsCycle) {
  const results::RunResult result = result_of(there_and_back(R"("offset": "400us", "round_trip": "x")"));
  EXPECT_EQ(result.applications[0].threads[1].round_trip->min.ps(), 1'400'000'000);
  EXPECT_EQ(result.applications[0].threads[1].round_trip->max.ps(), 1'400'000'000);
}

TEST(Applications, RoundTripsThatCannotBe) {
  const auto complains = [](const std::string& text, const std::string& what) {
    return load(text).diagnostics.to_text().find(what) != std::string::npos;
  };
  EXPECT_TRUE(complains(there_and_back(R"("round_trip": "z")"),
                        "/applications/0/threads/1/round_trip: a round trip of what is not sent"));
  EXPECT_TRUE(complains(there_and_back(R"("round_trip": "x")", R"("alternate")"),
                        "/applications/0/threads/1/round_trip: a round trip of values that repeat"));
}

TEST(Applications, EveryActivationThatEndsInTimeIsACall) {
  const results::RunResult result =
      result_of(pair(opc_ua, R"("every": "1ms", "response": "100us")", R"("every": "1ms", "offset": "500us")"));
  const results::ThreadResult& publish = result.applications[0].threads[0];
  EXPECT_EQ(publish.activations, 1000u);  // the one that is due at 1 s is open
  EXPECT_EQ(publish.missed, 0u);
  EXPECT_EQ(publish.response->min.ps(), 100'000'000);
  EXPECT_EQ(publish.response->max.ps(), 100'000'000);
  EXPECT_EQ(publish.calls.tests, 100u);
  EXPECT_EQ(publish.calls.expected, 1000u);
  EXPECT_EQ(publish.calls.counted, 1000u);
  EXPECT_EQ(publish.published, 1000u);
  const results::ThreadResult& subscribe = result.applications[1].threads[0];
  EXPECT_EQ(subscribe.calls.tests, 99u);  // windows begin half a millisecond later
  EXPECT_EQ(subscribe.buffered, 1000u);
  EXPECT_EQ(*subscribe.values->percent, 100.0);
  EXPECT_EQ(subscribe.lost + subscribe.overwritten, 0u);
}

TEST(Applications, AResponseOfAnIntervalMissesAll) {
  const results::RunResult result =
      result_of(pair(opc_ua, R"("every": "1ms", "response": "1ms")", R"("every": "1ms")"));
  const results::ThreadResult& publish = result.applications[0].threads[0];
  EXPECT_EQ(publish.activations, 1000u);
  EXPECT_EQ(publish.missed, 1000u);
  EXPECT_EQ(*publish.calls.percent, 0.0);
  EXPECT_FALSE(publish.response);
  EXPECT_EQ(result.streams[0].sent, 0u);
}

// P(response < interval) = 1 - exp(-(T/scale)^shape); 100 000 draws, so that four standard deviations are 0.6 %.
TEST(Applications, SuccessIsTheLawAtTheInterval) {
  const results::RunResult result =
      result_of(pair(opc_ua, R"("every": "1ms", "response": {"weibull": {"scale": "1.2ms", "shape": 0.8}})",
                     R"("every": "1ms")", "", "100s"));
  const double wanted = 100 * (1 - std::exp(-std::pow(1 / 1.2, 0.8)));
  EXPECT_NEAR(*result.applications[0].threads[0].calls.percent, wanted, 0.62);
}

// A call belongs to the window of the activation that it answers, also where the scheduler looks when the next one has
// been answered already.
TEST(Applications, ALateSchedulerMovesNothingIntoOtherWindows) {
  const auto published = [](const std::string& scheduler) {
    std::string text = pair(opc_ua, R"("every": "1ms", "response": "100us")",
                            R"("every": "1ms", "offset": "500us", "response": "100us")");
    for (const std::string on : {R"("on": "a", )", R"("on": "b", )"})
      text.replace(text.find(on), on.size(), on + R"("scheduler": )" + scheduler + ", ");
    return result_of(text);
  };
  const results::RunResult late =
      published(R"({"response": {"uniform": {"from": "0s", "to": "900us"}}, "tolerance": "1ms"})");
  const results::RunResult in_time = published("{}");
  for (std::size_t a = 0; a < 2; ++a) {
    const results::CriterionResult& calls = late.applications[a].threads[0].calls;
    EXPECT_EQ(calls.tests, in_time.applications[a].threads[0].calls.tests);
    EXPECT_EQ(*calls.percent, 100.0);
    EXPECT_EQ(calls.windows_below + calls.windows_above + calls.discarded, 0u);
  }
  // Each look is later than the tolerance: the scheduler itself was not let run.
  const results::CriterionResult none =
      published(R"({"response": "2ms", "tolerance": "1ms"})").applications[0].threads[0].calls;
  EXPECT_EQ(none.tests, 0u);
  EXPECT_EQ(none.discarded, 100u);
}

TEST(Applications, ABufferKeepsTheNewest) {
  // Ten values come between two calls; two of them find room.
  const results::RunResult result =
      result_of(pair(opc_ua, R"("every": "1ms", "response": "1us")", R"("every": "10ms", "buffer": 2)"));
  const results::ThreadResult& subscribe = result.applications[1].threads[0];
  EXPECT_EQ(subscribe.arrived, 990u + 10u);  // the call at 1 s finds the last ten
  EXPECT_EQ(subscribe.buffered, 200u);
  EXPECT_EQ(subscribe.overwritten, 800u);
  EXPECT_EQ(subscribe.values->expected, subscribe.values->tests * 10);
}

TEST(Applications, ASignalIsAsRegularAsItsThread) {
  const results::RunResult result =
      result_of(pair(opc_ua, R"("every": "10ms", "payload": "alternate", "response": "1ms")",
                     R"("every": "10ms", "offset": "5ms", "signal": "out", "response": "1ms")"));
  ASSERT_EQ(result.signals.size(), 1u);
  EXPECT_EQ(result.signals[0].nominal.ps(), 10'000'000'000);
  EXPECT_EQ(result.signals[0].pulses->count, 50u);
  EXPECT_EQ(result.signals[0].pulses->min.ps(), 10'000'000'000);
  EXPECT_EQ(result.signals[0].pulses->max.ps(), 10'000'000'000);
  EXPECT_EQ(result.signals[0].periods->max.ps(), 20'000'000'000);
  EXPECT_EQ(result.signals[0].irregular_pulses, 0u);
  EXPECT_EQ(result.signals[0].edges.front().first.since_start().ps(), 6'000'000'000);
}

results::Verdict verdict_of(const std::string& text) { return result_of(text).requirements.at(0).verdict; }

// A response of an interval misses all, one of less none; a thread that is first due after the end has done nothing,
// which is no success.
TEST(Applications, SuccessIsJudgedByThread) {
  using results::Verdict;
  const auto published = [](const std::string& thread, const std::string& of = "", const std::string& duration = "1s") {
    return pair(opc_ua + R"(}, {"name": "y", "fields": {"level": "UInt32"}, )" + opc_ua, R"("every": "1ms")" + thread,
                R"("every": "1ms"}, {"name": "other", "subscribe": "y", "every": "1ms")",
                R"(, "require": [{"application": "p", "success": 100)" + of + "}]", duration);
  };
  EXPECT_EQ(verdict_of(published("")), Verdict::pass);
  EXPECT_EQ(verdict_of(published(R"(, "response": "1ms")")), Verdict::fail);
  EXPECT_EQ(verdict_of(published(R"(, "offset": "999us")", "", "500us")), Verdict::fail);
  // The other thread of the application misses all.
  const std::string two = R"(}, {"name": "slow", "publish": "y", "every": "1ms", "response": "1ms")";
  const results::RunResult all = result_of(published(two));
  ASSERT_EQ(all.requirements.size(), 2u);
  EXPECT_EQ(all.requirements[0].verdict, Verdict::pass);
  EXPECT_EQ(all.requirements[1].verdict, Verdict::fail);
  EXPECT_EQ(result_of(published(two, R"(, "thread": "publish")")).verdict, Verdict::pass);
}

// Pulses of 10 ms whose ends are up to 8 ms late: few of them are within a tenth. In 5 ms there is none.
TEST(Applications, RegularityIsJudged) {
  using results::Verdict;
  const auto with = [](const std::string& response, const std::string& duration = "1s") {
    return verdict_of(pair(opc_ua, R"("every": "10ms", "payload": "alternate", "response": "1ms")",
                           R"("every": "10ms", "offset": "5ms", "signal": "out", "response": )" + response,
                           R"(, "require": [{"signal": "out", "irregular": 1}])", duration));
  };
  EXPECT_EQ(with("\"1ms\""), Verdict::pass);
  EXPECT_EQ(with(R"({"uniform": {"from": "0s", "to": "8ms"}})"), Verdict::fail);
  EXPECT_EQ(with("\"1ms\"", "5ms"), Verdict::fail);
}

TEST(Applications, ACrashEndsTestsAndTheApplicationBeginsAnew) {
  const std::string faults = R"(, "faults": [{"kind": "crash", "at": "205ms", "for": "100ms", "node": "a"}])";
  const results::RunResult result =
      result_of(pair(opc_ua, R"("every": "1ms", "response": "1us")", R"("every": "1ms", "offset": "500us")", faults));
  const results::ThreadResult& publish = result.applications[0].threads[0];
  EXPECT_EQ(publish.activations,
            206u + 695u - 1u);  // 0 to 204 ms, and from 305 ms on; the one at 205 ms falls with the host
  EXPECT_EQ(publish.missed, 0u);
  EXPECT_EQ(publish.calls.discarded, 1u);
  EXPECT_EQ(publish.calls.tests, 20u + 69u);
  EXPECT_EQ(*publish.calls.percent, 100.0);
}

TEST(Applications, ReliableDdsDeliversEverySample) {
  const std::string loss =
      R"(, "faults": [{"kind": "frame-errors", "at": "100ms", "for": "500ms", "link": ["a", "b"], "loss": 0.1}])";
  const results::RunResult result =
      result_of(pair(R"("protocol": "dds", "qos": {"reliability": "reliable", "history": "keep-all"})",
                     R"("every": "5ms")", R"("every": "5ms", "offset": "2ms", "buffer": 1000)", loss, "20s"));
  const results::ThreadResult& subscribe = result.applications[1].threads[0];
  EXPECT_EQ(result.applications[0].participants[0].matches, 1u);
  EXPECT_GT(result.applications[0].participants[0].resent, 0u);
  EXPECT_EQ(subscribe.lost, 0u);
  // What was written before the match reaches nobody, and what was written last may be under way.
  EXPECT_GE(subscribe.arrived + 8, result.applications[0].threads[0].published);
}

TEST(Applications, QualitiesOfServiceThatDoNotMatchAreTold) {
  const results::RunResult result = result_of(
      pair(R"("protocol": "dds")", R"("every": "5ms")", R"("every": "5ms", "qos": {"reliability": "reliable"})"));
  ASSERT_EQ(result.applications[1].participants[0].incompatible.size(), 1u);
  EXPECT_NE(result.applications[1].participants[0].incompatible[0].find("reliability"), std::string::npos);
  EXPECT_EQ(result.applications[1].threads[0].arrived, 0u);
}

TEST(Applications, AGatewayForwardsWhatItReceives) {
  const std::string text =
      R"({"name": "t", "duration": "2s", "network": {"nodes": {"a": {"kind": "host"}, "g": {"kind": "host"}, "b": {"kind": "host"}, "w": {"kind": "switch"}},
 "links": [{"ends": ["a", "w"]}, {"ends": ["g", "w"]}, {"ends": ["b", "w"]}]},
 "topics": [{"name": "x", "protocol": "opc-ua", "fields": {"level": "UInt32"}}, {"name": "y", "protocol": "dds", "fields": {"level": "UInt32"}}],
 "applications": [{"name": "p", "on": "a", "threads": [{"name": "publish", "publish": "x", "every": "10ms"}]},
                  {"name": "s", "on": "b", "threads": [{"name": "subscribe", "subscribe": "y", "every": "10ms", "offset": "6ms"}]}],
 "gateways": [{"name": "gw", "on": "g", "from": "x", "to": "y", "receive_every": "10ms", "receive_offset": "2ms", "send_every": "20ms", "send_offset": "4ms", "buffer": 3}]})";
  const results::RunResult result = result_of(text);
  const results::BufferResult& buffer = *result.applications[2].buffer;
  EXPECT_EQ(buffer.received, 200u);
  EXPECT_EQ(buffer.forwarded, 100u);                // every other one is sent
  EXPECT_EQ(buffer.overwritten, 200u - 100u - 3u);  // three wait at the end: the last comes after the last send
  EXPECT_EQ(result.applications[2].threads[1].published, 100u);
  EXPECT_GT(result.applications[1].threads[0].arrived, 90u);
}

struct Bad {
  const char* what;
  std::string text;
  std::string said;
};
TEST(Applications, MistakesAreNamed) {
  const Bad cases[] = {
      {"topic", pair(opc_ua + R"(, "qos": {}, "domain": 1)", R"("every": "1ms")", R"("every": "1ms")"),
       "does not belong to OPC UA"},
      {"offset", pair(opc_ua, R"("every": "1ms", "offset": "1ms")", R"("every": "1ms")"),
       "an offset beyond the interval"},
      {"payload", pair(opc_ua, R"("every": "1ms", "buffer": 2)", R"("every": "1ms")"),
       "does not belong to this thread"},
      {"copy", pair(opc_ua, R"("every": "1ms", "payload": {"copy_of": "y"})", R"("every": "1ms")"),
       "a copy of what is not there"},
      {"requirement",
       pair(opc_ua, R"("every": "1ms")", R"("every": "1ms")", R"(, "require": [{"application": "q", "success": 1}])"),
       "unknown application"},
      {"signal",
       pair(opc_ua, R"("every": "1ms")", R"("every": "1ms")", R"(, "require": [{"signal": "q", "irregular": 1}])"),
       "unknown signal"},
      {"flow",
       pair(R"("protocol": "dds", "flow_control": {"octets": 1000, "every": "1ms"})", R"("every": "1ms")",
            R"("every": "1ms")"),
       "flow control of synchronous publication"},
      {"server",
       pair(R"("protocol": "dds")", R"("every": "1ms")", R"("every": "1ms")",
            R"(, "domains": [{"id": 0, "discovery": "server", "server": "q"}])"),
       "a server that is not in the domain"},
      {"depth",
       pair(R"("protocol": "dds", "qos": {"depth": 5, "resource_limits": {"max_samples_per_instance": 2}})",
            R"("every": "1ms")", R"("every": "1ms")"),
       "quality of service that cannot be"},
      {"delta", pair(opc_ua + R"(, "uadp": {"key_frame_count": 3})", R"("every": "1ms")", R"("every": "1ms")"),
       "no delta frames"},
      {"layout", pair(R"("protocol": "dds", "uadp": {})", R"("every": "1ms")", R"("every": "1ms")"), "not of DDS"},
      {"values",
       pair(opc_ua, R"("every": "1ms", "payload": {"pattern": "counter", "values": {"level": "3"}})",
            R"("every": "1ms")"),
       "a value of another type"},
      {"id",
       pair(opc_ua + R"(, "publisher_id": 3, "uadp": {"publisher": {"byte": 3}})", R"("every": "1ms")",
            R"("every": "1ms")"),
       "a PublisherId that is not sent"},
  };
  for (const Bad& bad : cases) {
    json::Diagnostics diagnostics;
    EXPECT_EQ(load_text(bad.text, "t.json", {}, diagnostics), nullptr) << bad.what;
    EXPECT_NE(diagnostics.to_text().find(bad.said), std::string::npos) << bad.what << ": " << diagnostics.to_text();
  }
}

/// A topic with these fields on a wire.
std::string typed(const std::string& fields) {
  return R"({"name": "t", "duration": "20ms", "network": {"nodes": {"a": {"kind": "host"}, "b": {"kind": "host"}}, "links": [{"ends": ["a", "b"], "delay": "100ns"}]},
 "topics": [{"name": "x", "protocol": "opc-ua", "fields": )" +
         fields + R"(, "uadp": {"encoding": "Variant", "key_frame_count": 1}}],
 "applications": [{"name": "p", "on": "a", "threads": [{"name": "publish", "publish": "x", "every": "1ms"}]}, {"name": "s", "on": "b", "threads": [{"name": "subscribe", "subscribe": "x", "every": "1ms", "offset": "500us"}]}]})";
}

// Each sample is taken, whatever else it has; a stream is as long as its longest message: 1472 octets at most, here 4
// (flags, PublisherId), 5 (group), 3 (payload) and 3 (flags, FieldCount) of headers, UInt32 5 and String 1 + 4 + 40
// octets.
TEST(Applications, TextsTravel) {
  const auto resolved = sound(typed(R"({"s": {"type": "String", "max_length": 40}, "level": "UInt32"})"));
  LiveRun run(*resolved);
  run.advance();
  const results::RunResult result = evaluation::evaluate(run, false);
  EXPECT_EQ(result.applications[1].threads[0].arrived, 20u);
  EXPECT_EQ(application::longest_message(resolved->topics[0].shape, {1, 1}), 65u);
}

/// What is refused is said once: nothing else follows from it. (The gateway of the third case is at a publisher of what
/// it takes, too.)
TEST(Applications, AMistakeIsSaidOnce) {
  const std::string gateway_to =
      R"(, "gateways": [{"name": "g", "on": "a", "from": "x", "receive_every": "1ms", "send_every": "1ms", "to": )";
  const std::string network =
      R"({"name": "t", "duration": "1s", "network": {"nodes": {"a": {"kind": "host"}, "b": {"kind": "host"}}, "links": [{"ends": ["a", "b"]}]})";
  const Bad cases[] = {
      {"no length", typed(R"({"level": "UInt32", "s": "String"})"), "a text without a greatest length"},
      {"no number", typed(R"({"g": "Guid"})"), "no field for the pattern"},
      {"no type", typed(R"({"g": "Grid"})"), "unknown"},
      {"too long", typed(R"({"level": "UInt32", "s": {"type": "String", "max_length": 1400, "count": 2}})"),
       "a sample too long for a NetworkMessage"},
      {"no interval", pair(opc_ua, R"("offset": "1ms")", R"("every": "1ms")"), R"(the field "every" is missing)"},
      {"zero", pair(opc_ua, R"("every": "0ms")", R"("every": "1ms")"), "out of range"},
      {"gateway", pair(opc_ua, R"("every": "1ms")", R"("every": "1ms")", gateway_to + R"("q"}])"), "unknown topic"},
      {"no topics",
       network +
           R"(, "applications": [{"name": "p", "on": "a", "threads": [{"name": "publish", "publish": "x", "every": "1ms"}]}]})",
       "unknown topic"},
      {"no host", network + R"(, "topics": [{"name": "x", "protocol": "dds", "fields": {"level": "UInt32"}}],
  "applications": [{"name": "p", "threads": [{"name": "publish", "publish": "x", "every": "1ms"}]}]})",
       R"(the field "on" is missing)"},
      {"depth",
       pair(R"("protocol": "dds", "qos": {"history": "keep-all", "depth": 0})", R"("every": "1ms")",
            R"("every": "1ms")"),
       "out of range"},
      {"type", pair(opc_ua + R"(, "type": "Plant::X")", R"("every": "1ms")", R"("every": "1ms")"),
       "does not belong to OPC UA"},
  };
  for (const Bad& bad : cases) {
    json::Diagnostics diagnostics;
    EXPECT_EQ(load_text(bad.text, "t.json", {}, diagnostics), nullptr) << bad.what;
    EXPECT_EQ(diagnostics.errors(), bad.what == std::string("gateway") ? 2u : 1u)
        << bad.what << ": " << diagnostics.to_text();
    EXPECT_NE(diagnostics.to_text().find(bad.said), std::string::npos) << bad.what << ": " << diagnostics.to_text();
  }
}

}  // namespace
}  // namespace takt::scenario::test::applications_test
