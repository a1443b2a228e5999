// SPDX-License-Identifier: Apache-2.0
// Nodes and links that do not make a network. Generators that are asked for what they cannot make, a thousand million
// nodes among it.
#include "bad_input.hpp"

namespace takt::scenario::test::bad_network_test {
namespace {

const BadCase nodes_cases[] = {
    {"UnknownKind", with_node(R"({"kind": "hosst"})"),
     R"(2:15: error at /network/nodes/a/kind: unknown kind: found "hosst", expected "host", "switch" or "station" (did you mean "host"?))"},
    {"NoKind", with_node(R"({})"),
     R"(2:6: error at /network/nodes/a: the field "kind" is missing: expected "host", "switch" or "station")"},
    {"UnknownOperatingSystem", with_node(R"({"kind": "host", "os": "preempt_rt"})"),
     R"(2:29: error at /network/nodes/a/os: unknown name for an operating system: found "preempt_rt", expected "none", "preempt-rt", "preempt-rt-isolated", "preempt-rt-arm", "general-purpose", "virtual-machine" or "virtual-machine-rt" (did you mean "preempt-rt"?))"},
    {"FieldOfAnotherKind", with_node(R"({"kind": "host", "forwarding_delay": "1us"})"),
     R"(2:23: error at /network/nodes/a/forwarding_delay: unknown field "forwarding_delay": expected one of "kind", "device", "os", "traffic_classes", "queues", "egress", "gate_limits", "gates", "mtu", "processing", "cryptography", "offers", "cpu" or "ats")"},
    {"UnknownField", with_node(R"({"kind": "host", "colour": "red"})"),
     R"(2:23: error at /network/nodes/a/colour: unknown field "colour": expected one of "kind", "device", "os", "traffic_classes", "queues", "egress", "gate_limits", "gates", "mtu", "processing", "cryptography", "offers", "cpu" or "ats")"},
    {"TwoKindsOfLatency",
     with_node(R"({"kind": "host", "os": {"receive": {"fixed": "1us", "exponential": {"mean": "1us"}}}})"),
     R"(2:73: error at /network/nodes/a/os/receive/exponential: fields that exclude each other: found "exponential" beside "fixed", expected exactly one of "fixed", "uniform", "normal", "exponential", "weibull", "log_normal" or "table")"},
    {"LatencyMinAboveMax",
     with_node(R"({"kind": "host", "os": {"receive": {"exponential": {"mean": "1us"}, "min": "9us", "max": "2us"}}})"),
     R"(2:81: error at /network/nodes/a/os/receive/min: min above max: found 9us, expected at most 2us)"},
    {"LatencyOfAnEmptyInterval",
     with_node(R"({"kind": "host", "os": {"receive": {"uniform": {"from": "2us", "to": "1us"}}}})"),
     R"(2:53: error at /network/nodes/a/os/receive/uniform: an empty interval: found 2us to 1us, expected from at most to)"},
    {"LatencyTableWithoutWeight",
     with_node(R"({"kind": "host", "os": {"receive": {"table": [{"value": "2us", "weight": 0}]}}})"),
     R"(2:51: error at /network/nodes/a/os/receive/table: a table without weight: found weights that are all 0, expected at least one positive weight)"},
    {"LatencyBeyondWhatAPortKeeps", with_node(R"({"kind": "host", "os": {"receive": "11s"}})"),
     R"(2:41: error at /network/nodes/a/os/receive: too long to receive: found 11s, expected at most 10s)"},
    {"JitterWithoutALimit", with_node(R"({"kind": "switch", "forwarding_jitter": {"exponential": {"mean": "1us"}}})"),
     R"(2:46: error at /network/nodes/a/forwarding_jitter: a jitter without a limit: found up to 24h, expected a "max" of at most 1s)"},
    {"JitterWhereFramesAreCutThrough",
     with_node(R"({"kind": "switch", "forwarding_jitter": "1us", "egress": [{"cut_through": [3]}]})"),
     R"(2:46: error at /network/nodes/a/forwarding_jitter: jitter where frames are cut through: found "cut_through" in "egress", expected one of them)"},
    {"JitterBesideCyclicQueuing",
     with_node(
         R"({"kind": "switch", "forwarding_jitter": "1us", "ingress": {"cqf": {"cycle": "1ms", "classes": [5, 6]}}})"),
     R"(2:46: error at /network/nodes/a/forwarding_jitter: jitter beside cyclic queuing: found "cqf", whose buffers frames reach at known times, expected one of them)"},
    {"ThreadsThatCannotBe", with_node(R"({"kind": "host", "cpu": {"cores": 2, "threads": [
{"name": "a", "execution": "0s", "policy": "deadline", "priority": 3, "every": "1ms", "offset": "1ms"},
{"name": "a", "execution": "1us", "core": 2, "weight": 9, "offset": "1us", "runs": ["nobody"]},
{"name": "c/d", "execution": "1us", "stack": ["receive"]},
{"name": "e", "execution": "1us", "stack": ["receive", "gptp"]}]}})"),
     R"(3:1: error at /network/nodes/a/cpu/threads/0: missing key: found policy "deadline" alone, expected "deadline"
3:28: error at /network/nodes/a/cpu/threads/0/execution: work that takes no time: found 0s, expected more than 0s; what takes no time needs no thread
3:68: error at /network/nodes/a/cpu/threads/0/priority: does not belong to this policy: found "priority", expected "policy": "fifo"
3:97: error at /network/nodes/a/cpu/threads/0/offset: an offset beyond the interval: found 1ms, expected less than 1ms
4:10: error at /network/nodes/a/cpu/threads/1/name: duplicate name: found "a" a second time, expected a name of its own for each thread of a host
4:43: error at /network/nodes/a/cpu/threads/1/core: no such core: found 2, expected 0 to 1
4:56: error at /network/nodes/a/cpu/threads/1/weight: does not belong to this policy: found "weight", expected "policy": "fair"
4:69: error at /network/nodes/a/cpu/threads/1/offset: does not belong to this thread: found "offset" without "every", expected "every", the interval of a load
4:85: error at /network/nodes/a/cpu/threads/1/runs/0: unknown program: found "nobody", expected a Program, an application, a gateway or an "APPLICATION/THREAD" of "a"
5:10: error at /network/nodes/a/cpu/threads/2/name: not a name for a thread: found "c/d", expected no '/'
6:45: error at /network/nodes/a/cpu/threads/3/stack/0: on two threads: found "receive" a second time, expected one thread for it
6:56: error at /network/nodes/a/cpu/threads/3/stack/1: a part of what is not there: found "gptp", expected "gptp" in "clocks")"},
    {"QueuesOutOfRange",
     with_node(R"({"kind": "host", "queues": {"frames": 0, "octets": "63B", "classes": [{"class": 8}]}})"),
     R"(2:44: error at /network/nodes/a/queues/frames: out of range: found the number 0, expected an integer from 1 to 4294967295
2:57: error at /network/nodes/a/queues/octets: out of range: found "63B", expected a size of at least 64B
2:86: error at /network/nodes/a/queues/classes/0/class: out of range: found the number 8, expected an integer from 0 to 7)"},
    {"NodeTwice", with_network(R"("nodes": {"a": {"kind": "switch"},
"a": {"kind": "host"}})"),
     R"(3:1: error at /network/nodes/a: the name "a" occurs twice: expected one value (the first is in line 2, column 11))"},
    {"NoNodes", with_network(R"()"),
     R"(1:45: error at /network: a network without nodes: found no nodes, expected "nodes" or "generate")"},
    {"NameThatNoLinkCanUse", with_network(R"("nodes": {"x:1": {"kind": "switch"}})"),
     R"(2:18: error at /network/nodes/x:1: not a name for a node: found "x:1", expected at least one character, no ':' and no '/')"},
    {"UnknownNodeInALink", with_links(R"({"ends": ["a", "sw"]},
{"ends": ["b", "sw"]},
{"ends": ["sx", "sw"]})"),
     R"(4:11: error at /network/links/2/ends/0: unknown node: found "sx", expected a name under /network/nodes or of a generated node (did you mean "sw"?))"},
    {"LinkToItself", with_links(R"({"ends": ["a", "sw"]},
{"ends": ["b", "sw"]},
{"ends": ["sw:4", "sw:5"]})"),
     R"(4:10: error at /network/links/2/ends: a link to itself: found both ends at "sw", expected two different nodes)"},
    {"LinkWithOneEnd", with_links(R"({"ends": ["a", "sw"]},
{"ends": ["b", "sw"]},
{"ends": ["sw"]})"),
     R"(4:10: error at /network/links/2/ends: too few items: found 1, expected exactly 2 items)"},
    {"LinkWithThreeEnds", with_links(R"({"ends": ["a", "sw"]},
{"ends": ["b", "sw"]},
{"ends": ["sw", "a", "b"]})"),
     R"(4:10: error at /network/links/2/ends: too many items: found 3, expected exactly 2 items)"},
    {"NamedPortTwice", with_links(R"({"ends": ["a", "sw:2"]},
{"ends": ["b", "sw:2"]})"),
     R"(3:16: error at /network/links/1/ends/1: two links on one port: found "sw:2" a second time, expected a port of its own for each link)"},
    {"TwoLinksAtAHost", with_links(R"({"ends": ["a", "sw"]},
{"ends": ["b", "sw"]},
{"ends": ["b", "sw"]})"),
     R"(4:10: error at /network/links/2/ends: a second link to one neighbour: found two links between "b" and "sw", expected interfaces of a host or station that lead to different nodes)"},
    {"NinthPortOfAHost", with_links(R"({"ends": ["a:8", "sw"]},
{"ends": ["b", "sw"]})"),
     R"(2:11: error at /network/links/0/ends/0: not a port of this node: found port 8, expected ports 0 to 7)"},
    {"NotAPort", with_links(R"({"ends": ["a", "sw:x"]},
{"ends": ["b", "sw:4096"]})"),
     R"(2:16: error at /network/links/0/ends/1: not a port: found "x", expected a number from 0 to 4095 after the ':'
3:16: error at /network/links/1/ends/1: not a port: found "4096", expected a number from 0 to 4095 after the ':')"},
    {"LengthAndDelay", with_links(R"({"ends": ["a", "sw"], "length": "1m", "delay": "5ns"},
{"ends": ["b", "sw"]})"),
     R"(2:48: error at /network/links/0/delay: fields that exclude each other: found "delay" beside "length", expected at most one of "length" or "delay")"},
    {"HalfDuplex", with_links(R"({"ends": ["a", "sw"], "medium": "10BASE-T1S"},
{"ends": ["b", "sw"]})"),
     R"(2:33: error at /network/links/0/medium: a medium in half duplex: found 10BASE-T1S, whose stations share one pair in turns (PLCA) or by collisions, expected a full-duplex medium, such as 10BASE-T1L: no stations of takt share a medium)"},
    {"MediumOfAnotherRate", with_links(R"({"ends": ["a", "sw"], "rate": "1Gbps", "medium": "100BASE-TX"},
{"ends": ["b", "sw"]})"),
     R"(2:31: error at /network/links/0/rate: a rate that the medium does not have: found 1Gbps over 100BASE-TX, expected 100Mbps, or no rate)"},
    {"NineClasses", with_node(R"({"kind": "host", "traffic_classes": 9})"),
     R"(2:42: error at /network/nodes/a/traffic_classes: out of range: found the number 9, expected an integer from 1 to 8)"},
    {"ClassBeyondTheNode",
     with_node(R"({"kind": "host", "traffic_classes": 4, "queues": {"classes": [{"class": 5, "frames": 1}]}})"),
     R"(2:78: error at /network/nodes/a/queues/classes/0/class: a traffic class that the node does not have: found class 5 at "a", expected a class from 0 to 3)"},
    {"GatesWhereThereAreNone",
     with_node(
         R"({"kind": "host", "gates": "none", "egress": [{"gates": {"entries": [{"open": [0], "for": "1us"}]}}]})"),
     R"(2:61: error at /network/nodes/a/egress/0/gates: gates at a node without gates: found a gate list at "a", expected none, or no "gates": "none" of the node or its device)"},
    {"UnitOfNothing", with_links(R"({"ends": ["a", "sw"], "rate": "1Gb"},
{"ends": ["b", "sw"]})"),
     R"(2:31: error at /network/links/0/rate: unknown unit "Gb": found "1Gb", expected one of the units bps, kbps, Mbps, Gbps, Tbps)"},
    {"UnitOfSomethingElse", with_links(R"({"ends": ["a", "sw"], "length": "10ms"},
{"ends": ["b", "sw"]})"),
     R"(2:33: error at /network/links/0/length: unknown unit "ms": found "10ms", expected one of the units mm, cm, m, km (did you mean "10mm"?))"},
    {"NegativeLength", with_links(R"({"ends": ["a", "sw"], "length": "-3m"},
{"ends": ["b", "sw"]})"),
     R"(2:33: error at /network/links/0/length: negative: found "-3m", expected a length that is not negative)"},
    {"RateWithoutExactOctets", with_links(R"({"ends": ["a", "sw"], "rate": "30Mbps"},
{"ends": ["b", "sw"]})"),
     R"(2:31: error at /network/links/0/rate: a rate whose octet does not last a whole number of picoseconds: found 30Mbps, expected a rate that divides 8 Tb/s, the nearest 25.6Mbps and 31.25Mbps, or one of Ethernet such as 10Mbps, 100Mbps, 1Gbps, 2.5Gbps, 5Gbps, 10Gbps, 25Gbps, 40Gbps, 50Gbps or 100Gbps)"},
};

const BadCase generators_cases[] = {
    {"GeneratedNameTwice", with_network(R"("generate": [{"topology": "line", "switches": 2}],
"nodes": {"sw2": {"kind": "switch"}})"),
     R"(3:18: error at /network/nodes/sw2: duplicate node name: found "sw2" a second time, expected a name of its own for each node)"},
    {"TwoGeneratorsWithTheSameNames", with_network(R"("generate": [{"topology": "line", "switches": 1},
{"topology": "line", "switches": 1}])"),
     R"(3:1: error at /network/generate/1: duplicate node name: found "sw1" a second time, expected a name of its own for each node
3:1: error at /network/generate/1: duplicate node name: found "h1" a second time, expected a name of its own for each node)"},
    {"LineWithoutItsSize", generated_text(R"("topology": "line")"),
     R"(2:1: error at /network/generate/0: missing key for this topology: found a line without it, expected "switches")"},
    {"RingOfTwo", generated_text(R"("topology": "ring", "switches": 2)"),
     R"(2:34: error at /network/generate/0/switches: too few for this topology: found 2, expected at least 3)"},
    {"TreeWithSwitches", generated_text(R"("topology": "tree", "switches": 4, "depth": 2)"),
     R"(2:1: error at /network/generate/0: missing key for this topology: found a tree without it, expected "fanout"
2:34: error at /network/generate/0/switches: this topology has no such parameter: found "switches" of a tree)"},
    {"RowsOfALine", generated_text(R"("topology": "line", "switches": 4, "rows": 2)"),
     R"(2:45: error at /network/generate/0/rows: this topology has no such parameter: found "rows" of a line)"},
    {"MeshWithBothSizes", generated_text(R"("topology": "mesh", "switches": 4, "rows": 2, "columns": 2)"),
     R"(2:45: error at /network/generate/0/rows: this topology has no such parameter: found "rows" of a mesh
2:59: error at /network/generate/0/columns: this topology has no such parameter: found "columns" of a mesh)"},
    {"CombWithoutTeeth", generated_text(R"("topology": "comb", "switches": 4)"),
     R"(2:1: error at /network/generate/0: missing key for this topology: found a comb without it, expected "teeth")"},
    {"TeethOfALine", generated_text(R"("topology": "line", "switches": 4, "teeth": 2, "degree": 2, "seed": 3)"),
     R"(2:46: error at /network/generate/0/teeth: this topology has no such parameter: found "teeth" of a line
2:59: error at /network/generate/0/degree: this topology has no such parameter: found "degree" of a line
2:70: error at /network/generate/0/seed: this topology has no such parameter: found "seed" of a line)"},
    {"RandomWithoutDegree", generated_text(R"("topology": "random", "switches": 4)"),
     R"(2:1: error at /network/generate/0: missing key for this topology: found a random without it, expected "degree")"},
    {"TooFewLinks", generated_text(R"("topology": "random", "switches": 10, "degree": 1)"),
     R"(2:50: error at /network/generate/0/degree: no connected graph has this degree: found 5 links between 10 switches, expected 9 to 45 links)"},
    {"TooManyLinks", generated_text(R"("topology": "random", "switches": 4, "degree": 4)"),
     R"(2:49: error at /network/generate/0/degree: no connected graph has this degree: found 8 links between 4 switches, expected 3 to 6 links)"},
    {"AMillionLinks", generated_text(R"("topology": "random", "switches": 2000, "degree": 1000)"),
     R"(2:52: error at /network/generate/0/degree: too many links: found 1000000 links between 2000 switches, expected 1999 to 200000 links)"},
    {"RandomOfABillion", generated_text(R"("topology": "random", "switches": 1000000000, "degree": 2)"),
     R"(2:1: error at /network/generate/0: too many nodes: found 1000000000 switches and 1000000000 hosts, expected at most 200000 nodes in a scenario, 600 switches in a full mesh)"},
    {"CombOfABillion", generated_text(R"("topology": "comb", "switches": 1000000000, "teeth": 1000000000)"),
     R"(2:1: error at /network/generate/0: too many nodes: found 1000000001000000000 switches and 1000000001000000000 hosts, expected at most 200000 nodes in a scenario, 600 switches in a full mesh)"},
    {"DualStarWithoutItsSize", generated_text(R"("topology": "dual-star")"),
     R"(2:1: error at /network/generate/0: missing key for this topology: found a dual-star without it, expected "switches")"},
    {"LineOfABillion", generated_text(R"("topology": "line", "switches": 1000000000)"),
     R"(2:1: error at /network/generate/0: too many nodes: found 1000000000 switches and 1000000000 hosts, expected at most 200000 nodes in a scenario, 600 switches in a full mesh)"},
    {"RingOfABillion", generated_text(R"("topology": "ring", "switches": 1000000000)"),
     R"(2:1: error at /network/generate/0: too many nodes: found 1000000000 switches and 1000000000 hosts, expected at most 200000 nodes in a scenario, 600 switches in a full mesh)"},
    {"StarOfABillion", generated_text(R"("topology": "star", "switches": 1000000000)"),
     R"(2:1: error at /network/generate/0: too many nodes: found 1000000000 switches and 999999999 hosts, expected at most 200000 nodes in a scenario, 600 switches in a full mesh)"},
    {"TreeOfABillion", generated_text(R"("topology": "tree", "depth": 9, "fanout": 10)"),
     R"(2:1: error at /network/generate/0: too many nodes: found 1111111 switches and 1000000 hosts, expected at most 200000 nodes in a scenario, 600 switches in a full mesh)"},
    {"DeepestAndWidestTree", generated_text(R"("topology": "tree", "depth": 64, "fanout": 1000000000000)"),
     R"(2:1: error at /network/generate/0: too many nodes: found 1000000000001 switches and 1000000000000 hosts, expected at most 200000 nodes in a scenario, 600 switches in a full mesh)"},
    {"MeshOfABillion", generated_text(R"("topology": "mesh", "switches": 1000000000)"),
     R"(2:1: error at /network/generate/0: too many nodes: found 1000200000 switches and 1000200000 hosts, expected at most 200000 nodes in a scenario, 600 switches in a full mesh)"},
    {"GridOfABillionSquared", generated_text(R"("topology": "mesh", "rows": 1000000000, "columns": 1000000000)"),
     R"(2:1: error at /network/generate/0: too many nodes: found 1000000000000000000 switches and 1000000000000000000 hosts, expected at most 200000 nodes in a scenario, 600 switches in a full mesh)"},
    {"BillionHostsAtASwitch", generated_text(R"("topology": "line", "switches": 1, "hosts_per_switch": 1000000000)"),
     R"(2:1: error at /network/generate/0: too many nodes: found 1 switches and 1000000000 hosts, expected at most 200000 nodes in a scenario, 600 switches in a full mesh)"},
    {"MostHostsAtMostSwitches",
     generated_text(R"("topology": "line", "switches": 1000000000000, "hosts_per_switch": 1000000000000)"),
     R"(2:1: error at /network/generate/0: too many nodes: found 1000000000000 switches and 1000000000000000000000000 hosts, expected at most 200000 nodes in a scenario, 600 switches in a full mesh)"},
    {"FullMeshBeyondItsLinks", generated_text(R"("topology": "mesh", "switches": 601)"),
     R"(2:1: error at /network/generate/0: too many nodes: found 200601 switches and 200601 hosts, expected at most 200000 nodes in a scenario, 600 switches in a full mesh)"},
    {"MoreSwitchesThanTheFieldTakes", generated_text(R"("topology": "line", "switches": 1000000000001)"),
     R"(2:34: error at /network/generate/0/switches: out of range: found the number 1000000000001, expected an integer from 1 to 1000000000000)"},
    {"MoreHostsThanPorts", generated_text(R"("topology": "line", "switches": 1, "hosts_per_switch": 4097)"),
     R"(2:1: error at /network/generate/0: too many links at one node: found 4097, expected at most 4096)"},
    {"MoreHostsThanPortNumbers", generated_text(R"("topology": "line", "switches": 1, "hosts_per_switch": 150000)"),
     R"(2:1: error at /network/generate/0: too many links at one node: found 150000, expected at most 4096)"},
};

INSTANTIATE_TEST_SUITE_P(BadNetwork, BadInput, testing::ValuesIn(nodes_cases), name_of_case);
INSTANTIATE_TEST_SUITE_P(BadGenerator, BadInput, testing::ValuesIn(generators_cases), name_of_case);

}  // namespace
}  // namespace takt::scenario::test::bad_network_test
