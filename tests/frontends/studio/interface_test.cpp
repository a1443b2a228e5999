// SPDX-License-Identifier: Apache-2.0
// What the page may ask: answers of the engine's findings, and commands beside it that can be ended.
#include "studio/interface.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "tests/frontends/studio/support.hpp"

namespace takt::studio {
namespace {

class Interfaces : public testing::Test {
 protected:
  Interfaces()
      : folder_(std::filesystem::path(testing::TempDir()) / ("studio-interface-" + std::to_string(::getpid()))),
        document_((folder_ / "plant.json").string()),
        engine_("plant.json"),
        interface_(engine_, document_, "{}", "/bin/echo") {
    std::filesystem::create_directories(folder_);
  }
  ~Interfaces() override {
    interface_.stop();
    std::filesystem::remove_all(folder_);
  }

  Answer ask(std::string_view method, std::string_view path, std::map<std::string, std::string> parameters = {},
             std::string_view body = {}) {
    for (const Interface::Route& route : Interface::routes())
      if (route.method == method && route.path == path)
        return interface_.answer(route, {[&](const char* name) { return parameters[name]; }, body});
    ADD_FAILURE() << "no route " << path;
    return {};
  }
  void know(std::uint64_t revision, std::string_view text) {
    ask("PUT", "/api/text", {{"revision", std::to_string(revision)}}, text);
    std::uint64_t version = 0;
    for (int tries = 0; tries < 1000; ++tries) {
      const Findings found = engine_.wait_for_other(version, std::chrono::seconds(60));
      version = found.version;
      if (found.revision == revision && (found.stage == Stage::done || found.stage == Stage::refused)) return;
    }
    ADD_FAILURE() << "never done";
  }

  std::filesystem::path folder_;
  Document document_;
  Engine engine_;
  Interface interface_;
};

TEST_F(Interfaces, ExplainAFrameAndTheWorstOfARequirement) {
  know(1, small);
  const Answer frame = ask("GET", "/api/explain", {{"revision", "1"}, {"stream", "s"}, {"sequence", "3"}});
  EXPECT_EQ(frame.status, 200);
  EXPECT_NE(frame.body.find("\"sequence\": 3"), std::string::npos);
  EXPECT_NE(frame.body.find("\"transmission\""), std::string::npos);
  const Answer worst = ask("GET", "/api/explain", {{"revision", "1"}, {"run", "0"}});
  EXPECT_EQ(worst.status, 200) << worst.body;
  EXPECT_NE(worst.body.find("the worst run that was found"), std::string::npos);
  EXPECT_NE(worst.body.find("\"parts\""), std::string::npos);
  EXPECT_EQ(ask("GET", "/api/explain", {{"revision", "1"}, {"stream", "t"}}).status, 400);
}

TEST_F(Interfaces, TellTimelinesOfTheTextThatStandsThere) {
  know(1, small);
  EXPECT_EQ(ask("GET", "/api/timeline", {{"revision", "1"}}).status, 200);
  EXPECT_EQ(ask("GET", "/api/timeline", {{"revision", "1"}, {"run", "0"}}).status, 200);
  EXPECT_STREQ(
      ask("GET", "/api/piece", {{"revision", "1"}, {"level", "2"}, {"index", "1"}, {"first", "0"}, {"count", "32"}})
          .type,
      Answer::octets);
  EXPECT_EQ(ask("GET", "/api/timeline", {{"revision", "1"}, {"from", "20000000000"}}).status, 400) << "the run is over";
  for (const auto& [key, value] : std::vector<std::pair<std::string, std::string>>{{"revision", "2"},
                                                                                   {"revision", ""},
                                                                                   {"run", "7"},
                                                                                   {"run", "-3"},
                                                                                   {"run", "99999999999999999999999"},
                                                                                   {"from", "18446744073709551615"}}) {
    std::map<std::string, std::string> parameters = {{"revision", "1"}};
    parameters[key] = value;
    EXPECT_GE(ask("GET", "/api/timeline", parameters).status, 400) << key << ' ' << value;
  }
  know(2, "{");
  EXPECT_EQ(ask("GET", "/api/timeline", {{"revision", "1"}}).status, 409);
  EXPECT_EQ(ask("GET", "/api/timeline", {{"revision", "2"}}).status, 409) << "it is not sound";
}

TEST_F(Interfaces, KeepLayoutsBesideTheScenario) {
  EXPECT_EQ(ask("GET", "/api/layout").body, "{}");
  EXPECT_EQ(ask("PUT", "/api/layout", {}, R"({"nodes": {"a": [1, 2.5]}})").status, 200);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "plant.json.layout"));
  EXPECT_EQ(ask("GET", "/api/layout").body, R"({"nodes": {"a": [1, 2.5]}})");
  EXPECT_EQ(ask("PUT", "/api/layout", {}, "{").status, 400);
  EXPECT_EQ(ask("PUT", "/api/layout", {}, std::string(2'000'000, ' ')).status, 400);
  EXPECT_EQ(ask("PUT", "/api/layout", {}, "").status, 200);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "plant.json.layout"));
}

TEST_F(Interfaces, StartStudiesThatStandBesideTheScenarioOnly) {
  std::ofstream(folder_ / "some.json") << R"({"factors": [], "measures": []})";
  std::ofstream(folder_ / "other.json") << "{}";
  EXPECT_EQ(ask("GET", "/api/studies").body, R"(["some.json"])");
  for (const char* const name : {"other.json", "../some.json", "/etc/passwd", "", "--help"})
    EXPECT_EQ(ask("PUT", "/api/study", {{"file", name}}).status, 400) << name;
  EXPECT_EQ(ask("PUT", "/api/study", {{"file", "some.json"}}).status, 200);
}

TEST_F(Interfaces, LeaveNoCopyOfATextBehind) {
  ask("PUT", "/api/compare", {{"length", "1"}}, "AB");
  for (int tries = 0;
       tries < 1000 &&
       ask("GET", "/api/errand", {{"name", "compare"}}).body.find("\"running\": false") == std::string::npos;
       ++tries)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_EQ(ask("GET", "/api/errand", {{"name", "nothing"}}).status, 404);
  ask("DELETE", "/api/errand", {{"name", "compare"}});
  ask("DELETE", "/api/errand", {{"name", "verify"}});
  EXPECT_TRUE(std::filesystem::is_empty(folder_));
}

TEST_F(Interfaces, StartNothingWhenAllEnds) {
  interface_.stop();
  EXPECT_EQ(ask("PUT", "/api/explore", {}, small).status, 503);
}

Command::State ended(Command& command) {
  Command::State state = command.state();
  for (int tries = 0; tries < 6000 && state.is_running; ++tries) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    state = command.state();
  }
  EXPECT_FALSE(state.is_running);
  return state;
}

TEST(Commands, TellOutputErrorsAndStatus) {
  const auto command = Command::start("/bin/sh", {"-c", "echo out; echo err >&2; exit 7"}, {});
  ASSERT_TRUE(command);
  const Command::State state = ended(*command);
  EXPECT_EQ(state.output, "out\n");
  EXPECT_EQ(state.errors, "err\n");
  EXPECT_EQ(state.status, 7);
}

TEST(Commands, AreEndedWithAllThatTheyStarted) {
  auto command = Command::start("/bin/sh", {"-c", "sleep 600 & echo $!; sleep 600"}, {});
  ASSERT_TRUE(command);
  for (int tries = 0; tries < 1000 && command->state().output.empty(); ++tries)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  const pid_t child = std::stoi(command->state().output);
  command.reset();
  for (int tries = 0; tries < 1000 && std::filesystem::exists("/proc/" + std::to_string(child) + "/exe"); ++tries)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_FALSE(std::filesystem::exists("/proc/" + std::to_string(child) + "/exe")) << "its own child lives on";
}

TEST(Commands, ThatCannotBeStartedSaySo) {
  const auto command = Command::start("/nowhere/at/all", {}, {});
  ASSERT_TRUE(command);
  EXPECT_EQ(ended(*command).status, 127);
}

TEST(Commands, ThatTalkTooMuchAreCutOff) {
  const auto command = Command::start("/bin/sh", {"-c", "head -c 200000 /dev/zero >&2; echo done"}, {});
  ASSERT_TRUE(command);
  const Command::State state = ended(*command);
  EXPECT_EQ(state.errors.size(), 100'000u);
  EXPECT_EQ(state.output, "done\n");
}

}  // namespace
}  // namespace takt::studio
