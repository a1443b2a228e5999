// SPDX-License-Identifier: Apache-2.0
// The resolved copy, which lies beside every result, means the same as its original: it loads, is written the same
// again, and runs to the same digest.
#include <type_traits>

#include "support.hpp"

namespace takt::scenario::test::resolved_copy_test {
namespace {

// What is resolved points into itself: another object of its contents would point into the first one.
static_assert(!std::is_copy_constructible_v<Resolved> && !std::is_copy_assignable_v<Resolved>);
static_assert(!std::is_move_constructible_v<Resolved> && !std::is_move_assignable_v<Resolved>);

/// `file`: where the copy would be, so that what it refers to is found.
void expect_same_again(const Resolved& resolved, const std::string& file = "s.json") {
  const std::string copy = json::encode(resolved.scenario);
  json::Diagnostics diagnostics;
  const auto again = load_text(copy, file, {}, diagnostics);
  ASSERT_TRUE(again) << diagnostics.to_text();
  EXPECT_EQ(again->scenario, resolved.scenario);
  EXPECT_EQ(json::encode(again->scenario), copy);
  EXPECT_EQ(digest_of(*again), digest_of(resolved));
}

TEST(ResolvedCopy, OfEveryShippedScenario) {
  for (const std::string& name : shipped_names()) {
    SCOPED_TRACE(name);
    expect_same_again(*shipped(name, "60ms"), shipped_path(name));
  }
}

// What every copy says, since it is there by itself, is nothing to be warned of.
TEST(ResolvedCopy, WarnsOfNothingOfItsOwn) {
  for (const std::string& name : shipped_names()) {
    json::Diagnostics original, copy;
    const auto resolved = load_file(shipped_path(name), {"/duration=60ms"}, original);
    ASSERT_TRUE(resolved) << name;
    ASSERT_TRUE(load_text(json::encode(resolved->scenario), shipped_path(name), {}, copy)) << name;
    EXPECT_EQ(copy.warnings(), original.warnings()) << name << "\n" << copy.to_text() << "\n" << original.to_text();
  }
}

TEST(ResolvedCopy, OfAScenarioWithEverything) {
  const auto r = sound(R"({
  "$schema": "x", "name": "all", "description": "every key", "seed": 18446744073709551615, "duration": "3ms", "clocks": "ideal", "allow_overload": true,
  "network": {
    "generate": [{"topology": "tree", "depth": 1, "fanout": 2, "hosts_per_switch": 2, "switch_prefix": "t", "host_prefix": "u", "rate": "2.5Gbps",
                  "host_rate": "100Mbps", "length": "3m", "forwarding_delay": "700ns", "os": "virtual-machine", "queues": {"frames": 9}, "traffic_classes": "identity"}],
    "nodes": {"a": {"kind": "host", "os": {"profile": "preempt-rt", "wake_up": {"weibull": {"scale": "3us", "shape": 0.7}, "min": "1us", "max": "1ms"},
                    "transmit": {"table": [{"value": "1us", "weight": 3}, {"value": "2us"}]}, "receive": "4us"},
                    "queues": {"frames": 100, "octets": "1MiB", "classes": [{"class": 7, "frames": 3}]}, "traffic_classes": "standard"},
              "s": {"kind": "switch", "forwarding_delay": "1us", "traffic_classes": "identity", "queues": {"octets": "9000B"}}},
    "links": [{"ends": ["a", "s:3"], "rate": "10Gbps", "delay": "3ns"}, {"ends": ["s", "t1"], "length": "1.5m"}]
  },
  "programs": [{"name": "p", "variant": "paper", "master": "a", "slaves": ["u1", "u2"], "cycle": "100us", "offset": "3us", "publish": "on-change",
                "receive_timeout": "700us", "initialisation": "20us", "pcp": 5, "vlan": 7, "violations": "reported",
                "process_data": [{"name": "d", "from": "u1", "fields": {"x": "Double", "y": {"type": "Byte", "count": 3}}}]}],
  "streams": [{"name": "s1", "from": "u3", "to": "a", "payload": "10B", "every": "30us", "offset": "1us", "jitter": "2us", "pcp": 3, "vlan": 4,
               "encapsulation": "ethernet", "path": ["u3", "t3", "t1", "s", "a"]},
              {"name": "s2", "from": "u4", "to": ["a", "u1"], "payload": "10B", "exponential": "50us"},
              {"name": "s3", "from": "u4", "to": "u1", "payload": "10B", "burst": {"frames": 3, "every": "500us", "spacing": "5us"}}],
  "script": [{"at": "200us", "program": "p", "call": "Start"}, {"at": "2ms", "program": "p", "call": "Halt", "on": "u2"}],
  "require": [{"reaction": "start", "program": "p", "within": "1ms"}, {"stream": "s1", "latency": "1ms", "jitter": "1ms", "dropped": 3, "delivered": 4}]
})");
  expect_same_again(*r);
}

TEST(ResolvedCopy, KeepsOverrides) {
  const auto r = sound(over_one_switch(""), {"/seed=7", "network.links.0.rate=100Mbps"});
  EXPECT_EQ(sound(json::encode(r->scenario))->scenario.seed, 7u);
  EXPECT_EQ(sound(json::encode(r->scenario))->plan.links[0].rate.bits_per_second, 100'000'000u);
}

}  // namespace
}  // namespace takt::scenario::test::resolved_copy_test
