// SPDX-License-Identifier: Apache-2.0
// What a verification says: a page for people, and JSON.
#pragma once

#include <string>
#include <vector>

#include "verify/verification.hpp"

namespace takt::verify {

/// The files of a contradiction: the run, and the scenario whose bound it exceeds; empty if they are not written.
struct Witnesses {
  std::string run;
  std::string bound;
};

/// `files`: by line, the file that replays its worst run, or "".
std::string text_report(const std::string& scenario, const Verification& verification,
                        const std::vector<std::string>& files, const Witnesses& witnesses = {});
/// Keys and meaning: docs/reference/verify.md.
std::string json_report(const std::string& scenario, const Verification& verification,
                        const std::vector<std::string>& files, const Witnesses& witnesses = {});

}  // namespace takt::verify
