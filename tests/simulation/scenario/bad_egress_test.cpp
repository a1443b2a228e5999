// SPDX-License-Identifier: Apache-2.0
// What ports do beyond strict priority, and launch times, that name what is not there, contradict themselves or cannot
// be.
#include "bad_input.hpp"

namespace takt::scenario::test::bad_egress_test {
namespace {

/// `text` is the egress of the switch; its entry begins in column 1 of line 2. `nodes` and `links` are there besides.
std::string with_egress(const std::string& text, const std::string& nodes = "", const std::string& links = "") {
  return R"({"name": "t", "duration": "1ms", "network": {"nodes": {)" + nodes +
         R"("a": {"kind": "host"}, "b": {"kind": "host"}, "sw": {"kind": "switch", "egress": [
)" + text +
         "]}}, \"links\": [" + two_links + links + "]}}";
}
/// `text` are members of the switch.
std::string with_switch(const std::string& text) {
  return R"({"name": "t", "duration": "1ms", "network": {"nodes": {"a": {"kind": "host"}, "b": {"kind": "host"}, "sw": {"kind": "switch",
)" + text +
         "}}, \"links\": [" + two_links + "]}}";
}
/// `text` is the egress of the host "a".
std::string with_host_egress(const std::string& text) {
  return R"({"name": "t", "duration": "1ms", "network": {"nodes": {"b": {"kind": "host"}, "sw": {"kind": "switch"}, "a": {"kind": "host", "egress": [
)" + text +
         "]}}, \"links\": [" + two_links + "]}}";
}

/// The same with a stream of priority 3 from there, in line 3.
std::string with_host_egress_and_launch(const std::string& text) {
  std::string scenario = with_host_egress(text);
  scenario.pop_back();
  return scenario + R"(, "streams": [
{"name": "s", "from": "a", "to": "b", "payload": "1B", "every": "1ms", "pcp": 3, "launch": "1us"}]})";
}

const BadCase cases[] = {
    {"PreemptionOfNothing", with_egress(R"({"preemption": {"preemptable": []}})"),
     R"(2:32: error at /network/nodes/sw/egress/0/preemption/preemptable: too few items: found 0, expected 1 to 8 items)"},
    {"RunningBeforeItBegins",
     with_egress(R"({"gates": {"running": true, "base_time": "1ms", "entries": [{"open": [0], "for": "1ms"}]}})"),
     R"(2:23: error at /network/nodes/sw/egress/0/gates/running: a list that is running before it begins: found "base_time" of 1ms, expected one of at most 0s)"},
    {"StreamGateRunningBeforeItBegins",
     with_switch(
         R"("ingress": {"gates": [{"name": "g", "running": true, "base_time": "1ms", "entries": [{"open": true, "for": "1ms"}]}]})"),
     R"(2:48: error at /network/nodes/sw/ingress/gates/0/running: a list that is running before it begins: found "base_time" of 1ms, expected one of at most 0s)"},
    {"RunningBeforeItIsSet",
     R"({"name": "t", "duration": "1ms", "network": {"nodes": {"a": {"kind": "host"}, "b": {"kind": "host"}, "sw": {"kind": "switch"}}, "links": [)" +
         std::string(two_links) + R"(]}, "script": [
{"at": "1us", "set_gates": {"node": "sw", "gates": {"running": true, "entries": [{"open": [0], "for": "1ms"}]}}}]})",
     R"(2:64: error at /script/0/set_gates/gates/running: a list that is running before it is set: found "running" of a list that the script sets, expected a "base_time" alone, which may lie in the past)"},
    {"PreemptionWithoutClasses", with_egress(R"({"preemption": {}})"),
     R"(2:16: error at /network/nodes/sw/egress/0/preemption: the field "preemptable" is missing)"},
    {"PreemptionOutOfRange",
     with_egress(R"({"preemption": {"preemptable": [0, 8, 0], "add_frag_size": 4, "hold_advance": "2s"}})"),
     R"(2:36: error at /network/nodes/sw/egress/0/preemption/preemptable/1: out of range: found the number 8, expected an integer from 0 to 7
2:39: error at /network/nodes/sw/egress/0/preemption/preemptable/2: occurs twice: found the number 0, expected items that differ
2:60: error at /network/nodes/sw/egress/0/preemption/add_frag_size: out of range: found the number 4, expected an integer from 0 to 3
2:79: error at /network/nodes/sw/egress/0/preemption/hold_advance: out of range: found "2s", expected a duration of at most 1s)"},
    {"PreemptionIsNoList", with_egress(R"({"preemption": [0, 1]})"),
     R"(2:16: error at /network/nodes/sw/egress/0/preemption: wrong type: found an array of 2, expected an object)"},
    {"NegativeHoldAdvance", with_egress(R"({"preemption": {"preemptable": [0], "hold_advance": "-1us"}})"),
     R"(2:53: error at /network/nodes/sw/egress/0/preemption/hold_advance: negative: found "-1us", expected a duration that is not negative)"},
    {"TwoPreemptions", with_egress(R"({"preemption": {"preemptable": [0]}, "preemption": {"preemptable": [1]}})"),
     R"(2:38: error at /network/nodes/sw/egress/0/preemption: the name "preemption" occurs twice: expected one value (the first is in line 2, column 2))"},
    {"TwoEntriesForAllPorts",
     with_egress(R"({"preemption": {"preemptable": [0]}}, {"preemption": {"preemptable": [1]}})"),
     R"(2:39: error at /network/nodes/sw/egress/1: a port configured twice: found all ports a second time, expected one entry for a port)"},
    {"TwoEntriesForAPort",
     with_egress(R"({"to": "b", "preemption": {"preemptable": [0]}}, {"to": "b", "cut_through": [1]})"),
     R"(2:50: error at /network/nodes/sw/egress/1: a port configured twice: found "b" a second time, expected one entry for a port)"},
    {"CutThroughOfPreemptable", with_egress(R"({"preemption": {"preemptable": [0, 1]}, "cut_through": [1, 7]})"),
     R"(2:56: error at /network/nodes/sw/egress/0/cut_through: cut-through of a preemptable class: found class 1, whose frames may be cut while they come, expected express classes)"},
    {"CutThroughWithAts", with_egress(R"({"ats": [3, 5], "cut_through": [5]})"),
     R"(2:32: error at /network/nodes/sw/egress/0/cut_through: cut-through of a class with ATS: found class 5, whose eligibility times count from the last bit, expected classes without ATS)"},
    {"AtsAndShaper", with_egress(R"({"ats": [3], "shapers": [{"class": 3, "idle_slope": "10Mbps"}]})"),
     R"(2:9: error at /network/nodes/sw/egress/0/ats: two transmission selection algorithms: found class 3 with a credit-based shaper and ATS, expected one for a class)"},
    {"AtsClasses", with_egress(R"({"ats": [3, 3, 9]})"),
     R"(2:13: error at /network/nodes/sw/egress/0/ats/1: occurs twice: found the number 3, expected items that differ
2:16: error at /network/nodes/sw/egress/0/ats/2: out of range: found the number 9, expected an integer from 0 to 7)"},
    {"SharesOfNinetyPercent", with_egress(R"({"ets": [{"class": 1, "bandwidth": 30}, {"class": 0, "bandwidth": 60}]})"),
     R"(2:9: error at /network/nodes/sw/egress/0/ets: shares that are not all of the bandwidth: found 90 percent in all, expected percentages that sum to 100)"},
    {"SharesOutOfRange", with_egress(R"({"ets": [{"class": 8, "bandwidth": 0}, {"class": 1}]})"),
     R"(2:20: error at /network/nodes/sw/egress/0/ets/0/class: out of range: found the number 8, expected an integer from 0 to 7
2:36: error at /network/nodes/sw/egress/0/ets/0/bandwidth: out of range: found the number 0, expected an integer from 1 to 100
2:40: error at /network/nodes/sw/egress/0/ets/1: the field "bandwidth" is missing)"},
    {"TwoSharesOfAClass", with_egress(R"({"ets": [{"class": 1, "bandwidth": 50}, {"class": 1, "bandwidth": 50}]})"),
     R"(2:51: error at /network/nodes/sw/egress/0/ets/1/class: a class with two shares: found class 1 a second time, expected one share for a class)"},
    {"ShareAndShaper",
     with_egress(
         R"({"shapers": [{"class": 3, "idle_slope": "10Mbps"}], "ets": [{"class": 3, "bandwidth": 50}, {"class": 1, "bandwidth": 50}]})"),
     R"(2:71: error at /network/nodes/sw/egress/0/ets/0/class: two transmission selection algorithms: found class 3 with ETS and a credit-based shaper, expected one for a class)"},
    {"ShareAndAts",
     with_egress(R"({"ats": [1], "ets": [{"class": 3, "bandwidth": 50}, {"class": 1, "bandwidth": 50}]})"),
     R"(2:63: error at /network/nodes/sw/egress/0/ets/1/class: two transmission selection algorithms: found class 1 with ETS and ATS, expected one for a class)"},
    {"ShareAndLaunchTimes",
     with_host_egress_and_launch(R"({"ets": [{"class": 3, "bandwidth": 50}, {"class": 1, "bandwidth": 50}]})"),
     R"(3:92: error at /streams/0/launch: two transmission selection algorithms: found class 3 of "a" with ETS and launch times, expected one for a class)"},
    {"SharesOfExpressAndPreemptable",
     with_egress(
         R"({"ets": [{"class": 3, "bandwidth": 50}, {"class": 1, "bandwidth": 50}], "preemption": {"preemptable": [0, 1]}})"),
     R"(2:9: error at /network/nodes/sw/egress/0/ets: express classes that share bandwidth with preemptable ones, which they cut: found class 1 preemptable, class 3 express, expected classes that are all express or all preemptable)"},
    {"CutThroughClasses", with_egress(R"({"cut_through": [7, 7, 8]})"),
     R"(2:21: error at /network/nodes/sw/egress/0/cut_through/1: occurs twice: found the number 7, expected items that differ
2:24: error at /network/nodes/sw/egress/0/cut_through/2: out of range: found the number 8, expected an integer from 0 to 7)"},
    {"UnknownMacOperation", with_egress(R"({"gates": {"entries": [{"open": [3], "for": "20us", "mac": "holds"}]}})"),
     R"(2:60: error at /network/nodes/sw/egress/0/gates/entries/0/mac: unknown name for what an entry asks of the MAC: found "holds", expected "none", "hold" or "release" (did you mean "hold"?))"},
    {"UntaggedAsText", with_egress(R"({"to": "b", "untagged": "yes"})"),
     R"(2:25: error at /network/nodes/sw/egress/0/untagged: wrong type: found the string "yes", expected true or false)"},
    {"UnknownEgressField", with_egress(R"({"preempt": {"preemptable": [0]}})"),
     R"(2:2: error at /network/nodes/sw/egress/0/preempt: unknown field "preempt" (did you mean "preemption"?))"},
    {"CutThroughHeader", with_switch(R"("cut_through_header": "5B")"),
     R"(2:23: error at /network/nodes/sw/cut_through_header: out of range: found "5B", expected a size from 14B to 72B)"},
    {"UntaggedTowardsASwitch",
     with_egress(R"({"untagged": true})", R"("far": {"kind": "switch"}, )", R"(, {"ends": ["sw", "far"]})"),
     R"(2:14: error at /network/nodes/sw/egress/0/untagged: tags taken off before a switch: found a port to "far", which would forget the priorities, expected ports to hosts)"},
    {"AHostForwardsNothing", with_host_egress(R"({"cut_through": [3], "ats": [2]})"),
     R"(2:17: error at /network/nodes/a/egress/0/cut_through: cut-through in a host: found a host, which forwards nothing, expected a switch
2:29: error at /network/nodes/a/egress/0/ats: ATS in a host: found a host, whose frames meet no ATS scheduler, expected schedulers in its "ats", or "launch" of a stream)"},
    {"AHostWithoutTags", with_host_egress(R"({"untagged": true})"),
     R"(2:14: error at /network/nodes/a/egress/0/untagged: tags taken off before a switch: found a port to "sw", which would forget the priorities, expected ports to hosts)"},
    {"NegativeLaunch",
     with_streams(
         R"({"name": "s", "from": "a", "to": "b", "payload": "1B", "every": "1ms", "pcp": 3, "launch": "-1us"})"),
     R"(2:92: error at /streams/0/launch: negative: found "-1us", expected a duration that is not negative)"},
    {"LaunchAsNumber",
     with_streams(R"({"name": "s", "from": "a", "to": "b", "payload": "1B", "every": "1ms", "pcp": 3, "launch": 5})"),
     R"(2:92: error at /streams/0/launch: wrong type: found the number 5, expected a duration such as the string "200us")"},
};

/// Transmission gates or stream gates of the switch with so many entries, each for that long.
std::string with_entries(const char* before, const char* entry, std::size_t count, const char* after) {
  std::string list;
  for (std::size_t i = 0; i < count; ++i) list += (i > 0 ? ", " : "") + std::string(entry);
  return before + list + after;
}
std::string with_gate_entries(std::size_t count, const char* interval) {
  return with_egress(with_entries(R"({"gates": {"entries": [)",
                                  (R"({"open": [0, 1], "for": ")" + std::string(interval) + R"("})").c_str(), count,
                                  "]}}"));
}
std::string with_stream_gate_entries(std::size_t count, const char* interval) {
  return with_switch(with_entries(R"("ingress": {"gates": [{"name": "g", "entries": [)",
                                  (R"({"open": true, "for": ")" + std::string(interval) + R"("})").c_str(), count,
                                  "]}]}"));
}

// Devices announce up to 65,536 entries. One more is the user's mistake and not takt's, and so is a list of weeks.
TEST(LongControlLists, AreSupportedOrTold) {
  for (const auto& with : {with_gate_entries, with_stream_gate_entries}) {
    const Loaded longest = load(with(65'536, "1us"));
    EXPECT_TRUE(longest.resolved) << longest.diagnostics.to_text();
    for (const auto& [count, interval, what] :
         {std::tuple(std::size_t{65'537}, "1us", "entries: too many items: found 65537"),
          std::tuple(std::size_t{400}, "1h", "entries: a control list that lasts too long: found 400 entries"),
          std::tuple(std::size_t{65'536}, "1h", "entries: a control list that lasts too long")}) {
      const Loaded loaded = load(with(count, interval));
      EXPECT_FALSE(loaded.resolved);
      EXPECT_NE(loaded.diagnostics.to_text().find(what), std::string::npos) << loaded.diagnostics.to_text();
    }
  }
}

INSTANTIATE_TEST_SUITE_P(BadEgress, BadInput, testing::ValuesIn(cases), name_of_case);

}  // namespace
}  // namespace takt::scenario::test::bad_egress_test
