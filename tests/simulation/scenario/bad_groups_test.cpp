// SPDX-License-Identifier: Apache-2.0
// Nested programs and programs with roles that cannot be.
#include "bad_input.hpp"

namespace takt::scenario::test::bad_groups_test {
namespace {

/// A master "a", hosts "b" and "c"; "b" offers welding, "c" gripping.
std::string with_groups(const std::string& programs, const std::string& script = "") {
  return head +
         R"("nodes": {"a": {"kind": "host"}, "b": {"kind": "host", "offers": ["welding"]}, "c": {"kind": "host", "offers": ["gripping"]}, "sw": {"kind": "switch"}}, )" +
         R"("links": [{"ends": ["a", "sw"]}, {"ends": ["b", "sw"]}, {"ends": ["c", "sw"]}]}, "programs": [)" + "\n" +
         programs + "]" + (script.empty() ? "" : ", \"script\": [\n" + script + "]") + "}";
}

const std::string outer = R"({"name": "o", "master": "a", "slaves": ["b"], "cycle": "1ms"},)";

const BadCase groups_cases[] = {
    {"WithinAStranger", with_groups(R"({"name": "i", "within": "x", "master": "b", "slaves": ["c"], "cycle": "1ms"})"),
     R"(2:25: error at /programs/0/within: unknown program: found "x", expected the name of a program)"},
    {"MasterIsNoSlaveOutside",
     with_groups(outer + "\n" + R"({"name": "i", "within": "o", "master": "c", "slaves": ["b"], "cycle": "1ms"})"),
     R"(3:40: error at /programs/1/master: the master of a nested program is no slave of the outer one: found "c", expected a slave of "o")"},
    {"WithinItself", with_groups(R"({"name": "i", "within": "i", "master": "b", "slaves": ["c"], "cycle": "1ms"})"),
     R"(2:25: error at /programs/0/within: programs nested in a circle: found "i" within itself, by way of "i", expected a tree of programs)"},
    {"TwoAtOneSlave",
     with_groups(
         outer + "\n" +
         R"({"name": "i", "within": "o", "master": "b", "slaves": ["c"], "cycle": "1ms"}, {"name": "j", "within": "o", "master": "b", "slaves": ["c"], "cycle": "1ms"})"),
     R"(3:103: error at /programs/2/within: two programs nested at one slave: found "j" and "i" at "b", expected one)"},
    {"NestedOfThePaper",
     with_groups(outer + "\n" +
                 R"({"name": "i", "within": "o", "variant": "paper", "master": "b", "slaves": ["c"], "cycle": "1ms"})"),
     R"(3:41: error at /programs/1/variant: nesting with the handshake of the paper: found "paper", whose states alone do not tell one run from the next, expected "robust" for both programs)"},
    {"NestedInRoles",
     with_groups(R"({"name": "o", "master": "a", "roles": [{"name": "r", "skill": "welding"}], "cycle": "1ms"},
{"name": "i", "within": "o", "master": "b", "slaves": ["c"], "cycle": "1ms"})"),
     R"(2:39: error at /programs/0/roles: roles in an outer program: found "roles" of "o", expected "slaves", of which the master of "i" is one)"},
    {"NestedThatStartsAgain", with_groups(R"({"name": "o", "master": "a", "slaves": ["c"], "cycle": "1ms"},
{"name": "i", "within": "o", "master": "c", "roles": [{"name": "r", "skill": "welding"}], "on_replacement": "restart", "cycle": "1ms"})"),
     R"(3:109: error at /programs/1/on_replacement: a nested program that starts by itself: found "restart", expected "stay-halted": the outermost program starts it)"},
    {"StartOfANestedOne",
     with_groups(outer + R"({"name": "i", "within": "o", "master": "b", "slaves": ["c"], "cycle": "1ms"})",
                 R"({"at": "0s", "program": "i", "call": "Start"})"),
     R"(3:25: error at /script/0/program: Start of a nested program: found "i", expected the outermost program, which starts it)"},
    {"NeitherSlavesNorRoles", with_groups(R"({"name": "p", "master": "a", "cycle": "1ms"})"),
     R"(2:1: error at /programs/0: a field is missing: expected exactly one of "slaves" or "roles")"},
    {"ASkillThatNobodyOffers",
     with_groups(R"({"name": "p", "master": "a", "roles": [{"name": "r", "skill": "weldin"}], "cycle": "1ms"})"),
     R"(2:63: error at /programs/0/roles/0/skill: a skill that nobody offers: found "weldin", expected a skill in the "offers" of a host)"},
    {"RolesOfThePaper",
     with_groups(
         R"({"name": "p", "variant": "paper", "master": "a", "roles": [{"name": "r", "skill": "welding"}], "cycle": "1ms"})"),
     R"(2:26: error at /programs/0/variant: roles with the handshake of the paper: found "paper", which cannot tell one node from the next, expected "robust")"},
    {"RoleTwice",
     with_groups(R"({"name": "p", "master": "a", "roles": [{"name": "a", "skill": "welding"}], "cycle": "1ms"})"),
     R"(2:49: error at /programs/0/roles/0/name: duplicate name: found "a" a second time, expected a name of its own for each role and the master)"},
    {"MasterAsCandidate",
     with_groups(
         R"({"name": "p", "master": "a", "roles": [{"name": "r", "skill": "welding"}], "candidates": ["b", "a"], "cycle": "1ms"})"),
     R"(2:96: error at /programs/0/candidates/1: a node twice in one program: found "a", which is the master, expected each participant on a node of its own)"},
    {"DataOfRolesBeyondAFrame",
     with_groups(
         R"({"name": "p", "master": "a", "roles": [{"name": "r", "skill": "welding"}], "cycle": "1ms", "process_data": [
{"name": "d", "from": "a", "fields": {"x": {"type": "Double", "count": 200}}}]})"),
     R"(3:38: error at /programs/0/process_data/0/fields: more than one frame: found 1624 octets with all headers, expected at most 1500)"},
    {"DataThatSecurityTakesBeyondAFrame",
     with_groups(R"({"name": "p", "master": "a", "slaves": ["b"], "cycle": "1ms", "security": "sign", "process_data": [
{"name": "d", "from": "a", "fields": {"x": {"type": "Double", "count": 180}}}]})"),
     R"(3:38: error at /programs/0/process_data/0/fields: more than one frame: found 1510 octets with all headers, expected at most 1500)"},
    {"AnotherSecurity",
     with_groups(R"({"name": "p", "master": "a", "slaves": ["b"], "cycle": "1ms", "security": {"mode": "encrypt"}})"),
     R"(2:84: error at /programs/0/security/mode: unknown name for a security mode: found "encrypt", expected "sign" or "sign-and-encrypt")"},
    {"AbsentStranger",
     with_groups(
         R"({"name": "p", "master": "a", "roles": [{"name": "r", "skill": "welding"}], "absent": ["c"], "cycle": "1ms"})"),
     R"(2:87: error at /programs/0/absent/0: not a candidate of the program: found "c", expected a host that offers a skill it needs)"},
    {"TwoProgramsForOneNode",
     with_groups(
         R"({"name": "p", "master": "a", "roles": [{"name": "r", "skill": "welding"}], "cycle": "1ms"}, {"name": "q", "master": "c", "roles": [{"name": "r", "skill": "welding"}], "cycle": "1ms"})"),
     R"(2:131: error at /programs/1/roles: a node that offers its skills to two programs: found "b" to "p" and "q", expected "candidates" that share no host)"},
    {"JoinOfAStranger",
     with_groups(R"({"name": "p", "master": "a", "roles": [{"name": "r", "skill": "welding"}], "cycle": "1ms"})",
                 R"({"at": "0s", "join": "c"})"),
     R"(3:22: error at /script/0/join: not a candidate of a program: found "c", expected a host that offers a skill a role needs)"},
    {"PhasesOfRoles",
     with_groups(
         R"({"name": "p", "master": "a", "roles": [{"name": "r", "skill": "welding"}], "phases": {"a": "1us"}, "cycle": "1ms"})"),
     R"(2:86: error at /programs/0/phases: phases in a program with roles: found "phases" beside "roles", whose participants come and go, expected "offset")"},
    {"PublisherIdsOfAnother",
     with_groups(R"({"name": "p", "master": "a", "slaves": ["b"], "publisher_id": 7, "cycle": "1ms"},
{"name": "q", "master": "b", "slaves": ["c"], "publisher_id": 8, "cycle": "1ms"})"),
     R"(3:63: error at /programs/1/publisher_id: a PublisherId twice: found 8, which "p" has, expected PublisherIds of its own for "q")"},
    {"AnnouncementsOfSlaves",
     with_groups(R"({"name": "p", "master": "a", "slaves": ["b"], "announce_every": "1ms", "cycle": "1ms"})"),
     R"(2:65: error at /programs/0/announce_every: belongs to a program with roles: found "announce_every", expected "roles" instead of "slaves")"},
};
INSTANTIATE_TEST_SUITE_P(Groups, BadInput, testing::ValuesIn(groups_cases), name_of_case);

}  // namespace
}  // namespace takt::scenario::test::bad_groups_test
