// SPDX-License-Identifier: Apache-2.0
// The engine of the studio: what it finds is what the commands find, and a newer text ends the work at an older one.
#include "studio/engine.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "evaluation/evaluate.hpp"
#include "results/result_json.hpp"
#include "scenario/resolve.hpp"
#include "studio/address.hpp"
#include "studio/document.hpp"
#include "tests/frontends/studio/support.hpp"

namespace takt::studio {
namespace {

/// Waits for a stage of that text; its findings.
Findings wait_for(Engine& engine, std::uint64_t revision, Stage stage) {
  std::uint64_t version = 0;
  for (int tries = 0; tries < 10'000; ++tries) {
    const Findings found = engine.wait_for_other(version, std::chrono::seconds(60));
    version = found.version;
    if (found.revision == revision && found.stage == stage) return found;
  }
  ADD_FAILURE() << "never came to " << name_of(stage);
  return {};
}

TEST(Engine, FindsWhatTheCommandsFind) {
  Engine engine("small.json");
  engine.set_text(7, small);
  const Findings found = wait_for(engine, 7, Stage::done);
  json::Diagnostics diagnostics;
  const auto resolved = scenario::load_text(small, "small.json", {}, diagnostics);
  ASSERT_TRUE(resolved) << diagnostics.to_text();
  scenario::Run run(*resolved);
  run.advance();
  EXPECT_EQ(found.result, results::run_json(evaluation::evaluate(run, false)));
  EXPECT_NE(found.proofs.find("\"verdict\": \"pass\""), std::string::npos);
  EXPECT_NE(found.network.find("\"name\": \"a\", \"kind\": \"host\""), std::string::npos) << found.network;
  EXPECT_NE(found.diagnostics.find("\"errors\": 0"), std::string::npos);
  EXPECT_TRUE(found.trouble.empty());
}

TEST(Engine, TellsMistakesAndDropsOldFigures) {
  Engine engine("small.json");
  engine.set_text(1, small);
  wait_for(engine, 1, Stage::done);
  std::string wrong = small;
  wrong.replace(wrong.find("\"to\": \"b\""), 9, "\"to\": \"c\"");
  engine.set_text(2, wrong);
  const Findings found = wait_for(engine, 2, Stage::refused);
  EXPECT_NE(found.diagnostics.find("small.json"), std::string::npos);
  EXPECT_TRUE(found.result.empty());
  EXPECT_TRUE(found.proofs.empty());
  EXPECT_FALSE(found.network.empty()) << "that of the last sound text";
}

TEST(Engine, ANewerTextEndsTheWorkAtAnOlderOne) {
  Engine engine("small.json");
  std::string endless = small;
  endless.replace(endless.find("20ms"), 4, "2400h");
  engine.set_text(1, endless);
  wait_for(engine, 1, Stage::running);
  engine.set_text(2, small);
  EXPECT_EQ(wait_for(engine, 2, Stage::done).revision, 2u);
}

TEST(Engine, EndsInTheMiddleOfARun) {
  Engine engine("small.json");
  std::string endless = small;
  endless.replace(endless.find("20ms"), 4, "2400h");
  engine.set_text(1, endless);
  wait_for(engine, 1, Stage::running);
}

TEST(Engine, ATextUnderTheHandIsWorkedAtInPart) {
  Engine engine("small.json", {.coarse_events = 10, .coarse_search = std::chrono::seconds(60)});
  engine.set_text(1, small);
  const std::string text = wait_for(engine, 1, Stage::done).text;
  EXPECT_EQ(text, Document::digest_of(small));
  std::string longer = small;
  longer.replace(longer.find("20ms"), 4, "100s");
  engine.set_text(2, longer, Pace::coarse);
  const Findings found = wait_for(engine, 2, Stage::sketched);
  EXPECT_NE(found.result.find("\"partial\": true"), std::string::npos);
  EXPECT_NE(found.proofs.find("\"bound_ps\""), std::string::npos);
  engine.set_text(3, small);
  EXPECT_EQ(wait_for(engine, 3, Stage::done).text, text);
}

TEST(Engine, ARunOfDaysIsNotWaitedForUnderTheHand) {
  Engine engine("small.json", {.coarse_events = 10, .coarse_search = std::chrono::seconds(0)});
  std::string longer = small;
  longer.replace(longer.find("20ms"), 4, "2400h");
  engine.set_text(1, longer, Pace::coarse);
  const Findings found = wait_for(engine, 1, Stage::sketched);
  EXPECT_NE(found.result.find("\"partial\": true"), std::string::npos);
  EXPECT_NE(found.proofs.find("\"partial\": true"), std::string::npos);
}

TEST(Engine, TheSameTextIsNotWorkedAtAgain) {
  Engine engine("small.json");
  engine.set_text(1, small);
  const std::uint64_t version = wait_for(engine, 1, Stage::done).version;
  engine.set_text(2, small);
  EXPECT_EQ(engine.wait_for_other(version, std::chrono::milliseconds(200)).version, version);
  EXPECT_TRUE(engine.is_current(1));
}

TEST(Engine, WhatIsNotProvedInTimeIsUndecided) {
  Engine engine("small.json", {.longest_proof = std::chrono::seconds(0)});
  engine.set_text(1, small);
  EXPECT_NE(wait_for(engine, 1, Stage::done).proofs.find("\"partial\": true"), std::string::npos);
}

TEST(Document, AFileThatSomebodyElseHasChangedIsNotWrittenOver) {
  const std::filesystem::path path = std::filesystem::path(testing::TempDir()) / "studio-conflict.json";
  std::filesystem::remove(path.string() + ".draft");
  std::ofstream(path) << "first";
  Document document(path.string());
  const std::string first = document.digest();
  EXPECT_EQ(first, Document::digest_of("first"));
  std::ofstream(path) << "theirs";
  EXPECT_EQ(document.digest(), Document::digest_of("theirs"));
  EXPECT_TRUE(document.save("mine", first).is_conflict);
  EXPECT_TRUE(document.save("mine", "").is_conflict);
  std::string problem;
  EXPECT_EQ(document.saved(problem), "theirs");
  // A draft that rests on the older file says so, also to the engine that comes next.
  EXPECT_EQ(document.keep_draft("mine", first), "");
  EXPECT_TRUE(Document(path.string()).is_newer_than_draft());
  EXPECT_EQ(document.keep_draft("mine", document.digest()), "");
  EXPECT_FALSE(document.is_newer_than_draft());
  EXPECT_FALSE(document.save("mine", document.digest()).is_conflict);
  EXPECT_EQ(document.saved(problem), "mine");
}

TEST(Document, AnEmptyTextOverAFullOneIsAskedFor) {
  const std::filesystem::path path = std::filesystem::path(testing::TempDir()) / "studio-empty.json";
  std::ofstream(path) << "full";
  Document document(path.string());
  EXPECT_EQ(document.keep_draft("typed", document.digest()), "");
  EXPECT_EQ(document.keep_draft(" \n", document.digest()), "");
  EXPECT_EQ(document.draft(), "typed") << "nothing is worth less than what was typed";
  EXPECT_TRUE(document.save("\n", document.digest()).empties);
  std::string problem;
  EXPECT_EQ(document.saved(problem), "full");
  EXPECT_FALSE(document.save("\n", document.digest(), true).empties);
  EXPECT_EQ(document.saved(problem), "\n");
}

TEST(AddressMemory, ServesTheEngineThatComesAfterACrash) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "studio-runtime";
  std::filesystem::create_directories(folder);
  std::filesystem::permissions(folder, std::filesystem::perms::owner_all);
  ::setenv("XDG_RUNTIME_DIR", folder.c_str(), 1);
  const Address own{8090, new_token()};
  const AddressMemory memory("plant.json");
  memory.keep(own);
  const auto last = AddressMemory("./plant.json").last();
  ASSERT_TRUE(last);
  EXPECT_EQ(last->port, 8090);
  EXPECT_EQ(last->token, own.token);
  EXPECT_FALSE(AddressMemory("other.json").last());
  memory.forget({8090, new_token()});
  EXPECT_TRUE(memory.last()) << "another engine's";
  // What others may read or write counts for nothing.
  const auto file = std::filesystem::directory_iterator(folder)->path();
  std::filesystem::permissions(file, std::filesystem::perms::group_read, std::filesystem::perm_options::add);
  EXPECT_FALSE(memory.last());
  memory.keep(own);
  std::filesystem::permissions(folder, std::filesystem::perms::others_write, std::filesystem::perm_options::add);
  EXPECT_FALSE(memory.last());
  std::filesystem::permissions(folder, std::filesystem::perms::others_write, std::filesystem::perm_options::remove);
  memory.forget(own);
  EXPECT_FALSE(memory.last());
  EXPECT_TRUE(std::filesystem::is_empty(folder));
  ::unsetenv("XDG_RUNTIME_DIR");
}

TEST(Document, ADraftOutlivesItsEngineAndGoesWhenItIsSaved) {
  const std::filesystem::path path = std::filesystem::path(testing::TempDir()) / "studio-document.json";
  std::filesystem::remove(path);
  std::filesystem::remove(path.string() + ".draft");
  std::string problem;
  {
    Document document(path.string());
    EXPECT_FALSE(document.saved(problem));
    EXPECT_TRUE(problem.empty()) << "it is only not there";
    EXPECT_EQ(document.keep_draft("typed", ""), "");
  }
  Document document(path.string());
  EXPECT_EQ(document.draft(), "typed");
  EXPECT_EQ(document.save("saved", "").problem, "");
  EXPECT_EQ(document.saved(problem), "saved");
  EXPECT_FALSE(document.draft());
  EXPECT_EQ(document.keep_draft("more", document.digest()), "");
  EXPECT_EQ(document.keep_draft("saved", document.digest()), "") << "typed back to what the file has";
  EXPECT_FALSE(document.draft());
  EXPECT_NE(Document("/dev/null/at/all.json").save("x", "").problem, "");
}

}  // namespace
}  // namespace takt::studio
