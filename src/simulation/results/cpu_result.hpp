// SPDX-License-Identifier: Apache-2.0
// What the processors of hosts did in a run: plain data, like run_result.hpp.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "json/type.hpp"
#include "results/application_result.hpp"
#include "sim/time.hpp"

namespace takt::results {

struct CpuThreadResult {
  std::string name;
  std::string policy;
  std::uint64_t jobs = 0;  ///< done
  std::uint64_t refused = 0;
  std::uint64_t late = 0;                   ///< done behind the thread's deadline
  std::optional<DurationSummary> response;  ///< from release to end; none without a job
  std::optional<sim::Duration> response_p99;
  double utilisation = 0;  ///< share of one core's time
};

struct CpuResult {
  std::string node;
  std::uint32_t cores = 1;
  double utilisation = 0;  ///< share of all cores' time
  std::vector<CpuThreadResult> threads;
};

// What result.json holds of them: the tables.
const json::Record& describe(json::Type<CpuThreadResult>);
const json::Record& describe(json::Type<CpuResult>);

}  // namespace takt::results
