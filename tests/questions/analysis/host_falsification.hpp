// SPDX-License-Identifier: Apache-2.0
// What a run says of the bounds of threads and of the reactions of their Programs.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "scenario/run/cpu_monitor.hpp"
#include "tests/questions/analysis/falsification.hpp"

namespace takt::analysis::test {

/// How near threads come to their bounds.
inline void judge_threads(const scenario::Run& run, const Bounds& bounds, const std::string& text,
                          std::vector<double>& shares, std::size_t& unbounded) {
  const scenario::Resolved& r = run.resolved();
  for (std::uint32_t n = 0; n < r.plan.nodes.size(); ++n)
    for (std::size_t t = 0; t < bounds.hosts->nodes()[n].size(); ++t) {
      const ThreadTime& time = bounds.hosts->nodes()[n][t];
      const scenario::CpuThreadFigures& seen = run.cpu_monitor(models::NodeIndex{n})->figures(t, {});
      if (!is_bounded(time.worst)) {
        ++unbounded;
        continue;
      }
      const std::string name = r.plan.nodes[n].name + "/" + r.plan.nodes[n].cpu->threads[t].name + "\n" + text;
      EXPECT_EQ(seen.refused, 0U) << name;
      if (seen.response.empty()) continue;
      EXPECT_LE(seen.response.maximum(), sim::Duration::from_ps(time.worst)) << name;
      EXPECT_GE(seen.response.minimum(), sim::Duration::from_ps(time.least)) << name;
      shares.push_back(static_cast<double>(seen.response.maximum().ps()) / static_cast<double>(time.worst));
    }
}

/// Starts and halts that were called, against those bounds that stand: whose assumptions the scenario keeps. How many
/// were.
inline std::size_t judge_reactions(const scenario::Run& run, const Bounds& bounds, const std::string& text) {
  std::size_t judged = 0;
  for (std::size_t p = 0; p < run.resolved().programs.size(); ++p)
    for (const handshake::Reaction& seen : run.monitor(p).reactions())
      for (const ReactionBound& bound : bounds.reactions) {
        const scenario::Reaction kind =
            seen.kind == handshake::IntentKind::Start ? scenario::Reaction::start : scenario::Reaction::halt;
        if (bound.program != p || bound.cause != handshake::Cause::command || bound.kind != kind || !bound.bound)
          continue;
        if (seen.cause != handshake::Cause::command || seen.completed == sim::TrueTime::never()) continue;
        if (!bounds.ledger.objection(bound.assumptions, {}).empty()) continue;
        ++judged;
        EXPECT_LE(seen.completed - seen.began, *bound.bound) << text;
      }
  return judged;
}

}  // namespace takt::analysis::test
