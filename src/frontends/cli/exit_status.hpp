// SPDX-License-Identifier: Apache-2.0
// The exit status of takt, the same for every sub-command.
#pragma once

namespace takt::cli {

enum class ExitStatus : int {
  pass = 0,
  requirement_failed = 1,
  bad_input = 2,       ///< nothing was written
  internal_error = 3,  ///< takt is wrong, or the machine failed it (disk full, no memory)
  undecided = 4,       ///< neither proved nor refuted
  interrupted = 130,   ///< Ctrl-C; what was reached is reported as partial
};

/// Of several scenarios the gravest: a mistake of takt, then one that was broken off, a failure, what is undecided.
constexpr ExitStatus graver(ExitStatus a, ExitStatus b) {
  constexpr ExitStatus order[] = {ExitStatus::internal_error, ExitStatus::bad_input, ExitStatus::interrupted,
                                  ExitStatus::requirement_failed, ExitStatus::undecided};
  for (const ExitStatus each : order)
    if (a == each || b == each) return each;
  return ExitStatus::pass;
}

}  // namespace takt::cli
