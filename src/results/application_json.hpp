// Applications, gateways and signals as result.json has them.
#pragma once

#include "results/run_result.hpp"
#include "scenario/json/node.hpp"

namespace takt::results {

scenario::json::Node applications_node(const RunResult& result);
scenario::json::Node signals_node(const RunResult& result);

}  // namespace takt::results
