// What a verification says: a page for people, and JSON.
#pragma once

#include <string>
#include <vector>

#include "verify/sandwich.hpp"

namespace takt::verify {

/// `files`: by line, the file that replays its worst run, or "".
std::string text_report(const std::string& scenario, const Verification& verification, const std::vector<std::string>& files);
/// One object: scenario, verdict, runs, partial, free[], requirements[] {text, simulated_ps, adversarial_ps, bound_ps, limit_ps, verdict, tightness,
/// runs, exhaustive, reason, assumptions[], file}. Figures that there are not are null.
std::string json_report(const std::string& scenario, const Verification& verification, const std::vector<std::string>& files);

}  // namespace takt::verify
