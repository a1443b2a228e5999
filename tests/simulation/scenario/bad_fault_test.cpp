// SPDX-License-Identifier: Apache-2.0
// Faults and rerouting that name what is not there, cannot happen or would do nothing.
#include "bad_input.hpp"

namespace takt::scenario::test::bad_fault_test {
namespace {

/// `text` is the list of faults, from column 1 of line 2 on, in a network a - sw - b with another switch at sw.
std::string with_faults(const std::string& text) {
  return R"({"name": "t", "duration": "1ms", "network": {"nodes": {)" + two_hosts +
         R"(, "far": {"kind": "switch"}}, "links": [)" + two_links +
         R"(, {"ends": ["sw", "far"]}]}, "streams": [{"name": "control", "from": "a", "to": "b", "payload": "100B", "every": "100us", "pcp": 3}], "faults": [
)" + text +
         "]}";
}
/// The same beside a program, in line 3.
std::string with_faults_of_program(const std::string& text) {
  return scenario_with(one_program + ", \"faults\": [\n" + text + "]");
}

const BadCase cases[] = {
    {"UnknownKind", with_faults(R"({"kind": "link-dwn", "link": ["a", "sw"], "at": "1us"})"),
     R"(2:10: error at /faults/0/kind: unknown kind: found "link-dwn", expected "link-down", "frame-errors", "crash", "babble", "stuck-gate" or "clock" (did you mean "link-down"?))"},
    {"LinkToAnUnknownNode", with_faults(R"({"kind": "link-down", "link": ["a", "ws"], "at": "1us"})"),
     R"(2:37: error at /faults/0/link/1: unknown node: found "ws", expected the name of a node (did you mean "sw"?))"},
    {"NoLink", with_faults(R"({"kind": "link-down", "link": ["a", "b"], "at": "1us"})"),
     R"(2:31: error at /faults/0/link: no link: found none between "a" and "b", expected two nodes that a link joins)"},
    {"LinkWithOneEnd", with_faults(R"({"kind": "link-down", "link": ["a"], "at": "1us"})"),
     R"(2:31: error at /faults/0/link: too few items: found 1, expected exactly 2 items)"},
    {"LinkToItself", with_faults(R"({"kind": "link-down", "link": ["sw", "sw"], "at": "1us"})"),
     R"(2:31: error at /faults/0/link: no link: found none between "sw" and "sw", expected two nodes that a link joins)"},
    {"LinkPorts",
     with_faults(
         R"({"kind": "link-down", "link": ["a", "sw:x"], "at": "1us"}, {"kind": "link-down", "link": ["a", "sw:1"], "at": "1us"}, {"kind": "link-down", "link": ["a:9", "sw"], "at": "1us"})"),
     R"(2:37: error at /faults/0/link/1: not a port: found "sw:x", expected "node:number"
2:90: error at /faults/1/link: no link: found none between "a" and "sw:1", expected two nodes that a link joins
2:149: error at /faults/2/link: no link: found none between "a:9" and "sw", expected two nodes that a link joins)"},
    {"LinkDownAtNoTime", with_faults(R"({"kind": "link-down", "link": ["a", "sw"]})"),
     R"(2:1: error at /faults/0: the field "at" is missing)"},
    {"LinkDownForNoTime", with_faults(R"({"kind": "link-down", "link": ["a", "sw"], "at": "-1us", "for": "0s"})"),
     R"(2:50: error at /faults/0/at: negative: found "-1us", expected a duration that is not negative
2:65: error at /faults/0/for: out of range: found "0s", expected a duration from 1ns to 2400h)"},
    {"AfterTheEnd",
     with_faults(
         R"({"kind": "link-down", "link": ["a", "sw"], "at": "2ms"}, {"kind": "crash", "node": "nobody", "at": "3ms"})"),
     R"(2:50: warning at /faults/0/at: after the end of the simulation: found 2ms, expected at most 1ms
2:84: error at /faults/1/node: unknown node: found "nobody", expected the name of a node
2:100: warning at /faults/1/at: after the end of the simulation: found 3ms, expected at most 1ms)"},
    {"Probabilities",
     with_faults(R"({"kind": "frame-errors", "link": ["a", "sw"], "loss": 1.5, "corruption": -0.1, "duplication": 2})"),
     R"(2:55: error at /faults/0/loss: out of range: found 1.5, expected a number from 0 to 1
2:74: error at /faults/0/corruption: out of range: found -0.1, expected a number from 0 to 1
2:95: error at /faults/0/duplication: out of range: found 2, expected a number from 0 to 1)"},
    {"NothingGoesWrong", with_faults(R"({"kind": "frame-errors", "link": ["a", "sw"]})"),
     R"(2:1: error at /faults/0: nothing goes wrong: found no probability, expected "loss", "burst_loss", "corruption", "bit_error_rate" or "duplication")"},
    {"TwoLosses",
     with_faults(
         R"({"kind": "frame-errors", "link": ["a", "sw"], "loss": 0.1, "burst_loss": {"good_to_bad": 0.1, "bad_to_good": 0.2}})"),
     R"(2:74: error at /faults/0/burst_loss: fields that exclude each other: found "burst_loss" beside "loss", expected at most one of "loss" or "burst_loss")"},
    {"TwoKindsOfDamage",
     with_faults(R"({"kind": "frame-errors", "link": ["a", "sw"], "corruption": 0.1, "bit_error_rate": 1e-9})"),
     R"(2:84: error at /faults/0/bit_error_rate: fields that exclude each other: found "bit_error_rate" beside "corruption", expected at most one of "corruption" or "bit_error_rate")"},
    {"TowardsWhom",
     with_faults(
         R"({"kind": "frame-errors", "link": ["a", "sw"], "loss": 0.1, "towards": "b"}, {"kind": "frame-errors", "link": ["a", "sw"], "loss": 0.1, "towards": "c"})"),
     R"(2:71: error at /faults/0/towards: not an end of the link: found "b", expected "a" or "sw"
2:147: error at /faults/1/towards: unknown node: found "c", expected the name of a node)"},
    {"BurstProbabilities",
     with_faults(
         R"({"kind": "frame-errors", "link": ["a", "sw"], "burst_loss": {"good_to_bad": 1.01, "bad_to_good": 1, "loss_in_bad": -1}})"),
     R"(2:77: error at /faults/0/burst_loss/good_to_bad: out of range: found 1.01, expected a number from 0 to 1
2:116: error at /faults/0/burst_loss/loss_in_bad: out of range: found -1, expected a number from 0 to 1)"},
    {"CrashOfAnUnknownNode", with_faults(R"({"kind": "crash", "node": "sv", "at": "1us"})"),
     R"(2:27: error at /faults/0/node: unknown node: found "sv", expected the name of a node (did you mean "sw"?))"},
    {"BabbleOfAnUnknownStream", with_faults(R"({"kind": "babble", "stream": "contrl", "at": "1us"})"),
     R"(2:30: error at /faults/0/stream: unknown stream: found "contrl", expected the name of an entry of "streams" (did you mean "control"?))"},
    {"BabbleOfAProgram", with_faults_of_program(R"({"kind": "babble", "stream": "p/state/a", "at": "1us"})"),
     R"(3:30: error at /faults/0/stream: unknown stream: found "p/state/a", expected the name of an entry of "streams")"},
    {"BabbleAtNoInterval", with_faults(R"({"kind": "babble", "stream": "control", "at": "1us", "every": "0s"})"),
     R"(2:63: error at /faults/0/every: out of range: found "0s", expected a duration from 1ns to 2400h)"},
    {"StuckGateOutOfRange",
     with_faults(R"({"kind": "stuck-gate", "node": "sw", "class": 9, "state": "shut", "at": "1us"})"),
     R"(2:47: error at /faults/0/class: out of range: found the number 9, expected an integer from 0 to 7
2:59: error at /faults/0/state: unknown name for how a gate is stuck: found "shut", expected "open" or "closed")"},
    {"StuckGateToNobody",
     with_faults(
         R"({"kind": "stuck-gate", "node": "sw", "to": "c", "class": 3, "state": "closed", "at": "1us"}, {"kind": "stuck-gate", "node": "a", "to": "b", "class": 3, "state": "closed", "at": "1us"})"),
     R"(2:44: error at /faults/0/to: not a neighbour: found "c", expected a node that a link joins to "sw"
2:136: error at /faults/1/to: not a neighbour: found "b", expected a node that a link joins to "a")"},
    {"ReroutingBesideARoute",
     scenario_with(
         R"("rerouting": {"delay": "1ms"}, "streams": [{"name": "s", "from": "a", "to": "b", "payload": "100B", "every": "1ms", "route": "auto"}])"),
     R"(2:14: warning at /rerouting: nothing to reroute for: found no "faults", expected a fault that takes a link down
2:126: error at /streams/0/route: a route beside rerouting: found "auto" beside "rerouting", which takes the shortest paths that are left, expected one of the two)"},
    {"ReroutingWithoutADelay", scenario_with(R"("rerouting": {}, "faults": [])"),
     R"(2:14: error at /rerouting: the field "delay" is missing
2:14: warning at /rerouting: nothing to reroute for: found no "faults", expected a fault that takes a link down)"},
    {"ReroutingInThePast", scenario_with(R"("rerouting": "-1ms")"),
     R"(2:14: error at /rerouting: negative: found "-1ms", expected a duration that is not negative
2:14: warning at /rerouting: nothing to reroute for: found no "faults", expected a fault that takes a link down)"},
};

INSTANTIATE_TEST_SUITE_P(BadFaults, BadInput, testing::ValuesIn(cases), name_of_case);

}  // namespace
}  // namespace takt::scenario::test::bad_fault_test
