// SPDX-License-Identifier: Apache-2.0
// Runs a scenario and prints its digest and the number of its events: what builds of takt are compared by, without the
// commands around it.
#include <cstdio>
#include <string>
#include <vector>

#include "evaluation/evaluate.hpp"
#include "scenario/resolve.hpp"
#include "scenario/run/run.hpp"

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fputs("usage: takt_digest SCENARIO DURATION SEED\n", stderr);
    return 2;
  }
  takt::json::Diagnostics diagnostics;
  const auto resolved = takt::scenario::load_file(
      argv[1], {"/duration=" + std::string(argv[2]), "/seed=" + std::string(argv[3])}, diagnostics);
  if (!resolved) {
    std::fputs(diagnostics.to_text().c_str(), stderr);
    return 2;
  }
  takt::scenario::Run run(*resolved);
  run.advance();
  const takt::results::RunResult result = takt::evaluation::evaluate(run, false);
  std::printf("%016llx %llu\n", static_cast<unsigned long long>(result.digest),
              static_cast<unsigned long long>(result.events));
  return 0;
}
