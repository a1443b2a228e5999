// SPDX-License-Identifier: Apache-2.0
// Automatic gates that cannot be: everything that is said about them.
#include "bad_input.hpp"

namespace takt::scenario::test::bad_gates_test {
namespace {

const std::string three =
    R"({"name": "t", "duration": "1ms", "network": {"generate": [{"topology": "line", "switches": 2, "hosts_per_switch": 2}]}, "streams": [)";
/// `text` is what stands behind the streams; "gates" begins in line 2.
std::string with(const std::string& streams, const std::string& text) { return three + streams + "],\n" + text + "}"; }
/// `text` is a stream that begins in line 2.
std::string scheduled(const std::string& text, const std::string& gates = R"({"plan": "auto", "classes": [6]})",
                      const std::string& more = "") {
  return three + "\n" + text + "], \"gates\": " + gates + more + "}";
}
const std::string good =
    R"({"name": "a", "from": "h1", "to": "h3", "payload": "100B", "every": "500us", "offset": "0us", "pcp": 6})";
std::string program(const std::string& more) {
  return with("", R"("gates": "auto", "programs": [{"name": "p", "master": "h1", "slaves": ["h3"], "cycle": "500us")" +
                      more + "}]");
}

/// Switches with these limits; "gates" and the streams follow.
std::string limited(const std::string& of_switches, const std::string& rest) {
  return R"({"name": "t", "duration": "1ms", "network": {"generate": [{"topology": "line", "switches": 2, "hosts_per_switch": 2, )" +
         of_switches + "}]},\n" + rest + "}";
}
const std::string two_of_six =
    R"("streams": [{"name": "a", "from": "h1", "to": "h3", "payload": "100B", "every": "500us", "offset": "0us", "pcp": 6},
{"name": "b", "from": "h2", "to": "h3", "payload": "100B", "every": "500us", "offset": "495us", "pcp": 6}], "gates": {"plan": "auto", "classes": [6]})";

const BadCase cases[] = {
    {"NoPlan", with("", R"("gates": "manual")"),
     R"(2:10: error at /gates: unknown name for a plan of gates: found "manual", expected "none", "auto" or "listed")"},
    {"NoClasses", with(good, R"("gates": "auto")"),
     R"(2:10: error at /gates: missing key: found no programs, whose classes it would be, expected "classes", the scheduled ones)"},
    {"KeysOfOtherPlans",
     with(
         good,
         R"("gates": {"plan": "none", "margin": "1us", "classes": [6], "guard": "longest-frame", "lists": [{"node": "sw1", "gates": {"entries": [{"open": [], "for": "1us"}]}}]})"),
     R"(2:37: error at /gates/margin: does not belong to this plan of gates: found "margin", expected it with "plan": "auto"
2:55: error at /gates/classes: does not belong to this plan of gates: found "classes", expected it with "plan": "auto"
2:69: error at /gates/guard: does not belong to this plan of gates: found "guard", expected it with "plan": "auto"
2:95: error at /gates/lists: does not belong to this plan of gates: found "lists", expected it with "plan": "listed")"},
    {"WayOverASwitchWithoutGates", limited(R"("gates": "none")", two_of_six),
     R"(2:13: error at /streams/0: a stream that no gates can be laid for: found "a" with a way over "sw1", which has no gates, expected what "gates": "auto" can plan, or another class
3:1: error at /streams/1: a stream that no gates can be laid for: found "b" with a way over "sw1", which has no gates, expected what "gates": "auto" can plan, or another class)"},
    {"MarginToMeasure", with(good, R"("gates": {"plan": "auto", "classes": [6], "margin": "auto"})"),
     R"(2:53: error at /gates/margin: a margin that is not known yet: found "auto", expected a duration, or takt schedule SCENARIO --out FILE, which measures it, and then FILE)"},
    {"ListsThatAreLaidOut",
     with(
         good,
         R"("gates": {"plan": "auto", "classes": [6], "lists": [{"node": "sw1", "gates": {"entries": [{"open": [], "for": "1us"}]}}]})"),
     R"(2:52: error at /gates/lists: does not belong to this plan of gates: found "lists", expected it with "plan": "listed")"},
    {"NoOffset", scheduled(R"({"name": "a", "from": "h1", "to": "h3", "payload": "100B", "every": "500us", "pcp": 6})"),
     R"(2:1: error at /streams/0: a stream that no gates can be laid for: found "a" with no "offset" that promises when it is sent, or "auto", expected what "gates": "auto" can plan, or another class)"},
    {"NoPeriod",
     scheduled(R"({"name": "a", "from": "h1", "to": "h3", "payload": "100B", "exponential": "500us", "pcp": 6})"),
     R"(2:1: error at /streams/0: a stream that no gates can be laid for: found "a" with no period: "every" or "burst" is missing, expected what "gates": "auto" can plan, or another class)"},
    {"APeriodOfHalfANanosecond",
     scheduled(
         R"({"name": "a", "from": "h1", "to": "h3", "payload": "100B", "every": "500.0005us", "offset": "0us", "pcp": 6})"),
     R"(2:1: error at /streams/0: a stream that no gates can be laid for: found "a" with a period of 500.0005us, which is no whole number of ns, expected what "gates": "auto" can plan, or another class)"},
    {"JitterOfAPeriod",
     scheduled(
         R"({"name": "a", "from": "h1", "to": "h3", "payload": "100B", "every": "500us", "offset": "0us", "jitter": "500us", "pcp": 6})"),
     R"(2:1: error at /streams/0: a stream that no gates can be laid for: found "a" with up to 500us between the application and the port of its host, of a period of 500us, expected what "gates": "auto" can plan, or another class)"},
    {"ALaunchTime",
     scheduled(
         R"({"name": "a", "from": "h1", "to": "h3", "payload": "100B", "every": "500us", "offset": "0us", "launch": "1us", "pcp": 6})"),
     R"(2:1: error at /streams/0: a stream that no gates can be laid for: found "a" with "launch", which is a plan of its own, expected what "gates": "auto" can plan, or another class)"},
    {"InAnyOrder",
     scheduled(
         good +
         R"(, {"name": "b", "from": "h1", "to": "h3", "payload": "100B", "every": "500us", "offset": "100us", "jitter": "100us", "pcp": 6},
{"name": "c", "from": "h1", "to": "h3", "payload": "100B", "every": "500us", "offset": "150us", "pcp": 6})"),
     R"(3:88: error at /streams/2/offset: frames that may come in any order: found at "h1 to sw1" "b" from 100us to 200us and "c" at 150us of their periods, as operating system and jitter go, expected "offset": "auto", phases that are further apart, or another class, so that the first does not wait in the other's window)"},
    {"TwoAtOnce",
     scheduled(
         good +
         R"(, {"name": "b", "from": "h2", "to": "h3", "payload": "100B", "every": "250us", "offset": "0.5us", "pcp": 6})"),
     R"(2:193: error at /streams/1/offset: windows that overlap: found at "sw1 to sw2" "a" from 1.314us to 2.578us and "b" from 1.814us to 3.078us of each 500us; at "sw2 to h3" "a" from 2.628us to 3.892us and "b" from 3.128us to 4.392us of each 500us, expected "offset": "auto", or offsets or "phases" that keep them apart)"},
    {"FourAtOnce",
     scheduled(
         good +
         R"(, {"name": "b", "from": "h1", "to": "h4", "payload": "100B", "every": "250us", "offset": "1us", "pcp": 6},
{"name": "c", "from": "h2", "to": "h3", "payload": "100B", "every": "500us", "offset": "0.5us", "pcp": 6})"),
     R"(2:193: error at /streams/1/offset: windows that overlap: found at "h1 to sw1" "a" from 0s to 1.264us and "b" from 1us to 2.264us of each 500us; at "sw1 to sw2" "a" from 1.314us to 2.578us and "b" from 2.314us to 3.578us of each 500us, expected "offset": "auto", or offsets or "phases" that keep them apart
3:88: error at /streams/2/offset: windows that overlap: found at "sw1 to sw2" "a" from 1.314us to 2.578us and "c" from 1.814us to 3.078us of each 500us; at "sw1 to sw2" "b" from 2.314us to 3.578us and "c" from 1.814us to 3.078us of each 500us; at "sw2 to h3" "a" from 2.628us to 3.892us and "c" from 3.128us to 4.392us of each 500us, expected "offset": "auto", or offsets or "phases" that keep them apart)"},
    {"FiveAtOnce", scheduled(R"({"name": "b", "from": "h1", "to": "h3", "payload": "100B", "every": "500us", "offset": "10us", "pcp": 6}, {"name": "c", "from": "h1", "to": "h3", "payload": "100B", "every": "500us", "offset": "12us", "pcp": 6}, {"name": "e", "from": "h1", "to": "h3", "payload": "100B", "every": "500us", "offset": "14us", "pcp": 6}, {"name": "f", "from": "h1", "to": "h3", "payload": "100B", "every": "500us", "offset": "16us", "pcp": 6},
{"name": "d", "from": "h1", "to": "h3", "payload": "1400B", "every": "500us", "offset": "9us", "pcp": 6})"),
     R"(3:89: error at /streams/4/offset: windows that overlap: found at "h1 to sw1" "b" from 10us to 11.264us and "d" from 9us to 20.664us of each 500us; at "h1 to sw1" "c" from 12us to 13.264us and "d" from 9us to 20.664us of each 500us; at "h1 to sw1" "e" from 14us to 15.264us and "d" from 9us to 20.664us of each 500us; and 1 more, expected "offset": "auto", or offsets or "phases" that keep them apart)"},
    {"ChosenWithoutAPeriod",
     with(R"({"name": "a", "from": "h1", "to": "h3", "payload": "100B", "exponential": "500us", "offset": "auto"})",
          R"("script": [])"),
     R"(1:226: error at /streams/0/offset: an offset that is chosen belongs to a periodic stream: found "auto" without "every", expected "every", or an offset)"},
    {"TooLongACycle",
     scheduled(
         good +
         R"(, {"name": "b", "from": "h4", "to": "h2", "payload": "100B", "every": "40009us", "offset": "0us", "pcp": 6}, {"name": "c", "from": "h4", "to": "h2", "payload": "100B", "every": "40013us", "offset": "100us", "pcp": 6})"),
     R"(2:281: error at /streams/2/every: gates with too long a cycle: found at "h4 to sw2" 80022 windows or entries in a cycle of 1600.880117s, with "b" every 40.009ms and "c" every 40.013ms; at "sw2 to sw1" 80022 windows or entries in a cycle of 1600.880117s, with "b" every 40.009ms and "c" every 40.013ms; at "sw1 to h2" 80022 windows or entries in a cycle of 1600.880117s, with "b" every 40.009ms and "c" every 40.013ms, expected periods with a common multiple of at most 1h and 65536 windows, and frames that wait for no window where there are more than 1024 entries)"},
    {"AnotherStreamOfTheClass",
     scheduled(good +
               R"(, {"name": "b", "from": "h2", "to": "h3", "payload": "100B", "exponential": "250us", "pcp": 6})"),
     R"(2:106: error at /streams/1: a stream that no gates can be laid for: found "b" with no period: "every" or "burst" is missing, expected what "gates": "auto" can plan, or another class)"},
    {"Rerouted",
     scheduled(good, R"({"plan": "auto", "classes": [6]})",
               ",\n\"faults\": [{\"kind\": \"link-down\", \"link\": [\"sw1\", \"sw2\"], \"at\": \"0.5ms\"}], "
               "\"rerouting\": {\"delay\": \"1us\"}"),
     R"(3:88: error at /rerouting: rerouting of scheduled streams: found "rerouting" beside "gates": "auto", whose windows lie along one path, expected one of the two)"},
    {"ProgramWithoutPhases", program(""),
     R"(2:31: error at /programs/0: a stream that no gates can be laid for: found "p/state/h1" with no "offset" or "phases" that promises when "h1" publishes, or "auto", expected what "gates": "auto" can plan, or another class
2:31: error at /programs/0: a stream that no gates can be laid for: found "p/state/h3" with no "offset" or "phases" that promises when "h3" publishes, or "auto", expected what "gates": "auto" can plan, or another class)"},
    {"ProgramThatPublishesOnChange", program(R"(, "offset": "0us", "publish": "on-change")"),
     R"(2:31: error at /programs/0: a stream that no gates can be laid for: found "p/state/h1" with "publish": "on-change", at no known time, expected what "gates": "auto" can plan, or another class
2:31: error at /programs/0: a stream that no gates can be laid for: found "p/state/h3" with "publish": "on-change", at no known time, expected what "gates": "auto" can plan, or another class)"},
    {"GptpInTheClass",
     scheduled(
         R"({"name": "a", "from": "h1", "to": "h3", "payload": "100B", "every": "500us", "offset": "0us", "pcp": 7})",
         "\n{\"plan\": \"auto\", \"classes\": [7]}", ", \"clocks\": {\"gptp\": {}}"),
     R"(3:1: error at /gates: gPTP in a scheduled class: found the class of priority 7 is scheduled, expected other classes, since messages of gPTP have priority 7)"},
    {"MoreEntriesThanTheDeviceHas", limited(R"("gate_limits": {"entries": 2})", two_of_six), R"(1:133: error at /network/generate/0/gate_limits: gates beyond what the device can do: found "sw1 to sw2" needs 3 entries, the device has 2; with 3 it holds; "sw2 to h3" needs 3 entries, the device has 2; with 3 it holds, expected limits that leave room for the scheduled frames, or fewer or shorter of these)"},
    {"ACycleOfOtherSteps", limited(R"("gate_limits": {"granularity": "3us"})", two_of_six),
     R"(1:133: error at /network/generate/0/gate_limits: gates beyond what the device can do: found the cycle of "sw1 to sw2", 500us, is no multiple of the granularity of 3us; with periods that are it holds; the cycle of "sw2 to h3", 500us, is no multiple of the granularity of 3us; with periods that are it holds, expected limits that leave room for the scheduled frames, or fewer or shorter of these)"},
    {"IntervalsOfHalfACycle", limited(R"("gate_limits": {"least_interval": "300us"})", two_of_six),
     R"(1:133: error at /network/generate/0/gate_limits: gates beyond what the device can do: found "sw1 to sw2" would never open for other classes, with intervals of at least 300us that are multiples of 1ns; "sw2 to h3" would never open for other classes, with intervals of at least 300us that are multiples of 1ns, expected limits that leave room for the scheduled frames, or fewer or shorter of these)"},
    {"OwnListsBeyondTheDevice",
     limited(
         R"("gate_limits": {"entries": 2, "least_interval": "1us", "granularity": "1us"}, "egress": [{"gates": {"entries": [{"open": [6], "for": "500ns"}, {"open": [0], "for": "1us"}, {"open": [], "for": "98500ns"}]}}])",
         R"("streams": [])"),
     R"(1:217: error at /network/generate/0/egress/0/gates: gates beyond what the device can do: found 3 entries at "sw1", expected at most 2
1:217: error at /network/generate/0/egress/0/gates: gates beyond what the device can do: found an entry of 500ns at "sw1", expected at least 1us
1:217: error at /network/generate/0/egress/0/gates: gates beyond what the device can do: found a list or a cycle of other steps at "sw1", expected multiples of 1us)"},
    {"ListedAndScriptedBeyondTheDevice",
     limited(
         R"("gate_limits": {"entries": 2})",
         R"("streams": [], "gates": {"plan": "listed", "lists": [{"node": "sw2", "gates": {"entries": [{"open": [6], "for": "1us"}, {"open": [0], "for": "1us"}, {"open": [], "for": "9us"}]}}]},
"script": [{"at": "0.5ms", "set_gates": {"node": "sw1", "gates": {"entries": [{"open": [6], "for": "1us"}, {"open": [0], "for": "1us"}, {"open": [], "for": "9us"}]}}}])"),
     R"(2:79: error at /gates/lists/0/gates: gates beyond what the device can do: found 3 entries at "sw2", expected at most 2
3:66: error at /script/0/set_gates/gates: gates beyond what the device can do: found 3 entries at "sw1", expected at most 2)"},
    {"MoreClassesThanQueues",
     limited(
         R"("gate_limits": {"queues": 1})",
         R"("streams": [{"name": "a", "from": "h1", "to": "h3", "payload": "100B", "every": "500us", "pcp": 6}, {"name": "b", "from": "h2", "to": "h3", "payload": "100B", "every": "500us", "pcp": 5}])"),
     R"(1:144: error at /network/generate/0/gate_limits/queues: more traffic classes than queues: found "sw1 to sw2" sends frames of the classes 5, 6, the device has 1 queues, expected priorities in fewer classes; with 2 queues it holds)"},
    {"UnknownNode",
     with(
         good,
         R"("gates": {"plan": "listed", "lists": [{"node": "sw3", "gates": {"entries": [{"open": [], "for": "1us"}]}}, {"node": "sw1", "to": "h3", "gates": {"entries": [{"open": [], "for": "1us"}]}}]})"),
     R"(2:48: error at /gates/lists/0/node: unknown node: found "sw3", expected the name of a node (did you mean "sw1"?)
2:130: error at /gates/lists/1/to: not a neighbour: found "h3", expected a node that a link joins to "sw1")"},
    {"TwoLists", with(good, R"("gates": {"plan": "listed", "lists": [{"node": "sw1", "gates": {"entries": [{"open": [6], "for": "9us"}]}}, {"node": "sw1", "to": "sw2", "gates": {"entries": [{"open": [6], "for": "9us"}]}}]})"), R"(2:109: error at /gates/lists/1: a port configured twice: found gates of "sw1" that are there already, expected one list for a port)"},
};

INSTANTIATE_TEST_SUITE_P(BadGates, BadInput, testing::ValuesIn(cases), name_of_case);

}  // namespace
}  // namespace takt::scenario::test::bad_gates_test
