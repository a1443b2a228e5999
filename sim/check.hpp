// SPDX-License-Identifier: Apache-2.0
// CHECK: invariants of takt itself. They stay on in release builds.
//
// A user's mistake is never a CHECK (it is a diagnostic, see json/diagnostics.hpp). A failed CHECK means that takt is
// wrong; it unwinds to the loop of the simulation, which adds simulated time, event and seed, and to main, which
// exits 3.
#pragma once

#include <stdexcept>
#include <string>

namespace takt::sim {

/// An invariant of takt does not hold. Carries the text of the condition and where it stands in the source.
class InvariantBroken : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

/// Throws InvariantBroken. Out of line, so that a CHECK costs its callers one call.
[[noreturn]] [[gnu::cold]] void check_failed(const char* condition, const char* meaning, const char* file, int line);

}  // namespace takt::sim

/// CHECK(condition, "what is broken when it does not hold")
#define TAKT_CHECK(condition, meaning)                                    \
  do {                                                                    \
    if (!(condition)) [[unlikely]]                                        \
      ::takt::sim::check_failed(#condition, meaning, __FILE__, __LINE__); \
  } while (false)
