// SPDX-License-Identifier: Apache-2.0
// Configuration that cannot act is told, with the reason; and none of it where it can.
#include <gtest/gtest.h>

#include <algorithm>
#include <string_view>

#include "bad_input.hpp"

namespace takt::scenario::test {
namespace {

/// Two hosts at two switches at 100 Mb/s; `egress` and `ingress` are those of sw1, whose port 1 leads to sw2.
std::string line(const std::string& sw1, const std::string& streams, const std::string& more = "") {
  return R"({"name": "t", "duration": "10ms", "network": {"nodes": {"a": {"kind": "host"}, "b": {"kind": "host"}, "sw2": {"kind": "switch"}, "sw1": {"kind": "switch",
)" + sw1 +
         R"(}}, "links": [{"ends": ["a", "sw1"], "rate": "100Mbps"}, {"ends": ["sw1", "sw2"], "rate": "100Mbps"}, {"ends": ["sw2", "b"], "rate": "100Mbps"}]}, "streams": [)" +
         streams + "]" + more + "}";
}
const std::string control =
    R"({"name": "control", "from": "a", "to": "b", "payload": "40B", "every": "250us", "pcp": 7})";
const std::string bulk = R"({"name": "bulk", "from": "a", "to": "b", "payload": "972B", "every": "500us", "pcp": 0})";
const std::string both = control + ", " + bulk;
const std::string quick =
    R"({"name": "quick", "from": "a", "to": "b", "payload": "972B", "every": "200us", "pcp": 0})";  // 41.68 Mb/s
/// The egress of sw1 towards sw2.
std::string egress(const std::string& text, const std::string& streams = both, const std::string& more = "") {
  return line(R"("egress": [{"to": "sw2", )" + text + "}]", streams, more);
}
std::string ingress(const std::string& text, const std::string& streams = both) {
  return line(R"("ingress": {)" + text + "}", streams);
}
std::string plain(const std::string& more, const std::string& streams = both) {
  return line(R"("forwarding_delay": "1us")", streams, more);
}

std::string warnings_of(const std::string& text) {
  const Loaded loaded = load(text);
  EXPECT_NE(loaded.resolved, nullptr) << loaded.diagnostics.to_text();
  std::string all;
  for (const json::Diagnostic& diagnostic : loaded.diagnostics.sorted())
    all += diagnostic.place.pointer + ": " + diagnostic.message + ": " + diagnostic.details.found + " | " +
           diagnostic.details.expected + "\n";
  return all;
}

struct IdleCase {
  const char* name;
  std::string text;
  std::string warnings;
};
void PrintTo(const IdleCase& idle, std::ostream* out) { *out << idle.name; }

class Idle : public testing::TestWithParam<IdleCase> {};

TEST_P(Idle, IsTold) { EXPECT_EQ(warnings_of(GetParam().text), GetParam().warnings) << GetParam().text; }

const std::string in_use = " | one of the classes in use there: 1, 7\n";

// The finding preemption-of-no-class: the author takes the class for the priority.
const IdleCase cases[] = {
    {"PreemptionOfNoClass", egress(R"("preemption": {"preemptable": [0]})"),
     "/network/nodes/sw1/egress/0/preemption/preemptable/0: preemption of a class that no stream has: class 0 at "
     "sw1:1: no stream goes there; priority 0 is class 1" +
         in_use},
    {"PreemptionOfAllButOne", egress(R"("preemption": {"preemptable": [0, 1, 2, 3, 4, 5, 6]})"), ""},
    {"PreemptionOfAPriority", egress(R"("preemption": {"preemptable": [0, 7]})"),
     "/network/nodes/sw1/egress/0/preemption/preemptable/0: preemption of a class that no stream has: class 0 at "
     "sw1:1: no stream goes there; priority 0 is class 1" +
         in_use},
    {"PreemptionThatActs", egress(R"("preemption": {"preemptable": [1]})"), ""},
    {"PreemptionWithoutExpress", egress(R"("preemption": {"preemptable": [1, 7]})"),
     "/network/nodes/sw1/egress/0/preemption: preemption without express frames: at sw1:1 all frames are preemptable: "
     "class 1, 7 | a class in use that is not preemptable\n"},
    {"HoldAdvanceWithoutHold", egress(R"("preemption": {"preemptable": [1], "hold_advance": "5us"})"),
     "/network/nodes/sw1/egress/0/preemption/hold_advance: an advance of what is never held: no gate list that holds | "
     "an entry with \"mac\": \"hold\"\n"},
    {"HoldWithoutPreemption",
     egress(
         R"("gates": {"entries": [{"open": [7], "for": "50us", "mac": "hold"}, {"open": [1], "for": "200us", "mac": "release"}]})"),
     "/network/nodes/sw1/egress/0/gates/entries/0/mac: preemptable frames held that there are not: no preemption at "
     "sw1:1 | \"preemption\" beside \"gates\"\n"},
    // The finding shapers-that-shape-nothing.
    {"ShaperOfNoClass", egress(R"("shapers": [{"class": 6, "idle_slope": "20Mbps"}])"),
     "/network/nodes/sw1/egress/0/shapers/0/class: a shaper of a class that no stream has: class 6 at sw1:1: no stream "
     "goes there" +
         in_use},
    // The finding starved-by-slope: 972 + 28 + 22 B and 20 B for preamble and gap are 8,336 bit, 2,000 times a
    // second 16.672 Mb/s.
    {"ShaperBelowItsLoad", egress(R"("shapers": [{"class": 1, "idle_slope": "10Mbps"}])"),
     "/network/nodes/sw1/egress/0/shapers/0/idle_slope: a shaper slower than its class: 10Mbps for 16.672Mbps of class "
     "1 at sw1:1, preamble and gap included | a slope that carries them\n"},
    {"ShaperAtItsLoad", egress(R"("shapers": [{"class": 1, "idle_slope": "16672kbps"}])"), ""},
    {"ShaperAsFastAsItsLink", egress(R"("shapers": [{"class": 1, "idle_slope": "100Mbps"}])"),
     "/network/nodes/sw1/egress/0/shapers/0/idle_slope: a shaper as fast as its link: 100Mbps at sw1:1 | a slope below "
     "the rate of the link\n"},
    {"MaxSduOfNoClass", egress(R"("max_sdu": [{"class": 3, "size": "100B"}])"),
     "/network/nodes/sw1/egress/0/max_sdu/0/class: a maximum SDU of a class that no stream has: class 3 at sw1:1: no "
     "stream goes there" +
         in_use},
    {"MaxSduOfEveryFrame", egress(R"("max_sdu": [{"class": 1, "size": "1001B"}])"),
     "/network/nodes/sw1/egress/0/max_sdu/0/size: a maximum SDU that no frame exceeds: 1001B, and the longest of class "
     "1 at sw1:1 has 1000B | a size below it\n"},
    {"MaxSduOfNoFrame", egress(R"("max_sdu": [{"class": 1, "size": "999B"}])"),
     "/network/nodes/sw1/egress/0/max_sdu/0/size: a maximum SDU that drops frames: 999B at sw1:1, and frames of "
     "\"bulk\" of 1000B | at least the longest\n"},
    {"AtsOfNoClass", egress(R"("ats": [5])"),
     "/network/nodes/sw1/egress/0/ats/0: ATS of a class that no stream has: class 5 at sw1:1: no stream goes there" +
         in_use},
    {"AtsWithoutScheduler", egress(R"("ats": [7])"),
     "/network/nodes/sw1/egress/0/ats/0: ATS without a scheduler: class 7 at sw1:1: its streams meet no ATS scheduler "
     "in the switch | a filter with \"ats\" in its \"ingress\"\n"},
    {"ShareOfNoClass", egress(R"("ets": [{"class": 1, "bandwidth": 50}, {"class": 5, "bandwidth": 50}])"),
     "/network/nodes/sw1/egress/0/ets/0/class: a share of the bandwidth beside no other: class 1 at sw1:1: no other "
     "class with a share is in use there | a share for another class, or none\n"
     "/network/nodes/sw1/egress/0/ets/1/class: a share of the bandwidth of a class that no stream has: class 5 at "
     "sw1:1: no stream goes there" +
         in_use},
    {"SharesThatAct", egress(R"("ets": [{"class": 1, "bandwidth": 50}, {"class": 7, "bandwidth": 50}])"), ""},
    {"SharesBehindALowerClass",
     egress(R"("ets": [{"class": 5, "bandwidth": 50}, {"class": 7, "bandwidth": 50}])",
            both + R"(, {"name": "video", "from": "a", "to": "b", "payload": "100B", "every": "500us", "pcp": 5})"),
     "/network/nodes/sw1/egress/0/ets/0/class: a share of the bandwidth that lower classes leave: class 1 at sw1:1 "
     "without a share, and so before class 5 | shares for the lowest classes\n"
     "/network/nodes/sw1/egress/0/ets/1/class: a share of the bandwidth that lower classes leave: class 1 at sw1:1 "
     "without a share, and so before class 7 | shares for the lowest classes\n"},
    {"CutThroughOfNoClass", egress(R"("cut_through": [0])"),
     "/network/nodes/sw1/egress/0/cut_through/0: cut-through of a class that no stream has: class 0 at sw1:1: no "
     "stream goes there; priority 0 is class 1" +
         in_use},
    {"CutThroughThatActs", egress(R"("cut_through": [7])"), ""},
    {"CutThroughBackwards", line(R"("egress": [{"to": "a", "cut_through": [7]}])", both),
     "/network/nodes/sw1/egress/0/cut_through/0: cut-through of a class that no stream has: class 7 at sw1:0: no "
     "stream leaves there | streams through it\n"},
    {"GatesThatCloseForNobody",
     egress(R"("gates": {"entries": [{"open": [1, 7], "for": "100us"}, {"open": [1, 5, 7], "for": "100us"}]})"),
     "/network/nodes/sw1/egress/0/gates: gates that close for no frame: class 1, 7 in use at sw1:1, open at all times "
     "| entries that close a class in use\n"},
    {"GatesAfterTheEnd",
     egress(
         R"("gates": {"base_time": "10ms", "entries": [{"open": [7], "for": "100us"}, {"open": [1], "for": "100us"}]})"),
     "/network/nodes/sw1/egress/0/gates/base_time: gates that begin after the end of the simulation: 10ms | less than "
     "10ms\n"},
    {"ExtensionWithoutChange",
     egress(
         R"("gates": {"extension": "10us", "entries": [{"open": [7], "for": "100us"}, {"open": [1], "for": "100us"}]})"),
     "/network/nodes/sw1/egress/0/gates/extension: an extension that nothing needs: no other list for sw1:1 | a "
     "\"set_gates\" of the script\n"},
    {"LimitOfAnUnusedQueue", line(R"("queues": {"classes": [{"class": 4, "frames": 3}]})", both),
     "/network/nodes/sw1/queues/classes/0/class: a limit of a queue that no stream uses: class 4 at the 2 ports of "
     "sw1: no stream goes there | one of the classes in use there: 1, 7\n"},
    {"RunningListThatBeginsAnyhow",
     egress(
         R"("gates": {"running": true, "base_time": "-400us", "entries": [{"open": [7], "for": "100us"}, {"open": [1], "for": "100us"}]})"),
     "/network/nodes/sw1/egress/0/gates/running: a list that begins at the start in any case: \"base_time\" of -400us "
     "and a cycle of 200us | a \"base_time\" in the middle of a cycle\n"},
    {"RunningListInItsCycle",
     egress(
         R"("gates": {"running": true, "base_time": "-450us", "entries": [{"open": [7], "for": "100us"}, {"open": [1], "for": "100us"}]})"),
     ""},
    {"JitterOfNothing", line(R"("forwarding_jitter": "0ns")", both),
     "/network/nodes/sw1/forwarding_jitter: a jitter of nothing: at most 0s | a time\n"},
    {"HostPriorityLikeAnyOther",
     line(
         R"("forwarding_delay": "1us")",
         R"({"name": "control", "from": "a", "to": "b", "payload": "40B", "every": "250us", "host_priority": 0}, {"name": "bulk", "from": "a", "to": "b", "payload": "972B", "every": "500us", "pcp": 5})"),
     "/streams/0/host_priority: a priority that makes no difference: 0, whose class at \"a\" is that of priority 0 | a "
     "priority of another class\n"},
    {"DropsOfUnlimitedQueues",
     line(R"("queues": {"drop": "oldest", "classes": [{"class": 7, "drop": "oldest"}]})", both),
     "/network/nodes/sw1/queues/drop: what a full queue loses, of queues that are never full: neither \"frames\" nor "
     "\"octets\" | a limit\n"
     "/network/nodes/sw1/queues/classes/0/drop: what a full queue loses, of queues that are never full: neither "
     "\"frames\" nor \"octets\" | a limit\n"},
    {"DropsOfLimitedQueues",
     line(
         R"("queues": {"drop": "oldest", "classes": [{"class": 7, "frames": 3}, {"class": 1, "frames": 3, "drop": "newest"}]})",
         both),
     ""},
    {"HeaderWithoutCutThrough", line(R"("cut_through_header": "30B")", both),
     "/network/nodes/sw1/cut_through_header: a header where nothing is cut through: no \"cut_through\" in \"egress\" "
     "of \"sw1\" | classes that are cut through\n"},
    {"FilterOfNothing",
     ingress(R"("filters": [{"pcp": 3, "meter": "m"}], "meters": [{"name": "m", "cir": "1Mbps", "cbs": "2000B"}])"),
     "/network/nodes/sw1/ingress/filters/0: a filter that no frame reaches: streams of priority 3, none of which "
     "crosses \"sw1\" past earlier filters | frames that do\n"},
    {"FunctionsOfNoFilter",
     ingress(
         R"("gates": [{"name": "g", "open": false}], "meters": [{"name": "m", "cir": "1Mbps", "cbs": "2000B"}], "ats": [{"name": "s", "rate": "1Mbps", "burst": "2000B"}],
"ats_groups": [{"name": "group"}], "streams": [{"name": "all", "source": {"source": "a"}}], "filters": [{"pcp": 7}])"),
     "/network/nodes/sw1/ingress/gates/0/name: a stream gate that no filter names: \"g\" | \"gate\" of an entry of "
     "\"filters\"\n"
     "/network/nodes/sw1/ingress/meters/0/name: a flow meter that no filter names: \"m\" | \"meter\" of an entry of "
     "\"filters\"\n"
     "/network/nodes/sw1/ingress/ats/0/name: an ATS scheduler that no filter names: \"s\" | \"ats\" of an entry of "
     "\"filters\"\n"
     "/network/nodes/sw1/ingress/ats_groups/0/name: a group without ATS schedulers: \"group\" | \"group\" of an entry "
     "of \"ats\"\n"
     "/network/nodes/sw1/ingress/streams/0/name: an identified stream that no filter names: \"all\" | \"stream\" of an "
     "entry of \"filters\"\n"},
    // 1022 B, 2,000 times a second: 16.352 Mb/s. With the excess rate 8 + 8 Mb/s are not enough either.
    {"MeterBelowItsLoad",
     ingress(
         R"("filters": [{"stream": "bulk", "meter": "m"}], "meters": [{"name": "m", "cir": "8Mbps", "cbs": "2000B", "eir": "8Mbps", "ebs": "2000B"}])"),
     "/network/nodes/sw1/ingress/meters/0/cir: a meter slower than its streams: 16Mbps for 16.352Mbps at \"sw1\", so "
     "that frames are dropped | a rate that carries them\n"},
    {"MeterAtItsLoad",
     ingress(
         R"("filters": [{"stream": "bulk", "meter": "m"}], "meters": [{"name": "m", "cir": "16352kbps", "cbs": "2000B"}])"),
     ""},
    {"MeterWithoutASecondBucket",
     ingress(
         R"("filters": [{"stream": "bulk", "meter": "m"}], "meters": [{"name": "m", "cir": "20Mbps", "cbs": "2000B", "eir": "8Mbps", "coupling": true, "color_aware": true}])"),
     "/network/nodes/sw1/ingress/meters/0/eir: an excess rate without a bucket: \"ebs\" of 0 | \"ebs\" too\n"
     "/network/nodes/sw1/ingress/meters/0/coupling: coupling without a second bucket: \"ebs\" of 0 | \"ebs\" too\n"
     "/network/nodes/sw1/ingress/meters/0/color_aware: colours that nobody gives: no other flow meter in the network | "
     "a meter before this one\n"},
    {"FilterSizes",
     ingress(R"("filters": [{"stream": "bulk", "max_sdu": "999B"}, {"stream": "control", "max_sdu": "69B"}])"),
     "/network/nodes/sw1/ingress/filters/0/max_sdu: a maximum SDU that drops frames: 999B, and frames of \"bulk\" of "
     "1000B | at least the longest\n"
     "/network/nodes/sw1/ingress/filters/1/max_sdu: a maximum SDU that no frame exceeds: 69B, and the longest frame "
     "has 68B | a size below it\n"},
    {"GateThatDoesNothing",
     ingress(
         R"("filters": [{"stream": "bulk", "gate": "g"}], "gates": [{"name": "g", "block_invalid_rx": true, "block_octets_exceeded": true}])"),
     "/network/nodes/sw1/ingress/gates/0/block_invalid_rx: a block that nothing sets off: \"g\" is never closed | "
     "entries with \"open\": false\n"
     "/network/nodes/sw1/ingress/gates/0/block_octets_exceeded: a block that nothing sets off: no entry of \"g\" with "
     "\"octets\" | \"octets\" of an entry\n"},
    {"EligibilityThatNobodyMinds",
     ingress(
         R"("filters": [{"stream": "control", "ats": "s"}], "ats": [{"name": "s", "rate": "10Mbps", "burst": "200B"}])"),
     "/network/nodes/sw1/ingress/filters/0/ats: eligibility times that no port minds: class 7 at sw1:1, which is not "
     "sent by them | the class in \"ats\" of \"egress\"\n"},
    {"GateOpenForTooShort",
     egress(R"("gates": {"entries": [{"open": [1], "for": "100us"}, {"open": [7], "for": "400us"}]})",
            control + ", " + quick),
     "/network/nodes/sw1/egress/0/gates/entries: gates that are open for less than is asked: 100us of 500us, "
     "20.192Mbps, for 41.68Mbps of class 1 at sw1:1, preamble and gap included | windows that carry them\n"},
    // Each of them fits into 90 us, and both do not.
    {"GatesOpenTogetherForTooShort",
     egress(R"("gates": {"entries": [{"open": [1, 7], "for": "90us"}, {"open": [2], "for": "410us"}]})"),
     "/network/nodes/sw1/egress/0/gates/entries: gates that are open for less than is asked: 90us of 500us, "
     "18.192Mbps, for 20.192Mbps of class 1, 7 at sw1:1, preamble and gap included | windows that carry them\n"},
    // A window of one frame: the gap behind it lies outside.
    {"GateOpenForOneFrame",
     egress(R"("gates": {"entries": [{"open": [1], "for": "82.4us"}, {"open": [7], "for": "417.6us"}]})"), ""},
    {"CqfOfTooMuch",
     ingress(R"("cqf": {"cycle": "250us", "classes": [4, 5], "pcp": [0], "dead_time": "160us"})", quick),
     "/network/nodes/sw1/ingress/cqf: cyclic queuing of more than is sent: 90us of 250us, 36.384Mbps, for 41.68Mbps at "
     "sw1:1, preamble and gap included | streams that fit\n"},
    {"CqfOfEnough", ingress(R"("cqf": {"cycle": "250us", "classes": [4, 5], "pcp": [0], "dead_time": "140us"})", quick),
     ""},
    {"CqfWithoutFrames", ingress(R"("cqf": {"cycle": "500us", "classes": [4, 5]})"),
     "/network/nodes/sw1/ingress/cqf: cyclic queuing without frames: no stream that crosses \"sw1\" meets it | streams "
     "with its priorities\n"},
    {"RouteThatNobodyHasSearchedFor",
     plain("", R"({"name": "s", "from": "a", "to": "b", "payload": "40B", "every": "1ms", "route": "auto"})"),
     "/streams/0/route: a route that nobody has searched for: \"auto\", until then the shortest path | takt schedule "
     "SCENARIO --out FILE, which writes a \"path\", and then FILE\n"},
    {"StreamAfterTheEnd",
     plain("", R"({"name": "late", "from": "a", "to": "b", "payload": "40B", "every": "1ms", "offset": "10ms"})"),
     "/streams/0/offset: a stream that begins after the end of the simulation: 10ms | less than 10ms\n"},
    {"StreamThatEndsAfterTheEnd",
     plain("", R"({"name": "long", "from": "a", "to": "b", "payload": "40B", "every": "1ms", "until": "10ms"})"),
     "/streams/0/until: a stream that ends after the end of the simulation: 10ms | less than 10ms\n"},
    {"FaultsInVain",
     plain(
         R"(, "faults": [{"kind": "link-down", "link": ["a", "sw1"], "at": "1ms", "for": "3ms"}, {"kind": "link-down", "link": ["sw1", "a"], "at": "2ms", "for": "1ms"},
{"kind": "link-down", "link": ["a", "sw1"], "at": "1ms", "for": "3ms"}, {"kind": "frame-errors", "link": ["sw1", "sw2"], "loss": 0}, {"kind": "frame-errors", "link": ["sw1", "sw2"], "towards": "sw1", "loss": 0.5},
{"kind": "stuck-gate", "node": "sw1", "to": "sw2", "class": 0, "state": "closed", "at": "1ms"}, {"kind": "stuck-gate", "node": "sw1", "to": "sw2", "class": 1, "state": "open", "at": "1ms"},
{"kind": "crash", "node": "b", "at": "10ms"}], "rerouting": {"delay": "1ms"})"),
     "/faults/1/at: a link that is down already: \"sw1\" to \"a\" is down from 1ms for 3ms | another time\n"
     "/faults/2: a fault twice: the same as the entry with number 0 | it once\n"
     "/faults/3: a fault with a chance of 0: every probability is 0 | one above 0\n"
     "/faults/4/link: a fault of a link that no stream takes: \"sw1\" to \"sw2\" towards \"sw1\" | a link on the path "
     "of a stream\n"
     "/faults/5/class: a stuck gate of a class that no stream has: class 0 at sw1:1: no stream goes there; priority 0 "
     "is class 1 | one of the classes in use there: 1, 7\n"
     "/faults/6: a gate stuck open that is always open: no gate list at sw1:1 | \"gates\" of the port, or \"closed\"\n"
     "/faults/7/at: after the end of the simulation: 10ms | less than 10ms\n"
     "/rerouting: nothing to reroute for: no other way for any stream while links are down | links around them; "
     "streams with \"path\" or \"redundancy\" keep theirs\n"},
    {"Twins",
     plain(
         R"(, "require": [{"stream": "bulk", "latency": "1ms"}, {"stream": "control", "latency": "1ms"}, {"stream": "bulk", "latency": "1ms"}])"),
     "/require/2: a requirement twice: the same as the entry with number 0 | it once\n"},
    {"ProgramThatNobodyStarts",
     plain(R"(, "programs": [{"name": "p", "master": "a", "slaves": ["b"], "cycle": "1ms"}])"),
     "/programs/0/name: a program that nobody starts: \"p\" | \"call\": \"Start\" in \"script\"\n"},
    {"SkillsAndWorkInVain",
     R"({"name": "t", "duration": "10ms", "network": {"nodes": {"a": {"kind": "host", "offers": ["weld"]}, "b": {"kind": "host", "processing": {"per_message": "1us"}, "cryptography": {"seal": "1us"}}, "sw": {"kind": "switch"}},
"links": [{"ends": ["a", "sw"]}, {"ends": ["b", "sw"]}]}})",
     "/network/nodes/a/offers/0: a skill that no role needs: \"weld\" | the \"skill\" of a role of a program\n"
     "/network/nodes/b/processing: a time of processing without replies: \"b\" is in no program with \"replies\" | "
     "\"replies\"\n"
     "/network/nodes/b/cryptography: times of cryptography without secured messages: \"b\" is in no program with "
     "\"security\" | \"security\" of a program\n"},
    {"ThreadsInVain",
     R"({"name": "t", "duration": "10ms", "network": {"nodes": {"b": {"kind": "host"}, "a": {"kind": "host", "cpu": {"slice": "1ms", "threads": [
{"name": "stack", "execution": "1us", "wake_up": "1us", "stack": ["receive", "transmit"]}, {"name": "load", "execution": "1us", "every": "20ms", "offset": "11ms"}]}}}, "links": [{"ends": ["a", "b"]}]}, "streams": [)" +
         control + "]}",
     "/network/nodes/a/cpu/slice: a slice that nobody shares: 1ms beside fewer than two threads of policy \"fair\" | "
     "two of them\n"
     "/network/nodes/a/cpu/threads/0/wake_up: a wake-up of a thread that no timer wakes: \"stack\", to which frames "
     "alone come | \"runs\" or \"every\"\n"
     "/network/nodes/a/cpu/threads/0/stack/0: a part of the protocol stack that meets no frame: receive at \"a\" | a "
     "stream to it\n"
     "/network/nodes/a/cpu/threads/1/offset: a load that begins after the end of the simulation: 11ms | less than "
     "10ms\n"},
    {"GatesBeforeClocks",
     egress(
         R"("gates": {"entries": [{"open": [7], "for": "100us"}, {"open": [0, 1, 2, 3, 4, 5, 6, 7], "for": "900us"}]})",
         both, R"(, "clocks": {"all": {"offset": "10ppm"}, "gptp": {}}, "require": [{"sync": "1us", "after": "5ms"}])"),
     "/network/nodes/sw1/egress/0/gates/base_time: gates that run before clocks are synchronised: lists of sw1:1 from "
     "0s on, and "
     "clocks from 5ms on: a frame that misses its window then stands before all that follow | a \"base_time\" of 5ms "
     "or later\n"},
    {"ClocksInVain",
     plain(
         R"(, "clocks": {"nodes": {"a": {"ideal": true, "drift": "1ppb"}, "b": {"table": [{"at": "20ms", "frequency": "1ppm"}]}}})"),
     "/clocks/nodes/a/drift: an oscillator of an ideal clock: \"ideal\": true beside it | one of them\n"
     "/clocks/nodes/b/table/0: after the end of the simulation: 20ms | less than 10ms\n"},
};

INSTANTIATE_TEST_SUITE_P(All, Idle, testing::ValuesIn(cases),
                         [](const testing::TestParamInfo<IdleCase>& each) { return std::string(each.param.name); });

std::string warnings_of_finding(const std::string& name) {
  json::Diagnostics diagnostics;
  EXPECT_NE(load_file(std::string(TAKT_SOURCE_DIR) + "/tests/findings/" + name + ".json", {}, diagnostics), nullptr)
      << diagnostics.to_text();
  std::string all;
  for (const json::Diagnostic& diagnostic : diagnostics.sorted())
    all += diagnostic.place.pointer + ": " + diagnostic.details.found + "\n";
  return all;
}

TEST(IdleConfiguration, OfTheFindings) {
  EXPECT_EQ(warnings_of_finding("gate-share"),
            "/network/nodes/sw/egress/0/gates/entries: 50us of 500us, 100.192Mbps, for 493.44Mbps of class 4 at sw:1, "
            "preamble and gap included\n");
  EXPECT_EQ(warnings_of_finding("preemption-of-no-class"),
            "/network/nodes/sw1/egress/0/preemption/preemptable/0: class 0 at sw1:2: no stream goes there; priority 0 "
            "is class 1\n");
  EXPECT_EQ(warnings_of_finding("shapers-that-shape-nothing"),
            "/network/nodes/sw1/egress/0/shapers/0/class: class 6 at the 4 ports of sw1: no stream goes there\n"
            "/network/nodes/sw1/egress/0/shapers/1/class: class 5 at the 4 ports of sw1: no stream goes there\n"
            "/network/nodes/sw2/egress/0/shapers/0/class: class 6 at the 3 ports of sw2: no stream goes there\n");
}

/// What is shipped says nothing in vain. Some scenarios ask more of links, shapers and meters than they give, to show
/// what happens.
TEST(IdleConfiguration, ShippedScenariosSayNothingInVain) {
  constexpr std::string_view meant[] = {
      "an overloaded link",
      "a link that is nearly full",
      "a shaper slower than its class",
      "a meter slower than its streams",
      "a scheduler slower than its streams",
      "gates that run before clocks are synchronised",  // requirements of published ones count from later on
      "a filter that no frame reaches"};                // the last one of tsn/policing catches what nobody sends
  for (const std::string& name : shipped_names()) {
    json::Diagnostics diagnostics;
    ASSERT_TRUE(load_file(shipped_path(name), {}, diagnostics));
    for (const json::Diagnostic& diagnostic : diagnostics.kept())
      EXPECT_TRUE(std::find(std::begin(meant), std::end(meant), diagnostic.message) != std::end(meant))
          << name << ": " << json::to_text(diagnostic);
  }
}

}  // namespace
}  // namespace takt::scenario::test
