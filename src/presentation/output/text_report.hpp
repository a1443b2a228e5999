// SPDX-License-Identifier: Apache-2.0
// The page that a person reads after a run, and the page that `takt check` prints.
#pragma once

#include <string>

#include "output/table.hpp"
#include "results/run_result.hpp"
#include "scenario/resolved/resolved.hpp"

namespace takt::output {

/// The whole report of a run.
std::string run_report(const results::RunResult& result, const Layout& layout = {});
/// One line: the verdict and the digest.
std::string run_line(const results::RunResult& result);
/// What a scenario resolves to: nodes, paths, load of links and queues.
std::string check_report(const scenario::Resolved& resolved);

/// A duration for people: at most three decimals of a fitting unit, "30.246 us".
std::string readable(sim::Duration duration);

}  // namespace takt::output
