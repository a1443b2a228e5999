// What a verification says: a page for people, and JSON.
#pragma once

#include <string>
#include <vector>

#include "verify/sandwich.hpp"

namespace takt::verify {

/// The files of a contradiction: the run, and the scenario whose bound it exceeds; empty if they are not written.
struct Witnesses {
  std::string run;
  std::string bound;
};

/// `files`: by line, the file that replays its worst run, or "".
std::string text_report(const std::string& scenario, const Verification& verification, const std::vector<std::string>& files, const Witnesses& witnesses = {});
/// One object: scenario, verdict, runs, partial, free[], requirements[] {text, simulated_ps, adversarial_ps, bound_ps, limit_ps, verdict, tightness,
/// runs, exhaustive, reason, remark, gives_away[] {where, what, bound_ps, run_ps}, assumptions[], file}, assumptions[] {name, text, standing, why, holds_from_ps}, and contradiction {text, run, bound} if there is one. Figures that there are not are null.
std::string json_report(const std::string& scenario, const Verification& verification, const std::vector<std::string>& files, const Witnesses& witnesses = {});

}  // namespace takt::verify
