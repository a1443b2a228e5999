// The engine of the studio: what it finds is what the commands find, and a newer text ends the work at an older one.
#include "studio/engine.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "evaluation/evaluate.hpp"
#include "results/result_json.hpp"
#include "scenario/resolve/resolve.hpp"
#include "studio/document.hpp"
#include "tests/studio/support.hpp"

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

TEST(Document, ADraftOutlivesItsEngineAndGoesWhenItIsSaved) {
  const std::filesystem::path path = std::filesystem::path(testing::TempDir()) / "studio-document.json";
  std::filesystem::remove(path);
  std::filesystem::remove(path.string() + ".draft");
  std::string problem;
  {
    Document document(path.string());
    EXPECT_FALSE(document.saved(problem));
    EXPECT_TRUE(problem.empty()) << "it is only not there";
    EXPECT_EQ(document.keep_draft("typed"), "");
  }
  Document document(path.string());
  EXPECT_EQ(document.draft(), "typed");
  EXPECT_EQ(document.save("saved"), "");
  EXPECT_EQ(document.saved(problem), "saved");
  EXPECT_FALSE(document.draft());
  EXPECT_EQ(document.keep_draft("more"), "");
  EXPECT_EQ(document.keep_draft("saved"), "") << "typed back to what the file has";
  EXPECT_FALSE(document.draft());
  EXPECT_NE(Document("/dev/null/at/all.json").save("x"), "");
}

}  // namespace
}  // namespace takt::studio
