// SPDX-License-Identifier: Apache-2.0
#include "study/store.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "study/content.hpp"
#include "study/runner.hpp"
#include "support.hpp"

namespace takt::study {
namespace {

const std::string members =
    R"("replications": 3, "factors": [{"name": "size", "set": ["/streams/0/payload"], "values": ["100B", "200B", "300B"]},
                                                              {"name": "rate", "set": ["/network/links/0/rate"], "values": ["100Mbps", "1Gbps"]}])";

std::unique_ptr<Store> run_to(const Plan& plan, const std::string& path, RunOptions options, bool resumes = false) {
  std::string problem;
  auto store = resumes ? Store::open(path, problem) : Store::create(path, plan, problem);
  EXPECT_TRUE(store) << problem;
  std::vector<bool> finished;
  EXPECT_EQ(store->finished(finished), "");
  EXPECT_EQ(validate(plan, options, finished), "");
  EXPECT_EQ(run_study(plan, *store, options, finished).problem, "");
  return store;
}

std::pair<std::uint64_t, std::uint64_t> digest_of(const Store& store) {
  std::uint64_t digest = 0;
  std::uint64_t count = 0;
  EXPECT_EQ(store.results_digest(digest, count), "");
  return {digest, count};
}

TEST(Store, SameResultsForAnyNumberOfJobsAndShards) {
  const Folder folder;
  const auto plan = plan_of(folder, members);
  RunOptions options;
  const auto expected = digest_of(*run_to(*plan, folder.file("one.sqlite"), options));
  EXPECT_EQ(expected.second, 18u);
  options.jobs = 4;
  EXPECT_EQ(digest_of(*run_to(*plan, folder.file("four.sqlite"), options)), expected);
  std::vector<std::string> parts;
  for (const std::uint64_t i : {1u, 2u, 3u}) {
    options.shard = {i, 3};
    parts.push_back(folder.file("part" + std::to_string(i)));
    EXPECT_EQ(digest_of(*run_to(*plan, parts.back(), options)).second, 6u);
  }
  EXPECT_EQ(merge_stores(folder.file("all.sqlite"), parts), "");
  std::string problem;
  EXPECT_EQ(digest_of(*Store::open(folder.file("all.sqlite"), problem)), expected);
  EXPECT_EQ(merge_stores(folder.file("half.sqlite"), {parts[2], parts[0]}), "");
  options.shard = {};
  EXPECT_EQ(digest_of(*run_to(*plan, folder.file("half.sqlite"), options, true)), expected) << "what is missing is run";
}

TEST(Store, MergeRefusesMixtures) {
  const Folder folder;
  const auto plan = plan_of(folder, members);
  const auto other = plan_of(folder, members + R"(, "limits": [{"measure": "delay", "at_most": "1ms"}])");
  std::string problem;
  Store::create(folder.file("a"), *plan, problem);
  Store::create(folder.file("b"), *other, problem);
  EXPECT_NE(merge_stores(folder.file("ab"), {folder.file("a"), folder.file("b")}).find("is of another study"),
            std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(folder.file("ab")));
  folder.write("text", "no store");
  EXPECT_NE(merge_stores(folder.file("at"), {folder.file("a"), folder.file("text")}), "");
  EXPECT_NE(merge_stores(folder.file("a"), {folder.file("a")}).find("is there already"), std::string::npos);
}

TEST(Store, MergeRefusesContradictions) {
  const Folder folder;
  const auto plan = plan_of(folder, members);
  std::string problem;
  Outcome outcome;
  outcome.values = {1.0};
  for (const char* const name : {"a", "b"}) {
    outcome.digest += 1;
    EXPECT_EQ(Store::create(folder.file(name), *plan, problem)->add(*plan, 4, outcome), "");
  }
  EXPECT_NE(merge_stores(folder.file("ab"), {folder.file("a"), folder.file("b")}).find("point 4 has another result"),
            std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(folder.file("ab")));
}

TEST(Store, AnExistingFileIsNotOverwritten) {
  const Folder folder;
  const auto plan = plan_of(folder, members);
  const std::string path = folder.write("precious", "text");
  std::string problem;
  EXPECT_FALSE(Store::create(path, *plan, problem));
  std::string content;
  std::getline(std::ifstream(path), content);
  EXPECT_EQ(content, "text");
  EXPECT_FALSE(Store::open(path, problem));
}

TEST(Store, ImpossibleVariantsAreRowsIfTheStudySaysSo) {
  const Folder folder;
  const std::string impossible =
      R"("factors": [{"name": "size", "set": ["/streams/0/payload"], "values": ["100B", "9000B"]}])";
  RunOptions options;
  EXPECT_NE(validate(*plan_of(folder, impossible), options, {false, false}).find("size = 9000B"), std::string::npos);
  const auto plan = plan_of(folder, impossible + R"(, "impossible": "recorded")");
  run_to(*plan, folder.file("s"), options);
  std::string problem;
  const auto content = read_store(folder.file("s"), problem);
  ASSERT_TRUE(content) << problem;
  ASSERT_EQ(content->troubles.size(), 1u);
  EXPECT_EQ(content->troubles[0].status, Status::impossible);
  EXPECT_NE(content->troubles[0].error.find("study.json:"), std::string::npos) << content->troubles[0].error;
}

TEST(Store, APointThatTakesTooLongIsARow) {
  const Folder folder;
  const auto plan = plan_of(
      folder,
      R"("effort": {"cpu": "100ms"}, "factors": [{"name": "duration", "set": ["/duration"], "values": ["1ms", "10h"]}])");
  run_to(*plan, folder.file("s"), {});
  std::string problem;
  const auto content = read_store(folder.file("s"), problem);
  ASSERT_TRUE(content) << problem;
  EXPECT_EQ(content->status, (std::vector<Status>{Status::done, Status::too_long}));
  EXPECT_NE(content->troubles[0].error.find("0.1 s of CPU time"), std::string::npos);
}

}  // namespace
}  // namespace takt::study
