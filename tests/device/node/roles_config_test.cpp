// SPDX-License-Identifier: Apache-2.0
// Files of nodes in groups with roles.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "node/config.hpp"

namespace takt::node::roles_config_test {
namespace {

const std::string transport = R"("transport": {"kind": "udp", "destinations": ["127.0.0.1:4841"]})";

/// A master m, roles left (welding) and hand (gripping), candidates a, b and c.
std::string program(
    const std::string& more = "",
    const std::string& roles = R"([{"name": "left", "skill": "welding"}, {"name": "hand", "skill": "gripping"}])",
    const std::string& candidates = R"(, "candidates": ["a", "b", "c"])") {
  return R"({"name": "p", "master": "m", "cycle": "1ms", "roles": )" + roles + candidates + more + "}";
}
std::string file(const std::string& node, const std::string& more = "", const std::string& of = program()) {
  return R"({"node": ")" + node + R"(", "program": )" + of + ", " + transport + more + "}";
}
const std::string welds = R"(, "offers": ["welding"])";

struct Load {
  explicit Load(const std::string& text) {
    const std::string path = std::string(::testing::TempDir()) + "takt-node-roles.json";
    std::ofstream(path) << text;
    loaded = load_config(path, diagnostics);
    std::filesystem::remove(path);
  }
  json::Diagnostics diagnostics;
  std::unique_ptr<LoadedConfig> loaded;
};

TEST(RolesConfig, OfTheMaster) {
  const Load load(file("m", "", program(R"(, "announce_every": "4ms", "on_replacement": "restart")")));
  ASSERT_TRUE(load.loaded) << load.diagnostics.to_text();
  const LoadedProgram& loaded = load.loaded->programs[0];
  ASSERT_TRUE(loaded.roles);
  EXPECT_FALSE(loaded.roles->offer);
  EXPECT_EQ(loaded.roles->announce_cycle, Duration::from_ps(4'000'000'000));
  EXPECT_EQ(loaded.endpoint.handshake.role, handshake::Role::master);
  EXPECT_EQ(loaded.endpoint.handshake.slaves, 2);
  EXPECT_EQ(loaded.roles->format->candidates(), 3u);
  EXPECT_EQ(offered_in(load.loaded->programs), std::nullopt);
}

TEST(RolesConfig, OfACandidate) {
  const Load load(file(
      "b",
      R"(, "offers": ["gripping", "painting"], "absent": true, "script": [{"at": "2s", "plug": "join"}, {"at": "3s", "plug": "leave", "program": "p"}, {"at": "4s", "call": "Halt"}])"));
  ASSERT_TRUE(load.loaded) << load.diagnostics.to_text();
  const LoadedProgram& loaded = load.loaded->programs[0];
  ASSERT_TRUE(loaded.roles->offer);
  EXPECT_EQ(loaded.roles->offer->number, 1);
  EXPECT_EQ(loaded.roles->offer->skills,
            (std::vector<handshake::SkillId>{handshake::skill_id("gripping"), handshake::skill_id("painting")}));
  EXPECT_EQ(loaded.roles->announce_cycle, Duration::from_ps(10'000'000'000));
  EXPECT_EQ(offered_in(load.loaded->programs), 0u);
  ASSERT_EQ(load.loaded->script.size(), 3u);
  EXPECT_EQ(std::get<Membership>(load.loaded->script[0].what), Membership::join);
  EXPECT_EQ(std::get<program::Method>(load.loaded->script[2].what), program::Method::Halt);
}

// Behind the participants, the candidates have PublisherIds, too.
TEST(RolesConfig, PublisherIds) {
  const std::string other = R"({"name": "q", "master": "x", "slaves": ["y"], "cycle": "1ms"})";
  const Load load(R"({"node": "x", "programs": [)" + program() + ", " + other + "], " + transport + "}");
  ASSERT_TRUE(load.loaded) << load.diagnostics.to_text();
  EXPECT_EQ(load.loaded->programs[0].endpoint.format->shape().first_publisher_id,
            7);  // m, left, hand, a, b, c before it
}

TEST(RolesConfig, ARoleMaySendWhatItsNodeHasASourceFor) {
  const std::string of = program(R"(, "process_data": [{"name": "seam", "from": "left", "fields": {"x": "Double"}}])");
  const std::string source = R"(, "sources": [{"data_set": "seam", "kind": "counter"}])";
  EXPECT_TRUE(Load(file("a", welds + source, of)).loaded);
  for (const std::string& text : {file("a", R"(, "offers": ["gripping"])" + source, of), file("m", source, of)}) {
    const Load load(text);
    EXPECT_NE(load.diagnostics.to_text().find("not published here"), std::string::npos)
        << text << load.diagnostics.to_text();
  }
}

struct Mistake {
  std::string text;
  std::string message;
};

TEST(RolesConfig, MistakesAreFound) {
  const std::string two =
      R"({"node": "a", "programs": [)" + program() + ", " +
      R"({"name": "q", "master": "n", "cycle": "1ms", "roles": [{"name": "r", "skill": "welding"}], "candidates": ["a"]}], )" +
      transport + welds + "}";
  const std::string nested = R"({"node": "m", "programs": [)" + program() + ", " +
                             R"({"name": "i", "within": "p", "master": "m", "slaves": ["x"], "cycle": "1ms"}], )" +
                             transport + "}";
  for (
      const Mistake& each : {
          Mistake{file("x"),
                  R"(not a participant of the program: found "x", expected the master, a slave or a candidate)"},
          Mistake{file("left"), "not a participant of the program"},  // a role is no node
          Mistake{
              file("a"),
              R"(a candidate without skills: found "a" without "offers", expected "offers" with some of "gripping", "welding")"},
          Mistake{
              file("a", R"(, "offers": ["weldin"])"),
              R"(error at /offers/0: a candidate for no role: found "weldin", expected a skill that a role of "p" needs: "gripping", "welding")"},
          Mistake{
              file("m", welds),
              R"(error at /offers: belongs to a candidate: found "m", which no program has among its "candidates", expected no "offers")"},
          Mistake{file("m", R"(, "absent": true)"), R"(error at /absent: belongs to a candidate)"},
          Mistake{file("m", R"(, "script": [{"at": "1s", "plug": "join"}])"),
                  R"(error at /script/0/plug: not a candidate of the program: found "m")"},
          Mistake{file("a", welds + R"(, "script": [{"at": "1s"}])"), R"(expected exactly one of "call" or "plug")"},
          Mistake{file("m", "", program("", R"([{"name": "left", "skill": "welding"}])", "")),
                  R"(roles that no node may have: found no "candidates")"},
          Mistake{file("m", "", program("", R"([{"name": "m", "skill": "welding"}])")),
                  R"(duplicate name: found "m" a second time)"},
          Mistake{file("m", "",
                       program("", R"([{"name": "left", "skill": "welding"}])", R"(, "candidates": ["a", "m", "a"])")),
                  R"(error at /program/candidates/1: a node twice in one program: found "m", which is the master)"},
          Mistake{file("m", "",
                       program("", R"([{"name": "left", "skill": "welding"}])", R"(, "candidates": ["a", "m", "a"])")),
                  R"(error at /program/candidates/2: a node twice in one program: found "a")"},
          Mistake{file("m", "", program(R"(, "variant": "paper")")), "roles with the handshake of the paper"},
          Mistake{file("m", "", program(R"(, "subscription": "all-to-all")")), "roles with all-to-all subscription"},
          Mistake{file("m", "", program(R"(, "announce_every": "500us")")),
                  "announcements within one cycle: found 500us, expected at least the cycle of 1ms"},
          Mistake{file("m", "", program(R"(, "slaves": ["x"])")), R"(exactly one of "slaves" or "roles")"},
          Mistake{file("m", "", R"({"name": "p", "master": "m", "cycle": "1ms"})"),
                  R"(exactly one of "slaves" or "roles")"},
          Mistake{file("m", "",
                       R"({"name": "p", "master": "m", "slaves": ["a"], "cycle": "1ms", "on_replacement": "restart"})"),
                  "on_replacement: belongs to a program with roles"},
          Mistake{file("m", "",
                       program(R"(, "process_data": [{"name": "bindings", "from": "m", "fields": {"x": "Double"}}])")),
                  "duplicate name: found \"bindings\""},
          Mistake{
              file("m", "", program(R"(, "process_data": [{"name": "d", "from": "a", "fields": {"x": "Double"}}])")),
              R"(found "a", expected the master or a role)"},
          Mistake{two, R"(a node that offers its skills to two programs: found "a" to "p" and "q")"},
          Mistake{
              nested,
              R"(roles in an outer program: found "roles" of "p", expected "slaves", of which the master of "i" is one)"},
      }) {
    const Load load(each.text);
    EXPECT_FALSE(load.loaded) << each.text;
    EXPECT_NE(load.diagnostics.to_text().find(each.message), std::string::npos) << each.text << "\n"
                                                                                << load.diagnostics.to_text();
  }
}

}  // namespace
}  // namespace takt::node::roles_config_test
