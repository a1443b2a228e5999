// SPDX-License-Identifier: Apache-2.0
// The node files of the coexistence measurement are sound, and each node has its own part of them.
#include "emulate/coexistence_files.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "node/applications/config.hpp"
#include "node/dds/participant.hpp"

namespace takt::emulate::coexistence_files_test {
namespace {

TEST(CoexistenceFiles, EveryNodeHasASoundFileWithItsOwnPart) {
  if (!node::has_dds()) GTEST_SKIP() << "this build has no DDS";
  const auto path =
      std::filesystem::temp_directory_path() / ("takt-coexistence-" + std::to_string(::getpid()) + ".json");
  for (const CaseStudy study : {CaseStudy::mirror, CaseStudy::gateway})
    for (const std::string& name : nodes_of(study))
      for (const int interval : {10, 5, 2, 1}) {
        std::ofstream(path) << node_file(
            study, name, interval, 7, {"lo", 4840, 3},
            "/tmp/a path that is longer than what a diagnostic would quote, so it must be there in full.json");
        json::Diagnostics diagnostics;
        const auto loaded = node::load_applications(path.string(), diagnostics);
        ASSERT_TRUE(loaded) << name << "\n" << diagnostics.to_text();
        const std::size_t gateways = name == "gateway" ? 1 : 0;
        EXPECT_EQ(loaded->config.gateways.size(), gateways) << name;
        ASSERT_EQ(loaded->config.applications.size(), 1 - gateways) << name;
        const auto& scheduler =
            gateways == 1 ? loaded->config.gateways[0].scheduler : loaded->config.applications[0].scheduler;
        EXPECT_EQ(scheduler.tests, 7u);
        EXPECT_EQ(scheduler.window.ps(), 10'000'000'000);
        for (const auto& application : loaded->config.applications) {
          for (const node::Thread& thread : application.threads)
            EXPECT_EQ(thread.every.ps(), interval * 1'000'000'000LL);
        }
        EXPECT_TRUE(loaded->config.statistics->ends_with("in full.json"));
      }
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace takt::emulate::coexistence_files_test
