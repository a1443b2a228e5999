// SPDX-License-Identifier: Apache-2.0
// Quality of service of DDS in scenarios: what times out, what does not fit, and where that is said.
#include <algorithm>
#include <tuple>

#include "evaluation/evaluate.hpp"
#include "support.hpp"

namespace takt::scenario::test::dds_applications_test {
namespace {

/// Two hosts on a wire; p on a publishes the topic x, s on b subscribes to it.
std::string pair(const std::string& topic, const std::string& publisher, const std::string& subscriber,
                 const std::string& more = "", const std::string& duration = "1s") {
  return R"({"name": "t", "duration": ")" + duration +
         R"(", "network": {"nodes": {"a": {"kind": "host"}, "b": {"kind": "host"}}, "links": [{"ends": ["a", "b"], "delay": "100ns"}]},
 "topics": [{"name": "x", "protocol": "dds", "fields": {"id": "UInt32", "level": "UInt32"}, )" +
         topic + R"(}],
 "applications": [{"name": "p", "on": "a", "threads": [{"name": "publish", "publish": "x", )" +
         publisher + R"(}]},
                  {"name": "s", "on": "b", "threads": [{"name": "subscribe", "subscribe": "x", )" +
         subscriber + R"(}]}])" + more + "}";
}

results::RunResult result_of(const std::string& text) {
  const auto resolved = sound(text);
  LiveRun run(*resolved);
  run.advance();
  return evaluation::evaluate(run, false);
}

// For two seconds, and until the next HEARTBEAT after them, nobody acknowledges: the history fills, one write waits
// until its time is over, those that come meanwhile are refused.
TEST(DdsApplications, AWriteThatTimesOutIsNotPublished) {
  const std::string qos =
      R"("qos": {"reliability": "reliable", "history": "keep-all", "max_blocking_time": "32ms", "resource_limits": {"max_samples": 4}})";
  const std::string cut = R"(, "faults": [{"kind": "link-down", "at": "2s", "for": "2s", "link": ["a", "b"]}])";
  const results::RunResult result =
      result_of(pair(qos, R"("every": "10ms", "response": "1us")",
                     R"("every": "10ms", "offset": "5ms", "buffer": 100, "response": "1us")", cut, "12s"));
  const results::ThreadResult& publish = result.applications[0].threads[0];
  const results::ThreadResult& subscribe = result.applications[1].threads[0];
  EXPECT_EQ(publish.timed_out, result.applications[0].participants[0].writes_timed_out);
  EXPECT_GT(publish.timed_out, 40u);   // one in each 40 ms
  EXPECT_LT(publish.timed_out, 126u);  // HEARTBEATs are 3 s apart
  EXPECT_GE(publish.refused, 3 * publish.timed_out - 3);
  EXPECT_EQ(publish.published + publish.refused + publish.timed_out, publish.done);  // none waits at the end
  // What was published has come, but for what nobody was there to hear, and what is under way.
  const std::uint64_t before_match =
      static_cast<std::uint64_t>(result.applications[0].participants[0].time_to_match->ps() / 10'000'000'000) + 1;
  EXPECT_LE(subscribe.arrived, publish.published);
  EXPECT_GE(subscribe.arrived + before_match + 1, publish.published);
  // Criterion 2: neither what timed out nor what was refused is a value.
  ASSERT_TRUE(subscribe.values);
  EXPECT_LE(subscribe.values->counted + subscribe.values->beyond, subscribe.buffered);
  EXPECT_GE(subscribe.values->counted + subscribe.values->beyond + 2, subscribe.buffered);  // the last window is open
  EXPECT_LE(subscribe.values->counted + publish.timed_out + publish.refused, subscribe.values->expected);
}

json::Diagnostics told(const std::string& text) {
  json::Diagnostics diagnostics;
  load_text(text, "t.json", {}, diagnostics);
  return diagnostics;
}

TEST(DdsApplications, AValueOutOfRangeIsToldOnce) {
  const std::string thread = R"("every": "1ms")";
  const char* const limits[] = {R"("depth": 0)",
                                R"("depth": 2000000)",
                                R"("deadline": "0ns")",
                                R"("lease_duration": "0ns")",
                                R"("lifespan": "0ns")",
                                R"("resource_limits": {"max_samples": 0})",
                                R"("resource_limits": {"max_samples": 2000000, "max_samples_per_instance": 5})",
                                R"("resource_limits": {"max_instances": 0})",
                                R"("resource_limits": {"max_samples_per_instance": 0})"};
  for (const std::string limit : limits) {
    for (const std::string& text : {pair("\"qos\": {" + limit + "}", thread, thread),
                                    pair("\"vlan\": 0", thread + ", \"qos\": {" + limit + "}", thread)}) {
      const json::Diagnostics diagnostics = told(text);
      EXPECT_EQ(diagnostics.errors() + diagnostics.warnings(), 1u) << limit << ": " << diagnostics.to_text();
      EXPECT_NE(diagnostics.to_text().find("out of range"), std::string::npos)
          << limit << ": " << diagnostics.to_text();
    }
  }
}

// What its topic says concerns writer and reader, and is one mistake.
TEST(DdsApplications, AContradictionIsToldOnceAtItsKey) {
  const std::string thread = R"("every": "1ms")";
  const json::Diagnostics of_topic =
      told(pair(R"("qos": {"depth": 5, "resource_limits": {"max_samples_per_instance": 2}})", thread, thread));
  ASSERT_EQ(of_topic.errors(), 1u) << of_topic.to_text();
  EXPECT_EQ(of_topic.kept()[0].place.pointer, "/topics/0/qos/depth");
  const json::Diagnostics of_thread =
      told(pair("\"vlan\": 0", thread, thread + R"(, "qos": {"deadline": "1ms", "time_based_filter": "2ms"})"));
  ASSERT_EQ(of_thread.errors(), 1u) << of_thread.to_text();
  EXPECT_EQ(of_thread.kept()[0].place.pointer, "/applications/1/threads/0/qos/deadline");
  // The depth of a reader that says none is its buffer.
  const json::Diagnostics of_buffer =
      told(pair(R"("qos": {"resource_limits": {"max_samples": 2}})", thread, thread + R"(, "buffer": 9)"));
  ASSERT_EQ(of_buffer.errors(), 1u) << of_buffer.to_text();
  EXPECT_EQ(of_buffer.kept()[0].place.pointer, "/topics/0/qos/resource_limits");
}

TEST(DdsApplications, WhatDoesNotMatchIsToldAtItsKey) {
  const std::string thread = R"("every": "1ms")";
  struct Case {
    std::string topic;
    std::string publisher;
    std::string subscriber;
    std::vector<std::string> pointers;
  };
  const std::string at_writer = "/applications/0/threads/0/qos/";
  const std::string at_reader = "/applications/1/threads/0/qos/";
  const Case cases[] = {
      {R"("vlan": 0)", "", R"("reliability": "reliable")", {at_reader + "reliability"}},
      {R"("qos": {"reliability": "reliable"})", R"("reliability": "best-effort")", "", {at_writer + "reliability"}},
      {R"("vlan": 0)",
       R"("deadline": "2ms")",
       R"("deadline": "1ms", "durability": "transient-local")",
       {at_reader + "deadline", at_reader + "durability"}},
      {R"("qos": {"lease_duration": "1s"})", "", R"("lease_duration": "500ms")", {at_reader + "lease_duration"}},
      {R"("vlan": 0)", "", R"("ownership": "exclusive")", {at_reader + "ownership"}},
      {R"("qos": {"destination_order": "by-source"})",
       R"("destination_order": "by-reception")",
       "",
       {at_writer + "destination_order"}},
      {R"("vlan": 0)", "", R"("liveliness": "manual-by-topic")", {at_reader + "liveliness"}},
  };
  for (const Case& each : cases) {
    const json::Diagnostics diagnostics = told(pair(each.topic, thread + ", \"qos\": {" + each.publisher + "}",
                                                    thread + ", \"qos\": {" + each.subscriber + "}"));
    std::vector<std::string> pointers;
    for (const json::Diagnostic& diagnostic : diagnostics.kept()) pointers.push_back(diagnostic.place.pointer);
    std::sort(pointers.begin(), pointers.end());
    EXPECT_EQ(pointers, each.pointers) << diagnostics.to_text();
    EXPECT_EQ(diagnostics.warnings(), each.pointers.size());
  }
}

/// One publishes, three hosts subscribe, the last of them two topics, and a fifth subscribes to something else;
/// `domain` says how.
std::string star(const std::string& qos, const std::string& domain, const std::string& more = "") {
  std::string nodes, links, applications;
  for (const char host : {'a', 'b', 'c', 'd', 'e'}) {
    nodes += std::string(R"(, ")") + host + R"(": {"kind": "host"})";
    links += std::string(links.empty() ? "" : ", ") + R"({"ends": [")" + host + R"(", "s"]})";
    const std::string other = R"({"name": "other", "subscribe": "y", "every": "10ms", "response": "1us"})";
    const std::string take =
        R"({"name": "take", "subscribe": "x", "every": "1ms", "offset": "500us", "buffer": 100, "response": "1us"})";
    const std::string publish =
        R"({"name": "publish", "publish": "x", "every": "10ms", "response": "1us"}, {"name": "more", "publish": "y", "every": "20ms", "response": "1us"})";
    applications += std::string(host == 'a' ? "" : ", ") + R"({"name": "of-)" + host + R"(", "on": ")" + host +
                    R"(", "threads": [)" +
                    (host == 'a'   ? publish
                     : host == 'e' ? other
                     : host == 'd' ? take + ", " + other
                                   : take) +
                    "]}";
  }
  return R"({"name": "t", "duration": "8s", "network": {"nodes": {"s": {"kind": "switch"})" + nodes +
         R"(}, "links": [)" + links + R"(]}, "domains": [{"id": 0)" + domain + R"(}],
 "topics": [{"name": "x", "protocol": "dds", "fields": {"level": "UInt32"}, "qos": {)" +
         qos + R"(}}, {"name": "y", "protocol": "dds", "fields": {"level": "UInt32"}}],
 "applications": [)" +
         applications + "]" + more + "}";
}

const results::StreamResult& stream_of(const results::RunResult& result, const std::string& name) {
  return *std::ranges::find(result.streams, name, &results::StreamResult::name);
}
bool has_stream(const results::RunResult& result, const std::string& name) {
  return std::ranges::find(result.streams, name, &results::StreamResult::name) != result.streams.end();
}

// Once to the group instead of once to each: four participants have readers, so each of them hears all, e of x in vain.
TEST(DdsApplications, SamplesGoOnceToTheGroup) {
  const results::RunResult unicast = result_of(star(R"("reliability": "reliable")", ""));
  const results::RunResult multicast = result_of(star(R"("reliability": "reliable")", R"(, "multicast": true)"));
  EXPECT_FALSE(has_stream(unicast, "rtps-0/of-a/samples"));
  const results::StreamResult& samples = stream_of(multicast, "rtps-0/of-a/samples");
  const std::uint64_t written =
      multicast.applications[0].threads[0].published + multicast.applications[0].threads[1].published;
  EXPECT_EQ(written, 1200u);
  // All but those that were written before somebody was found, and HEARTBEATs, 3 s apart, for several at once.
  EXPECT_GT(samples.sent, written - 30);
  EXPECT_LE(samples.sent, written + 3);
  EXPECT_EQ(samples.delivered, 4 * samples.sent);
  for (const char* const reader : {"b", "c", "d"}) {
    EXPECT_LT(stream_of(multicast, std::string("rtps-0/of-a/of-") + reader).sent, 20u) << reader;
    EXPECT_GT(stream_of(unicast, std::string("rtps-0/of-a/of-") + reader).sent, 780u) << reader;
  }
  for (std::size_t reader = 1; reader < 5; ++reader) {
    const results::ThreadResult& one = multicast.applications[reader].threads[0];
    const results::ThreadResult& other = unicast.applications[reader].threads[0];
    EXPECT_EQ(one.arrived, other.arrived);
    EXPECT_EQ(one.lost, 0u);
  }
}

// What one of them has not got it asks for, and gets alone.
TEST(DdsApplications, WhatOneOfAGroupLacksIsSentToItAlone) {
  const std::string loss =
      R"(, "faults": [{"kind": "frame-errors", "link": ["s", "b"], "towards": "b", "loss": 1, "at": "4s", "for": "100ms"}])";
  const results::RunResult result =
      result_of(star(R"("reliability": "reliable", "history": "keep-all")", R"(, "multicast": true)", loss));
  EXPECT_EQ(result.applications[1].threads[0].arrived, result.applications[2].threads[0].arrived);
  EXPECT_EQ(result.applications[1].threads[0].lost, 0u);
  EXPECT_EQ(result.applications[0].participants[0].resent, 10u);
  EXPECT_GE(stream_of(result, "rtps-0/of-a/of-b").sent, 10u);
  EXPECT_LT(stream_of(result, "rtps-0/of-a/of-c").sent, 10u);
}

// Of a counter from 1 on, published each 10 ms: what is even between 10 and 100 has no expression, what is below 20, or
// from 780 on but not 790, has one. All came to the host; what is kept out takes no room in a history of one sample, is
// not lost, and is told apart.
TEST(DdsApplications, AFilterLetsPassWhatIsAskedFor) {
  const std::string writer = R"("every": "10ms", "response": "1us")";
  const auto reader = [](const std::string& filter) {
    return R"("every": "100ms", "offset": "5ms", "response": "1us", "buffer": 100, "qos": {"depth": 1}, "filter": ")" +
           filter + "\"";
  };
  const results::RunResult result =
      result_of(pair(R"("vlan": 0)", writer, reader("id <= 300 OR id >= 780 AND NOT id = 790"), "", "8s"));
  const results::ThreadResult& subscribe = result.applications[1].threads[0];
  const results::ThreadResult& publish = result.applications[0].threads[0];
  EXPECT_EQ(publish.published, 800u);
  EXPECT_EQ(subscribe.lost, 0u);
  ASSERT_TRUE(subscribe.filtered);
  // From 301 to 779 there are 479 and 790; the last call is before some of the last ones.
  EXPECT_EQ(*subscribe.filtered, 480u);
  EXPECT_FALSE(subscribe.values);
  // One sample of each ten is kept up to 300, and after 779.
  EXPECT_NEAR(static_cast<double>(subscribe.arrived), 32, 3);
  EXPECT_LE(subscribe.arrived + *subscribe.filtered + subscribe.overwritten, publish.published);
  EXPECT_GE(subscribe.arrived + *subscribe.filtered + subscribe.overwritten + 40,
            publish.published);  // before the match, and the last ones
}

TEST(DdsApplications, AFilterThatCannotBeIsToldWhereItIsWrong) {
  const std::string thread = R"("every": "1ms")";
  const auto only = [](const json::Diagnostics& told, const std::string& pointer, const std::string& what) {
    ASSERT_EQ(told.errors(), 1u) << told.to_text();
    EXPECT_EQ(told.kept()[0].place.pointer, pointer);
    EXPECT_NE(told.to_text().find(what), std::string::npos) << told.to_text();
  };
  only(told(pair(R"("vlan": 0)", thread, thread + R"(, "filter": "lever > 1")")), "/applications/1/threads/0/filter",
       "one of the fields id, level");
  only(told(pair(R"("vlan": 0)", thread, thread + R"(, "filter": "level >")")), "/applications/1/threads/0/filter",
       "at character 8");
  only(told(pair(R"("vlan": 0)", thread + R"(, "filter": "level > 1")", thread)), "/applications/0/threads/0/filter",
       "subscribe");
  std::string of_opc_ua = pair(R"("vlan": 0)", thread, thread + R"(, "filter": "level > 1")");
  of_opc_ua.replace(of_opc_ua.find("\"dds\""), 5, "\"opc-ua\"");
  only(told(of_opc_ua), "/applications/1/threads/0/filter", "OPC UA");
  only(told(pair(R"("vlan": 0)", thread, thread + R"(, "filter": "level > 1")",
                 R"(, "require": [{"application": "s", "buffered": 90}])")),
       "/require/0/buffered", "filter");
}

// Topics of two classes: each has its stream to the group, with its priority.
TEST(DdsApplications, EachClassHasAGroupStreamOfItsOwn) {
  std::string text = star(R"("reliability": "best-effort")", R"(, "multicast": true)");
  text.replace(text.find(R"({"name": "y")"), 12, R"({"pcp": 5, "name": "y")");
  const auto resolved = sound(text);
  const auto pcp_of = [&](const std::string& name) -> std::optional<int> {
    for (const models::StreamPlan& stream : resolved->plan.streams)
      if (stream.name == name) return stream.priority ? std::optional<int>(*stream.priority) : std::optional<int>(-1);
    return std::nullopt;
  };
  EXPECT_EQ(pcp_of("rtps-0/of-a/samples/pcp5-vlan0"), 5);
  EXPECT_EQ(pcp_of("rtps-0/of-a/samples/untagged"), -1);
  EXPECT_EQ(pcp_of("rtps-0/of-a/samples"), std::nullopt);
}

// Ten calls of the writer between two of the reader, which keeps one sample of each instance.
TEST(DdsApplications, EachInstanceHasAHistoryOfItsOwn) {
  const std::string writer = R"("every": "1ms", "response": "1us")";
  const std::string reader =
      R"("every": "20ms", "offset": "500us", "response": "1us", "buffer": 2, "qos": {"depth": 1})";
  const std::string instances = R"(, "payload": {"pattern": "alternate", "instance": 7, "instances": 5})";
  const results::RunResult keyed = result_of(pair(R"("keys": ["id"])", writer + instances, reader));
  const results::RunResult keyless = result_of(pair(R"("vlan": 0)", writer, reader));
  const results::ThreadResult& of_keyed = keyed.applications[1].threads[0];
  const results::ThreadResult& of_keyless = keyless.applications[1].threads[0];
  EXPECT_EQ(of_keyed.arrived, 5 * (of_keyed.done - 1));  // none before the match
  EXPECT_EQ(of_keyed.buffered, 2 * (of_keyed.done - 1));
  EXPECT_EQ(of_keyless.arrived, of_keyless.done - 1);
  EXPECT_EQ(of_keyed.lost + of_keyless.lost, 0u);
}

// The value is in the first field that is no key: a signal follows it, and not the key, which is never zero.
TEST(DdsApplications, AKeyIsNoValue) {
  const results::RunResult result = result_of(pair(
      R"("keys": ["id"])", R"("every": "10ms", "response": "1us", "payload": {"pattern": "alternate", "instance": 7})",
      R"("every": "10ms", "offset": "5ms", "response": "1us", "signal": "out")"));
  ASSERT_TRUE(result.signals[0].pulses);
  EXPECT_GT(result.signals[0].pulses->count, 40u);
  EXPECT_EQ(result.signals[0].pulses->max.ps(), 10'000'000'000);
}

TEST(DdsApplications, MistakesOfKeysAreNamed) {
  const std::string thread = R"("every": "1ms")";
  const std::pair<std::string, std::string> cases[] = {
      {pair(R"("keys": ["idd"])", thread, thread), "a key that is no field"},
      {pair(R"("keys": ["id", "level"])", thread, thread), "keys and nothing else"},
      {pair(R"("keys": ["id", "id"])", thread, thread), "occurs twice"},
      {pair(R"("vlan": 0)", thread + R"(, "payload": {"pattern": "counter", "instances": 2})", thread),
       "an instance of a topic without keys"},
  };
  for (const auto& [text, said] : cases) {
    const json::Diagnostics diagnostics = told(text);
    EXPECT_EQ(diagnostics.errors(), 1u) << diagnostics.to_text();
    EXPECT_NE(diagnostics.to_text().find(said), std::string::npos) << diagnostics.to_text();
  }
}

/// Writers on a and c, a reader on b, each in partitions of its own.
std::string in_partitions(const std::string& a, const std::string& c, const std::string& b) {
  const auto qos = [](const std::string& names) {
    return names.empty() ? "" : ", \"qos\": {\"partition\": [" + names + "]}";
  };
  return R"({"name": "t", "duration": "1s", "network": {"nodes": {"a": {"kind": "host"}, "b": {"kind": "host"}, "c": {"kind": "host"}, "w": {"kind": "switch"}},
 "links": [{"ends": ["a", "w"]}, {"ends": ["b", "w"]}, {"ends": ["c", "w"]}]}, "topics": [{"name": "x", "protocol": "dds", "fields": {"level": "UInt32"}}],
 "applications": [{"name": "one", "on": "a", "threads": [{"name": "publish", "publish": "x", "every": "1ms", "response": "1us")" +
         qos(a) +
         R"(}]}, {"name": "two", "on": "c", "threads": [{"name": "publish", "publish": "x", "every": "2ms", "response": "1us")" +
         qos(c) +
         R"(}]}, {"name": "s", "on": "b", "scheduler": {"after": "100ms"}, "threads": [{"name": "subscribe", "subscribe": "x", "every": "1ms", "offset": "500us", "response": "1us", "buffer": 9)" +
         qos(b) + "}]}]}";
}

TEST(DdsApplications, PartitionsKeepApart) {
  const auto heard = [](const std::string& text) {
    const results::RunResult result = result_of(text);
    for (const results::ApplicationResult& application : result.applications)
      EXPECT_TRUE(application.participants[0].incompatible.empty());
    const results::ThreadResult& subscribe = result.applications[2].threads[0];
    EXPECT_EQ(*subscribe.values->percent, 100.0) << "only what shares a partition is expected";
    return subscribe.values->expected / subscribe.values->tests;
  };
  EXPECT_EQ(heard(in_partitions("", "", "")), 15u);  // in 10 ms
  EXPECT_EQ(heard(in_partitions(R"("left")", R"("right")", R"("left")")), 10u);
  EXPECT_EQ(heard(in_partitions(R"("left")", R"("right")", R"("r*")")), 5u);
  EXPECT_EQ(heard(in_partitions(R"("left-1")", R"("left-2")", R"("middle", "left-[12]")")), 15u);
  // The others are a matter of course; who is alone is told.
  EXPECT_EQ(told(in_partitions(R"("left")", R"("right")", R"("right", "left")")).warnings(), 0u);
  const json::Diagnostics alone = told(in_partitions(R"("left")", R"("right")", R"("left")"));
  ASSERT_EQ(alone.warnings(), 1u) << alone.to_text();
  EXPECT_EQ(alone.kept()[0].place.pointer, "/applications/1/threads/0/qos/partition");
}

/// A writer, a service, and readers of which b comes at 8 s, when the writer has been gone for two seconds; the service
/// crashes meanwhile.
std::string with_service(const std::string& durability, const std::string& more = "",
                         const std::string& topics = "\"x\"") {
  return R"({"name": "t", "duration": "12s", "network": {"nodes": {"a": {"kind": "host"}, "b": {"kind": "host"}, "k": {"kind": "host"}, "w": {"kind": "switch"}},
 "links": [{"ends": ["a", "w"]}, {"ends": ["b", "w"]}, {"ends": ["k", "w"]}]}, "domains": [{"id": 0, "announce_every": "500ms", "lease_duration": "2s"}],
 "topics": [{"name": "x", "protocol": "dds", "fields": {"id": "UInt32", "level": "UInt32"}, "keys": ["id"], "qos": {"reliability": "reliable", "durability": ")" +
         durability + R"("}}], "applications": [
  {"name": "p", "on": "a", "threads": [{"name": "publish", "publish": "x", "every": "100ms", "response": "1us", "payload": {"pattern": "counter", "instances": 3}}]},
  {"name": "s", "on": "b", "threads": [{"name": "subscribe", "subscribe": "x", "every": "100ms", "response": "1us", "buffer": 100}]}],
 "persistence": [{"name": "keeper", "on": "k", "topics": [)" +
         topics + R"(]}],
 "faults": [{"kind": "crash", "node": "b", "at": "1ms", "for": "7999ms"}, {"kind": "crash", "node": "a", "at": "6s"})" +
         more + "]}";
}

TEST(DdsApplications, APersistenceServiceOutlivesTheWriter) {
  const std::string restart = R"(, {"kind": "crash", "node": "k", "at": "7s", "for": "500ms"})";
  struct Case {
    std::string durability;
    bool restarts;
    std::uint64_t restored;
    std::uint64_t arrived;
  };
  for (const Case& each : {Case{"transient", false, 0, 3}, Case{"persistent", false, 0, 3},
                           Case{"transient", true, 0, 0}, Case{"persistent", true, 3, 3}}) {
    const results::RunResult result = result_of(with_service(each.durability, each.restarts ? restart : ""));
    ASSERT_EQ(result.applications.size(), 3u);
    EXPECT_TRUE(result.applications[2].is_service);
    ASSERT_EQ(result.applications[2].kept.size(), 1u);
    const results::KeptResult& kept = result.applications[2].kept[0];
    EXPECT_GT(kept.received, 50u);
    EXPECT_LE(kept.received, result.applications[0].threads[0].published);
    EXPECT_EQ(kept.restored, each.restored) << each.durability << each.restarts;
    EXPECT_EQ(kept.kept, each.arrived);
    EXPECT_EQ(result.applications[1].threads[0].arrived, each.arrived)
        << each.durability << each.restarts << ": the last state of each instance, once";
  }
}

TEST(DdsApplications, WithoutAServiceTheLastStateIsLost) {
  std::string text = with_service("persistent");
  const std::size_t at = text.find(R"( "persistence")");
  text.erase(at, text.find(R"( "faults")") - at);
  EXPECT_EQ(result_of(text).applications[1].threads[0].arrived, 0u);
}

TEST(DdsApplications, MistakesOfServicesAreNamed) {
  std::string exclusive = with_service("persistent");
  exclusive.insert(exclusive.find(R"("durability")"), R"("ownership": "exclusive", )");
  std::string near = with_service("persistent");
  near.replace(near.find(R"("on": "k")"), 9, R"("on": "a")");
  std::string name = with_service("persistent");
  name.replace(name.find(R"("keeper")"), 8, R"("p")");
  const std::tuple<std::string, std::string, std::string> cases[] = {
      {with_service("transient-local"), "a topic that is not kept", "/persistence/0/topics/0"},
      {with_service("persistent", "", "\"y\""), "unknown topic", "/persistence/0/topics/0"},
      {exclusive, "quality of service that cannot be", "/topics/0/qos/ownership"},
      {near, "a topic that stays within a host", "/persistence/0/topics/0"},
      {name, "duplicate name", "/persistence/0/name"},
  };
  for (const auto& [text, said, pointer] : cases) {
    const json::Diagnostics diagnostics = told(text);
    ASSERT_EQ(diagnostics.errors(), 1u) << said << ": " << diagnostics.to_text();
    EXPECT_NE(diagnostics.to_text().find(said), std::string::npos) << diagnostics.to_text();
    EXPECT_EQ(diagnostics.kept()[0].place.pointer, pointer);
  }
}

}  // namespace
}  // namespace takt::scenario::test::dds_applications_test
