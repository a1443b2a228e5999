// SPDX-License-Identifier: Apache-2.0
// Streams that cannot be. Programs, scripts and requirements that cannot be.
#include "bad_input.hpp"

namespace takt::scenario::test::bad_traffic_test {
namespace {

const BadCase streams_cases[] = {
    {"UnknownSender", with_streams(R"({"name": "s", "from": "A", "to": "b", "payload": "100B", "every": "1ms"})"),
     R"(2:23: error at /streams/0/from: unknown node: found "A", expected the name of a host or station (did you mean "a"?))"},
    {"SwitchAsReceiver", with_streams(R"({"name": "s", "from": "a", "to": "sw", "payload": "100B", "every": "1ms"})"),
     R"(2:34: error at /streams/0/to: not a host: found the switch "sw", expected the name of a host or station)"},
    {"ReceiverTwice",
     with_streams(R"({"name": "s", "from": "a", "to": ["b", "b"], "payload": "100B", "every": "1ms"})"),
     R"(2:40: error at /streams/0/to/1: a receiver twice: found "b", expected each receiver once)"},
    {"NoReceivers", with_streams(R"({"name": "s", "from": "a", "to": [], "payload": "100B", "every": "1ms"})"),
     R"(2:34: error at /streams/0/to: wrong type: found an empty array, expected the name of a host or an array of names)"},
    {"ToItself", with_streams(R"({"name": "s", "from": "a", "to": "a", "payload": "100B", "every": "1ms"})"),
     R"(2:34: error at /streams/0/to: a stream to its own sender: found "a", expected another host)"},
    {"UnreachableReceiver",
     R"({"name": "t", "duration": "1ms", "network": {"nodes": {"a": {"kind": "host"}, "b": {"kind": "host"}, "sw": {"kind": "switch"}}, "links": [{"ends": ["a", "sw"]}]},
"streams": [
{"name": "s", "from": "a", "to": "b", "payload": "100B", "every": "1ms"}]})",
     R"(1:84: warning at /network/nodes/b: a host without a link: found "b"
3:34: error at /streams/0/to: no path: found "b" cannot be reached from "a", expected links that join them over switches)"},
    {"TwoStreamsOfOneName", with_streams(R"({"name": "s", "from": "a", "to": "b", "payload": "100B", "every": "1ms"},
{"name": "s", "from": "a", "to": "b", "payload": "100B", "every": "1ms"})"),
     R"(3:10: error at /streams/1/name: duplicate name: found "s" a second time, expected a name of its own for each stream, program and application)"},
    {"SlashInAName", with_streams(R"({"name": "a/b", "from": "a", "to": "b", "payload": "100B", "every": "1ms"})"),
     R"(2:10: error at /streams/0/name: not a name for a stream, program or application: found "a/b", expected no '/', which stands in the names of streams)"},
    {"NoSchedule", with_streams(R"({"name": "s", "from": "a", "to": "b", "payload": "100B"})"),
     R"(2:1: error at /streams/0: a field is missing: expected exactly one of "every", "exponential", "normal", "burst" or "trace")"},
    {"TwoSchedules",
     with_streams(R"({"name": "s", "from": "a", "to": "b", "payload": "100B", "every": "1ms", "exponential": "1ms"})"),
     R"(2:89: error at /streams/0/exponential: fields that exclude each other: found "exponential" beside "every", expected exactly one of "every", "exponential", "normal", "burst" or "trace")"},
    {"BeyondOneFrame", with_streams(R"({"name": "s", "from": "a", "to": "b", "payload": "1473B", "every": "1ms"})"),
     R"(2:50: error at /streams/0/payload: more than one frame: found 1501 octets after the EtherType, expected at most 1500 with all headers, or jumbo frames, by "mtu" of "network" or of each node on the path)"},
    {"BeyondOneFrameWithoutHeaders",
     with_streams(
         R"({"name": "s", "from": "a", "to": "b", "payload": "1501B", "every": "1ms", "encapsulation": "ethernet"})"),
     R"(2:50: error at /streams/0/payload: more than one frame: found 1501 octets after the EtherType, expected at most 1500 with all headers, or jumbo frames, by "mtu" of "network" or of each node on the path)"},
    {"BeyondAnyFrame",
     with_streams(
         R"({"name": "s", "from": "a", "to": "b", "payload": "9001B", "every": "1ms", "encapsulation": "ethernet"})"),
     R"(2:50: error at /streams/0/payload: out of range: found "9001B", expected a size of at most 9000B)"},
    {"NormalGapsWithoutTheirMean",
     with_streams(
         R"({"name": "s", "from": "a", "to": "b", "payload": "100B", "normal": {"mean": "1ms", "deviation": "1us", "min": "2ms"}})"),
     R"(2:77: error at /streams/0/normal/mean: a mean outside of what is left of the distribution: found 1ms, expected at least 2ms)"},
    {"NormalGapsAbove",
     with_streams(
         R"({"name": "s", "from": "a", "to": "b", "payload": "100B", "normal": {"mean": "1ms", "deviation": "1us", "min": "1us", "max": "9us"}})"),
     R"(2:77: error at /streams/0/normal/mean: a mean outside of what is left of the distribution: found 1ms, expected 1us to 9us)"},
    {"NormalGapsThatAreAllAlike",
     with_streams(
         R"({"name": "s", "from": "a", "to": "b", "payload": "100B", "normal": {"mean": "1ms", "deviation": "1us", "min": "1ms", "max": "1ms"}})"),
     R"(2:125: error at /streams/0/normal/max: gaps that are all alike: found "min" and "max" of 1ms, expected a "max" above, or "every")"},
    {"NormalGapsWithoutDeviation",
     with_streams(
         R"({"name": "s", "from": "a", "to": "b", "payload": "100B", "normal": {"mean": "1ms", "deviation": "0us"}})"),
     R"(2:97: error at /streams/0/normal/deviation: out of range: found "0us", expected a duration from 1ps to 1h)"},
    {"EndBeforeTheBeginning",
     with_streams(
         R"({"name": "s", "from": "a", "to": "b", "payload": "100B", "every": "1ms", "offset": "2ms", "until": "2ms"})"),
     R"(2:100: error at /streams/0/until: a stream that ends before it begins: found 2ms, expected more than its "offset" of 2ms)"},
    {"EndAtTheStart",
     with_streams(R"({"name": "s", "from": "a", "to": "b", "payload": "100B", "every": "1ms", "until": "0s"})"),
     R"(2:83: error at /streams/0/until: out of range: found "0s", expected a duration from 1ns to 24h)"},
    {"JitterAboveThePeriod",
     with_streams(R"({"name": "s", "from": "a", "to": "b", "payload": "100B", "every": "1ms", "jitter": "2ms"})"),
     R"(2:84: error at /streams/0/jitter: jitter above the period: found 2ms, expected at most 1ms)"},
    {"JitterOfABurst",
     with_streams(
         R"({"name": "s", "from": "a", "to": "b", "payload": "100B", "burst": {"frames": 2, "every": "1ms"}, "jitter": "1us"})"),
     R"(2:108: error at /streams/0/jitter: jitter belongs to a periodic stream: found "jitter" without "every", expected "every")"},
    {"BurstLongerThanItsPeriod",
     with_streams(
         R"({"name": "s", "from": "a", "to": "b", "payload": "100B", "burst": {"frames": 12, "every": "1ms", "spacing": "100us"}})"),
     R"(2:67: error at /streams/0/burst: a burst longer than its period: found 12 frames 100us apart, expected at most 1ms)"},
    {"RouteThatIsNone",
     with_streams(R"({"name": "s", "from": "a", "to": "b", "payload": "100B", "every": "1ms", "route": "shortest"})"),
     R"(2:83: error at /streams/0/route: unknown name for a route: found "shortest", expected "auto")"},
    {"RouteBesideAPath",
     with_streams(
         R"({"name": "s", "from": "a", "to": "b", "payload": "100B", "every": "1ms", "path": ["a", "sw", "b"], "route": "auto"})"),
     R"(2:109: error at /streams/0/route: two ways of one stream: found "route" beside "path", expected one of the two)"},
    {"RouteToSeveral",
     with_streams(
         R"({"name": "s", "from": "a", "to": ["b", "b"], "payload": "100B", "every": "1ms", "route": "auto"})"),
     R"(2:40: error at /streams/0/to/1: a receiver twice: found "b", expected each receiver once
2:90: error at /streams/0/route: a route for several receivers: found 2 receivers, expected one receiver)"},
    {"VlanWithoutPriority",
     with_streams(R"({"name": "s", "from": "a", "to": "b", "payload": "100B", "every": "1ms", "vlan": 5})"),
     R"(2:82: error at /streams/0/vlan: a VLAN without a priority: found "vlan" alone, expected "pcp" too, since the tag carries both)"},
    {"TwoPriorities",
     with_streams(
         R"({"name": "s", "from": "a", "to": "b", "payload": "100B", "every": "1ms", "pcp": 3, "host_priority": 5})"),
     R"(2:101: error at /streams/0/host_priority: two priorities: found "host_priority" beside "pcp", expected "pcp" alone, by which the host queues tagged frames, too)"},
    {"PriorityThatIsNone",
     with_streams(R"({"name": "s", "from": "a", "to": "b", "payload": "100B", "every": "1ms", "pcp": 8})"),
     R"(2:81: error at /streams/0/pcp: out of range: found the number 8, expected an integer from 0 to 7)"},
    {"OverloadedLink", with_streams(R"({"name": "s", "from": "a", "to": "b", "payload": "1472B", "every": "12us"})"),
     R"(1:45: error at /network: an overloaded link: found 102.5 % from "a" to "sw", expected at most 100 % (or "allow_overload": true)
1:45: error at /network: an overloaded link: found 102.5 % from "sw" to "b", expected at most 100 % (or "allow_overload": true))"},
    {"MissingTrace", with_streams(R"({"name": "s", "from": "a", "to": "b", "payload": "100B", "trace": "none.csv"})"),
     R"(2:67: error at /streams/0/trace: cannot read the trace: found "none.csv", expected a CSV file)"},
    {"PathOverAHost",
     with_streams(
         R"({"name": "s", "from": "a", "to": "b", "payload": "100B", "every": "1ms", "path": ["a", "sw", "b", "sw"]})"),
     R"(2:94: error at /streams/0/path/2: a host inside a path: found "b", expected a switch or a station, since hosts do not forward
2:99: error at /streams/0/path/3: a node twice in one path: found "sw", expected each node once)"},
    {"PathWithAGap",
     with_streams(R"({"name": "s", "from": "a", "to": "b", "payload": "100B", "every": "1ms", "path": ["a", "b"]})"),
     R"(2:88: error at /streams/0/path/1: no link: found none between "a" and "b", expected neighbours along the path)"},
    {"PathBetweenOthers",
     with_streams(
         R"({"name": "s", "from": "a", "to": "b", "payload": "100B", "every": "1ms", "path": ["b", "sw", "a"]})"),
     R"(2:82: error at /streams/0/path: a path between other nodes: found "b" to "a", expected "a" to "b")"},
    {"PathForAMulticast",
     R"({"name": "t", "duration": "1ms", "network": {"generate": [{"topology": "line", "switches": 3}]},
"streams": [
{"name": "s", "from": "h1", "to": ["h2", "h3"], "payload": "100B", "every": "1ms", "path": ["h1", "sw1", "sw2", "h2"]}]})",
     R"(3:92: error at /streams/0/path: a path for several receivers: found 2 receivers, expected one receiver)"},
};

const BadCase programs_cases[] = {
    {"UnknownSlave", with_programs(R"({"name": "p", "master": "a", "slaves": ["bb"], "cycle": "1ms"})"),
     R"(2:41: error at /programs/0/slaves/0: unknown node: found "bb", expected the name of a host or station (did you mean "b"?))"},
    {"HostTwice", with_programs(R"({"name": "p", "master": "a", "slaves": ["b", "a"], "cycle": "1ms"})"),
     R"(2:46: error at /programs/0/slaves/1: a node twice in one program: found "a", which is the master, expected each participant on a node of its own)"},
    {"NoSlaves", with_programs(R"({"name": "p", "master": "a", "slaves": [], "cycle": "1ms"})"),
     R"(2:40: error at /programs/0/slaves: too few items: found 0, expected 1 to 64 items)"},
    {"SwitchAsMaster", with_programs(R"({"name": "p", "master": "sw", "slaves": ["b"], "cycle": "1ms"})"),
     R"(2:25: error at /programs/0/master: not a host: found the switch "sw", expected the name of a host or station)"},
    {"TwoProgramsOfOneName", with_programs(R"({"name": "p", "master": "a", "slaves": ["b"], "cycle": "1ms"},
{"name": "p", "master": "a", "slaves": ["b"], "cycle": "1ms"})"),
     R"(3:10: error at /programs/1/name: duplicate name: found "p" a second time, expected a name of its own for each stream, program and application)"},
    {"ProgramNamedAsAStream",
     scenario_with(R"("streams": [{"name": "p", "from": "a", "to": "b", "payload": "100B", "every": "1ms"}],
"programs": [{"name": "p", "master": "a", "slaves": ["b"], "cycle": "1ms"}])"),
     R"(3:23: error at /programs/0/name: duplicate name: found "p" a second time, expected a name of its own for each stream, program and application)"},
    {"TimeOutWithinOneCycle",
     with_programs(R"({"name": "p", "master": "a", "slaves": ["b"], "cycle": "1ms", "receive_timeout": "1ms"})"),
     R"(2:82: error at /programs/0/receive_timeout: a time-out within one cycle: found 1ms, expected more than the cycle of 1ms)"},
    {"OffsetBeyondTheCycle",
     with_programs(R"({"name": "p", "master": "a", "slaves": ["b"], "cycle": "1ms", "offset": "1ms"})"),
     R"(2:73: error at /programs/0/offset: an offset beyond the cycle: found 1ms, expected less than 1ms)"},
    {"CycleTooShort",
     with_programs(R"({"name": "p", "master": "a", "slaves": ["b"], "cycle": "999ns", "receive_timeout": "1s"})"),
     R"(2:56: error at /programs/0/cycle: out of range: found "999ns", expected a duration from 1us to 1h)"},
    {"ProcessDataOfAStranger",
     with_programs(
         R"({"name": "p", "master": "a", "slaves": ["b"], "cycle": "1ms", "process_data": [{"name": "d", "from": "sw", "fields": {"x": "Double"}}]})"),
     R"(2:102: error at /programs/0/process_data/0/from: not a participant of the program: found "sw", expected the master or a slave of "p")"},
    {"ProcessDataTwice",
     with_programs(
         R"({"name": "p", "master": "a", "slaves": ["b"], "cycle": "1ms", "process_data": [{"name": "d", "from": "a", "fields": {"x": "Double"}},
{"name": "d", "from": "b", "fields": {"x": "Double"}}]})"),
     R"(3:10: error at /programs/0/process_data/1/name: duplicate name: found "d", expected a name of its own for each data set ("state" is taken))"},
    {"ProcessDataNamedState",
     with_programs(
         R"({"name": "p", "master": "a", "slaves": ["b"], "cycle": "1ms", "process_data": [{"name": "state", "from": "a", "fields": {"x": "Double"}}]})"),
     R"(2:89: error at /programs/0/process_data/0/name: duplicate name: found "state", expected a name of its own for each data set ("state" is taken))"},
    {"ProcessDataBeyondOneFrame",
     with_programs(
         R"({"name": "p", "master": "a", "slaves": ["b"], "cycle": "1ms", "process_data": [{"name": "d", "from": "a", "fields": {"x": {"type": "Double", "count": 187}}}]})"),
     R"(2:117: error at /programs/0/process_data/0/fields: more than one frame: found 1520 octets with all headers, expected at most 1500)"},
    {"UnknownDataType",
     with_programs(
         R"({"name": "p", "master": "a", "slaves": ["b"], "cycle": "1ms", "process_data": [{"name": "d", "from": "a", "fields": {"x": "double"}}]})"),
     R"(2:123: error at /programs/0/process_data/0/fields/x: unknown name for an OPC UA data type: found "double", expected "Boolean", "SByte", "Byte", "Int16", "UInt16", "Int32", "UInt32", "Int64", "UInt64", "Float" or "Double" (did you mean "Double"?))"},
    {"ScriptOfAnUnknownProgram", with_script(R"({"at": "1us", "program": "q", "call": "Start"})"),
     R"(2:26: error at /script/0/program: unknown program: found "q", expected the name of a program)"},
    {"StartAtASlave", with_script(R"({"at": "1us", "program": "p", "call": "Start", "on": "b"})"),
     R"(2:54: error at /script/0/on: Start at a slave: found "b", expected the master, "a")"},
    {"CallOnAStranger", with_script(R"({"at": "1us", "program": "p", "call": "Halt", "on": "sw"})"),
     R"(2:53: error at /script/0/on: not a participant of the program: found "sw", expected the master or a slave of "p")"},
    {"UnknownMethod", with_script(R"({"at": "1us", "program": "p", "call": "start"})"),
     R"(2:39: error at /script/0/call: unknown name for a Program control method: found "start", expected "Start", "Suspend", "Resume", "Halt" or "Reset" (did you mean "Start"?))"},
    {"RequirementOfNothing", with_requirement(R"({"within": "1ms"})"),
     R"(2:1: error at /require/0: a field is missing: expected exactly one of "reaction", "stream", "sync", "clocks", "application", "signal" or "figure")"},
    {"ReactionWithoutLimit", with_requirement(R"({"reaction": "start"})"),
     R"(2:1: error at /require/0: missing key: found "reaction" without a limit, expected "within", "late_in_a_row" or "met")"},
    {"ReactionOfAnUnknownProgram", with_requirement(R"({"reaction": "start", "program": "P", "within": "1ms"})"),
     R"(2:34: error at /require/0/program: unknown program: found "P", expected the name of a program (did you mean "p"?))"},
    {"ReactionWithoutAProgram", scenario_with(R"("require": [{"reaction": "start", "within": "1ms"}])"),
     R"(2:26: error at /require/0/reaction: a reaction without a program: found no programs, expected "programs")"},
    {"ReactionAndStream",
     with_requirement(R"({"reaction": "start", "within": "1ms", "stream": "p/state/a", "latency": "1ms"})"),
     R"(2:50: error at /require/0/stream: fields that exclude each other: found "stream" beside "reaction", expected exactly one of "reaction", "stream", "sync", "clocks", "application", "signal" or "figure"
2:74: error at /require/0/latency: does not belong to this requirement: found "latency", expected a requirement with "stream")"},
    {"LimitOfTheOtherSubject", with_requirement(R"({"reaction": "start", "within": "1ms", "latency": "1ms"})"),
     R"(2:51: error at /require/0/latency: does not belong to this requirement: found "latency", expected a requirement with "stream")"},
    {"StreamWithoutLimit", with_requirement(R"({"stream": "p/state/a"})"),
     R"(2:1: error at /require/0: missing key: found "stream" without a limit, expected "latency", "jitter", )"
     R"("dropped", "delivered", "lost_in_a_row", "late_in_a_row" or "met")"},
    {"FigureWithoutLimit", with_requirement(R"({"figure": "dropped"})"),
     R"(2:1: error at /require/0: missing key: found "figure" without a limit, expected "at_most", "at_least" or "equal")"},
    {"UnknownFigure", with_requirement(R"({"figure": "/events/0", "at_most": 1})"),
     R"(2:12: error at /require/0/figure: unknown figure: found "/events/0", expected /events, which has no members)"},
    {"UnknownStream", with_requirement(R"({"stream": "p/state/c", "latency": "1ms"})"),
     R"(2:12: error at /require/0/stream: unknown stream: found "p/state/c", expected the name of a stream (did you mean "p/state/a"?))"},
    {"StreamOfAProgramWithAMistake",
     scenario_with(
         R"("programs": [{"name": "p", "master": "a", "slaves": ["x"], "cycle": "1ms"}], "require": [{"stream": "p/state/a", "latency": "1ms"}])"),
     R"(2:54: error at /programs/0/slaves/0: unknown node: found "x", expected the name of a host or station)"},
};

INSTANTIATE_TEST_SUITE_P(BadStream, BadInput, testing::ValuesIn(streams_cases), name_of_case);
INSTANTIATE_TEST_SUITE_P(BadProgram, BadInput, testing::ValuesIn(programs_cases), name_of_case);

}  // namespace
}  // namespace takt::scenario::test::bad_traffic_test
