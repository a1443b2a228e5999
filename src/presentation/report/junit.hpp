// SPDX-License-Identifier: Apache-2.0
// Verdicts as JUnit XML, which systems of continuous integration show: one test case for each requirement.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "results/run_result.hpp"
#include "scenario/figures/requirement.hpp"
#include "verify/verification.hpp"

namespace takt::report {

/// A requirement: its verdict, figures and limit are properties.
struct JunitCase {
  /// Undecided is skipped: neither proved nor refuted, and no figure of either. The exit status tells it from a pass.
  enum class Outcome : std::uint8_t { passed, failed, error, skipped };
  std::string name;  ///< "REQ-12: stream camera latency at most 7ms"
  Outcome outcome = Outcome::passed;
  std::string verdict;
  std::string why;  ///< of one that has not passed
  std::vector<std::pair<std::string, std::string>> properties = {};
};

/// A scenario.
struct JunitSuite {
  std::string name;
  std::string file;
  std::vector<std::pair<std::string, std::string>> properties = {};
  std::vector<JunitCase> cases = {};
};

JunitSuite suite_of(const std::string& file, const results::RunResult& result);
/// `replays`: by line, the file that replays its worst run, or "".
JunitSuite suite_of(const std::string& file, const std::string& scenario, const verify::Verification& verification,
                    const std::vector<std::string>& replays);
/// Of a scenario that was not looked at, since Ctrl-C came before.
JunitSuite suite_of_interrupted(const std::string& file, const scenario::Resolved& resolved,
                                const std::vector<bool>& asked);

/// The file: well formed whatever the names are. No times and dates, so that equal verdicts are equal files.
std::string junit_text(std::string_view command, const std::vector<JunitSuite>& suites);

}  // namespace takt::report
