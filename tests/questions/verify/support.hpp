// SPDX-License-Identifier: Apache-2.0
// What tests of takt verify begin with.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <stdexcept>
#include <string>

#include "scenario/resolve.hpp"
#include "verify/verification.hpp"

namespace takt::verify {

/// Enough to see something, little enough for many scenarios.
inline Options small() {
  Options options;
  options.search.seeds = 1;
  options.search.events = 400'000;
  options.proof.states = 100'000;
  return options;
}

/// A scenario that must be sound.
inline std::unique_ptr<scenario::Resolved> resolved(const std::string& text) {
  json::Diagnostics diagnostics;
  auto made = scenario::load_text(text, "test", {}, diagnostics);
  if (!made) throw std::runtime_error(diagnostics.to_text());
  return made;
}

}  // namespace takt::verify
