// SPDX-License-Identifier: Apache-2.0
// All that must hold of a run of a resolved scenario, in one word.
#pragma once

#include <exception>
#include <string>

#include "tests/wire_checker/checked_run.hpp"

namespace takt::wire_checker {

inline std::uint64_t digest_of(const scenario::Resolved& resolved, std::uint64_t tie_shuffle) {
  scenario::Run run(resolved, tie_shuffle);
  run.advance();
  return run.simulation().digest().value();
}

/// What is wrong; "" if nothing is: the wire checker finds nothing, the accounts agree, nothing leaks, and the digest
/// is the same without a recorder and whatever the order of equal events.
inline std::string verify(const scenario::Resolved& resolved) {
  try {
    CheckedRun checked(resolved);
    const std::string found = checked.to_the_end().all();
    if (!found.empty()) return found;
    const std::uint64_t digest = checked.run.simulation().digest().value();
    if (digest_of(resolved, 0) != digest) return "the digest differs without a recorder\n";
    for (const std::uint64_t key : {1ULL, 0xDEADBEEFULL, ~0ULL})
      if (digest_of(resolved, key) != digest) return "the digest depends on the order of equal events\n";
  } catch (const std::exception& broken) {
    return std::string(broken.what()) + "\n";
  }
  return {};
}

}  // namespace takt::wire_checker
