// What reports say of applications, gateways and signals.
#pragma once

#include <string>

#include "results/run_result.hpp"
#include "scenario/json/node.hpp"

namespace takt::output {

scenario::json::Node applications_node(const results::RunResult& result);
scenario::json::Node signals_node(const results::RunResult& result);
/// Both; empty if there are none.
std::string applications_part(const results::RunResult& result);

}  // namespace takt::output
