// SPDX-License-Identifier: Apache-2.0
#include "results/result_json.hpp"

#include "json/record.hpp"

namespace takt::results {

json::Node run_node(const RunResult& result) { return json::ShapeOf<RunResult>::write(result); }
std::string run_json(const RunResult& result) { return json::pretty(run_node(result)); }

}  // namespace takt::results
