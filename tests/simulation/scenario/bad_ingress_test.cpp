// SPDX-License-Identifier: Apache-2.0
// Policing, CQF and redundancy that name what is not there, contradict themselves or can let no frame pass.
#include "bad_input.hpp"

namespace takt::scenario::test::bad_ingress_test {
namespace {

/// `text` is the content of the switch's ingress.
std::string with_ingress(const std::string& text) {
  return R"({"name": "t", "duration": "1ms", "network": {"nodes": {"a": {"kind": "host"}, "b": {"kind": "host"}, "sw": {"kind": "switch", "ingress": {
)" + text +
         R"(}}},
"links": [)" +
         two_links +
         R"(]}, "streams": [{"name": "control", "from": "a", "to": "b", "payload": "100B", "every": "1ms", "pcp": 3}]})";
}

/// `text` is the redundancy of a stream from h1 to the value `to`, over a ring of three switches with a host at each; x
/// is another host at sw1.
std::string with_redundancy(const std::string& text, const std::string& to = "\"h2\"",
                            const std::string& more = R"(, "pcp": 3)") {
  return R"({"name": "t", "duration": "1ms", "network": {"generate": [{"topology": "ring", "switches": 3}], "nodes": {"x": {"kind": "host"}}, "links": [{"ends": ["x", "sw1"]}]},
"streams": [{"name": "s", "from": "h1", "to": )" +
         to + R"(, "payload": "100B", "every": "500us")" + more + ",\n\"redundancy\": " + text + "}]}";
}

const BadCase
    cases
        [] =
            {
                {"UnknownGateMeterAndScheduler",
                 with_ingress(
                     R"("filters": [{"stream": "control", "gate": "slit", "meter": "m", "ats": "a"}], "gates": [{"name": "slot", "open": false}])"),
                 R"(2:43: error at /network/nodes/sw/ingress/filters/0/gate: unknown stream gate: found "slit", expected a name under "gates" of this ingress (did you mean "slot"?)
2:60: error at /network/nodes/sw/ingress/filters/0/meter: unknown flow meter: found "m", expected a name under "meters" of this ingress
2:72: error at /network/nodes/sw/ingress/filters/0/ats: unknown ATS scheduler: found "a", expected a name under "ats" of this ingress)"},
                {"UnknownFilteredStream", with_ingress(R"("filters": [{"stream": "contrl", "max_sdu": "100B"}])"),
                 R"(2:24: error at /network/nodes/sw/ingress/filters/0/stream: unknown stream: found "contrl", expected a name under "streams" of this ingress or of the scenario (did you mean "control"?))"},
                {"UnknownIdentity",
                 with_ingress(
                     R"("streams": [{"name": "n", "source": "c"}, {"name": "k", "null": {"stream": "controll"}}, {"name": "sw", "source": "sw"}])"),
                 R"(2:37: error at /network/nodes/sw/ingress/streams/0/source: unknown node: found "c", expected the name of a host
2:76: error at /network/nodes/sw/ingress/streams/1/null/stream: unknown stream: found "controll", expected the name of a stream (did you mean "control"?)
2:115: error at /network/nodes/sw/ingress/streams/2/source: not a host: found "sw", expected the name of a host)"},
                {"TwoIdentities",
                 with_ingress(R"("streams": [{"name": "n", "source": "a", "null": {"destination": "b"}}])"),
                 R"(2:37: error at /network/nodes/sw/ingress/streams/0/source: fields that exclude each other: found "source" beside "null", expected exactly one of "null", "source" or "mask")"},
                {"IdentityOfNothing", with_ingress(R"("streams": [{"name": "n"}, {"name": "m", "null": {}}])"),
                 R"(2:13: error at /network/nodes/sw/ingress/streams/0: a field is missing: expected exactly one of "null", "source" or "mask"
2:50: error at /network/nodes/sw/ingress/streams/1/null: a field is missing: expected exactly one of "destination" or "stream")"},
                {"NotAMacAddress",
                 with_ingress(
                     R"("streams": [{"name": "n", "mask": {"source": "02-00-5E-00-00-0g", "source_mask": "FF FF FF FF FF FF"}}])"),
                 R"(2:46: error at /network/nodes/sw/ingress/streams/0/mask/source: not a MAC address: found "02-00-5E-00-00-0g", expected six octets such as "02-00-5E-00-00-01"
2:82: error at /network/nodes/sw/ingress/streams/0/mask/source_mask: not a MAC address: found "FF FF FF FF FF FF", expected six octets such as "02-00-5E-00-00-01")"},
                {"NameTwice",
                 with_ingress(
                     R"("gates": [{"name": "g"}, {"name": "g"}], "meters": [{"name": "m", "cir": "1Mbps", "cbs": "2kB"}, {"name": "m", "cir": "1Mbps", "cbs": "2kB"}])"),
                 R"(2:35: error at /network/nodes/sw/ingress/gates/1/name: duplicate name: found "g" a second time, expected a name of its own in its table
2:107: error at /network/nodes/sw/ingress/meters/1/name: duplicate name: found "m" a second time, expected a name of its own in its table)"},
                {"BlockWithoutALimit", with_ingress(R"("filters": [{"stream": "control", "block_oversize": true}])"),
                 R"(2:53: error at /network/nodes/sw/ingress/filters/0/block_oversize: no frame is too long: found "block_oversize" without "max_sdu", expected "max_sdu" too)"},
                {"OctetsOfAClosedGate",
                 with_ingress(
                     R"("gates": [{"name": "g", "entries": [{"open": false, "for": "1ms", "octets": "100B"}]}])"),
                 R"(2:77: error at /network/nodes/sw/ingress/gates/0/entries/0/octets: octets of a closed gate: found 100B with "open": false, expected octets of an open entry)"},
                {"CycleWithoutEntries", with_ingress(R"("gates": [{"name": "g", "cycle": "1ms"}])"),
                 R"(2:34: error at /network/nodes/sw/ingress/gates/0/cycle: a cycle without entries: found "cycle" alone, expected "entries" too)"},
                {"GateEntryOutOfRange",
                 with_ingress(
                     R"("gates": [{"name": "g", "entries": [{"open": true, "for": "0s", "ipv": 8}, {"for": "1ms"}]}])"),
                 R"(2:59: error at /network/nodes/sw/ingress/gates/0/entries/0/for: out of range: found "0s", expected a duration from 1ns to 1h
2:72: error at /network/nodes/sw/ingress/gates/0/entries/0/ipv: out of range: found the number 8, expected an integer from 0 to 7
2:76: error at /network/nodes/sw/ingress/gates/0/entries/1: the field "open" is missing)"},
                {"MeterFasterThanTheLink",
                 with_ingress(R"("meters": [{"name": "m", "cir": "2Gbps", "cbs": "2kB", "eir": "1.5Gbps"}])"),
                 R"(2:33: error at /network/nodes/sw/ingress/meters/0/cir: a meter faster than every link: found 2Gbps, expected at most 1Gbps, the fastest link of the switch
2:63: error at /network/nodes/sw/ingress/meters/0/eir: a meter faster than every link: found 1.5Gbps, expected at most 1Gbps, the fastest link of the switch)"},
                {"MeterBurstBelowAFrame",
                 with_ingress(
                     R"("filters": [{"stream": "control", "meter": "m"}], "meters": [{"name": "m", "cir": "1Mbps", "cbs": "100B", "ebs": "149B"}])"),
                 R"(2:99: error at /network/nodes/sw/ingress/meters/0/cbs: a burst smaller than a frame: found 149B for frames of "control" of up to 150B, expected at least the longest frame)"},
                {"MeterThatOnlyMarksWhatItDrops",
                 with_ingress(
                     R"("filters": [{"pcp": 3, "meter": "m"}], "meters": [{"name": "m", "cir": "1Mbps", "cbs": "100B", "ebs": "200B", "drop_on_yellow": true}])"),
                 R"(2:88: error at /network/nodes/sw/ingress/meters/0/cbs: a burst smaller than a frame: found 100B for frames of "control" of up to 150B, expected at least the longest frame)"},
                {"SchedulerBurstBelowAFrame",
                 with_ingress(
                     R"("filters": [{"stream": "control", "ats": "s"}], "ats": [{"name": "s", "rate": "2Mbps", "burst": "169B"}])"),
                 R"(2:97: error at /network/nodes/sw/ingress/ats/0/burst: a burst smaller than a frame: found 169B for frames of "control" of up to 170B with preamble and gap, expected at least the longest frame)"},
                {"SchedulerFasterThanTheLink",
                 with_ingress(
                     R"("ats": [{"name": "s", "rate": "2Gbps", "burst": "2kB", "group": "g"}], "ats_groups": [{"name": "h"}])"),
                 R"(2:31: error at /network/nodes/sw/ingress/ats/0/rate: a scheduler faster than every link: found 2Gbps, expected at most 1Gbps, the fastest link of the switch
2:65: error at /network/nodes/sw/ingress/ats/0/group: unknown group of ATS schedulers: found "g", expected a name under "ats_groups" of this ingress)"},
                {"CqfThatDoesNotFit", with_ingress(R"("cqf": {"cycle": "1us", "classes": [3, 2]})"),
                 R"(2:18: error at /network/nodes/sw/ingress/cqf/cycle: a cycle shorter than a frame: found 1us with a dead time of 51ns for frames of "control" that last 1.264us, expected a cycle that holds the longest frame)"},
                {"CqfWithoutTimeToSend",
                 with_ingress(R"("cqf": {"cycle": "10us", "classes": [3, 2], "dead_time": "10us"})"),
                 R"(2:58: error at /network/nodes/sw/ingress/cqf/dead_time: no time to send: found a dead time of 10us in a cycle of 10us, expected a shorter one)"},
                {"CqfThatReceivesIntoWhatItSends",
                 with_ingress(R"("cqf": {"cycle": "10us", "classes": [3, 2], "offset": "1us"})"),
                 R"(2:55: error at /network/nodes/sw/ingress/cqf/offset: receiving into the buffer that is sent from: found 1us with two buffers, expected three buffers, or "dead_time")"},
                {"CqfOffsetBeyondTheCycle",
                 with_ingress(R"("cqf": {"cycle": "10us", "classes": [4, 3, 2], "offset": "10us"})"),
                 R"(2:58: error at /network/nodes/sw/ingress/cqf/offset: an offset beyond the cycle: found 10us, expected less than 10us)"},
                {"CqfBuffersWithoutClasses",
                 with_ingress(R"("cqf": {"cycle": "10us", "classes": [3, 2], "buffers": 3})"),
                 R"(2:56: error at /network/nodes/sw/ingress/cqf/buffers: not a class for each buffer: found 3 buffers in 2 classes, expected as many classes as buffers)"},
                {"CqfOfOneClass", with_ingress(R"("cqf": {"cycle": "10us", "classes": [3]})"),
                 R"(2:37: error at /network/nodes/sw/ingress/cqf/classes: too few items: found 1, expected 2 to 7 items)"},
                {"CqfBesideGates", with_ingress(R"("cqf": {"cycle": "10us", "classes": [3, 2]}}, "egress": [{"gates": {"entries": [{"open": [3], "for": "1ms"}]}}], "queues": {"frames": 100)"), R"(2:8: error at /network/nodes/sw/ingress/cqf: a port configured twice: found gates in "egress" beside CQF, which makes them, expected one of the two)"},
                {"CqfBesideAGateOfItsName",
                 with_ingress(R"("cqf": {"cycle": "10us", "classes": [3, 2]}, "gates": [{"name": "cqf"}])"),
                 R"(2:8: error at /network/nodes/sw/ingress/cqf: duplicate name: found a stream gate "cqf" beside CQF, expected another name for that gate)"},
                {"OnePathIsNoRedundancy", with_redundancy(R"(1)"),
                 R"(3:15: error at /streams/0/redundancy: out of range: found the number 1, expected an integer from 2 to 8)"},
                {"MorePathsThanThereAre", with_redundancy(R"(3)"),
                 R"(3:15: error at /streams/0/redundancy: not enough disjoint paths: found 2 between "h1" and "h2", over the links "sw1" - "sw2", "sw1" - "sw3", expected 3 paths that share no link between switches)"},
                {"BothHostsAtOneSwitch", with_redundancy(R"(2)", R"("x")"),
                 R"(3:15: error at /streams/0/redundancy: not enough disjoint paths: found both hosts at "sw1", expected 2 paths that share no link between switches)"},
                {"ThreePathsToSeveral", with_redundancy(R"({"count": 3})", R"(["h2", "h3"])"),
                 R"(3:25: error at /streams/0/redundancy/count: redundancy for several receivers: found "count" of a stream to 2, expected 2)"},
                {"RedundancyBesideAPath", with_redundancy(R"(2)", R"("h2")", R"(, "path": ["h1", "sw1", "sw2", "h2"])"),
                 R"(2:98: error at /streams/0/path: a path of a redundant stream: found "path" beside "redundancy", expected "paths" in "redundancy")"},
                {"RedundancyBesideARoute", with_redundancy(R"(2)", R"("h2")", R"(, "route": "auto")"),
                 R"(2:99: error at /streams/0/route: a route of a redundant stream: found "route" beside "redundancy", expected "count" or "paths" in "redundancy")"},
                {"NumberAndPaths",
                 with_redundancy(
                     R"({"count": 2, "paths": [["h1", "sw1", "sw2", "h2"], ["h1", "sw1", "sw3", "sw2", "h2"]]})"),
                 R"(3:37: error at /streams/0/redundancy/paths: fields that exclude each other: found "paths" beside "count", expected at most one of "count" or "paths")"},
                {"PathsThatAreNone",
                 with_redundancy(R"({"paths": [["h1", "sw1", "sw2"], ["h1", "sw1", "h3", "sw2", "h2"]]})"),
                 R"(3:26: error at /streams/0/redundancy/paths/0: a path between other nodes: found "h1" to "sw2", expected "h1" to "h2"
3:48: error at /streams/0/redundancy/paths/1/2: a host inside a path: found "h3", expected a switch or a station, since hosts do not forward
3:48: error at /streams/0/redundancy/paths/1/2: no link: found none between "sw1" and "h3", expected neighbours along the path
3:48: error at /streams/0/redundancy/paths/1/3: no link: found none between "h3" and "sw2", expected neighbours along the path)"},
                {"APathTwice",
                 with_redundancy(R"({"paths": [["h1", "sw1", "sw2", "h2"], ["h1", "sw1", "sw2", "h2"]]})"),
                 R"(3:54: error at /streams/0/redundancy/paths/1: a path twice: found the path of another member, expected paths that differ)"},
                {"SplitWhereThePathsHaveParted", with_redundancy(R"({"split": "sw3", "merge": "sw9"})"),
                 R"(3:25: error at /streams/0/redundancy/split: a node that not all paths cross before they part: found "sw3", expected "h1" or "sw1"
3:41: error at /streams/0/redundancy/merge: unknown node: found "sw9", expected the name of a node (did you mean "sw1"?))"},
                {"VlansOfAnUntaggedStream", with_redundancy(R"({"vlans": [1, 2]})", R"("h2")", R"()"),
                 R"(3:25: error at /streams/0/redundancy/vlans: a VLAN without a priority: found "vlans" of an untagged stream, expected "pcp" too, since the tag carries both)"},
                {"AVlanTooFew", with_redundancy(R"({"vlans": [1]})"),
                 R"(3:25: error at /streams/0/redundancy/vlans: not a VLAN for each path: found 1, expected 2)"},
                {"HistoryOfNothing",
                 with_redundancy(R"({"history": 0, "reset_timeout": "0s", "latent_errors": {"period": "1us"}})"),
                 R"(3:27: error at /streams/0/redundancy/history: out of range: found the number 0, expected an integer from 2 to 1024
3:47: error at /streams/0/redundancy/reset_timeout: out of range: found "0s", expected a duration from 1us to 1h
3:81: error at /streams/0/redundancy/latent_errors/period: out of range: found "1us", expected a duration from 1ms to 1h)"},
                {"UnknownAlgorithm", with_redundancy(R"({"algorithm": "vectr"})"),
                 R"(3:29: error at /streams/0/redundancy/algorithm: unknown name for a recovery algorithm: found "vectr", expected "vector" or "match" (did you mean "vector"?))"},
};

INSTANTIATE_TEST_SUITE_P(BadIngress, BadInput, testing::ValuesIn(cases), name_of_case);

}  // namespace
}  // namespace takt::scenario::test::bad_ingress_test
