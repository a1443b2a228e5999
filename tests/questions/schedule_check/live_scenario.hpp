// SPDX-License-Identifier: Apache-2.0
// A scenario out of its text, and what a run of it says.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <stdexcept>
#include <string>

#include "evaluation/evaluate.hpp"
#include "scenario/resolve.hpp"
#include "scenario/run/run.hpp"

namespace takt::schedule_check {

/// Null if it is refused, which fails the test unless it asks for the `problems`.
inline std::unique_ptr<scenario::Resolved> load_live(const std::string& text, std::string* problems = nullptr) {
  json::Diagnostics diagnostics;
  auto resolved = scenario::load_text(text, "s.json", {}, diagnostics);
  if (problems != nullptr)
    *problems = diagnostics.to_text();
  else
    EXPECT_TRUE(resolved) << diagnostics.to_text();
  return resolved;
}

inline results::RunResult run_live(const scenario::Resolved& resolved) {
  scenario::Run live(resolved);
  live.advance();
  return evaluation::evaluate(live, false);
}

inline const results::StreamResult& stream_of(const results::RunResult& result, const std::string& name) {
  for (const results::StreamResult& each : result.streams)
    if (each.name == name) return each;
  throw std::runtime_error("no stream " + name);
}

}  // namespace takt::schedule_check
