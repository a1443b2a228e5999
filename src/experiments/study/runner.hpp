// SPDX-License-Identifier: Apache-2.0
// Runs the points of a study that are missing, on many processes, and keeps each as it comes.
#pragma once

#include <functional>
#include <string>

#include "study/plan.hpp"
#include "study/store.hpp"

namespace takt::study {

/// A part of the points: those whose number leaves the rest index - 1 when it is divided by count.
struct Shard {
  std::uint64_t index = 1;  ///< from 1 on
  std::uint64_t count = 1;
  bool has(std::uint64_t point) const { return point % count == index - 1; }
};

struct RunOptions {
  unsigned jobs = 1;
  unsigned threads = 1;  ///< of each point
  Shard shard;
  std::function<void(const char* what, std::uint64_t done, std::uint64_t of)> progress;
  std::function<bool()> interrupted;
};

/// Resolves the variants of the shard's points that are not finished. The mistakes as text, empty if the study can run:
/// with "impossible": "recorded" that is so if at least one variant is sound.
std::string validate(const Plan& plan, const RunOptions& options, const std::vector<bool>& finished);

struct RunSummary {
  std::uint64_t ran = 0;
  std::uint64_t troubled = 0;  ///< of those, not done
  bool interrupted = false;
  std::string problem;  ///< why it ended early
};

/// Runs what is missing of the shard. `finished` is by point, from the store.
RunSummary run_study(const Plan& plan, Store& store, const RunOptions& options, const std::vector<bool>& finished);

}  // namespace takt::study
