// What `takt bound` prints.
#pragma once

#include <string>

#include "analysis/bounds.hpp"

namespace takt::analysis {

std::string text_report(const scenario::Resolved& resolved, const Bounds& bounds);
/// {"scenario", "streams": [{name, bound_ps, hops: [{port, delay_ps, backlog_bits}], ...}], "reactions": [{program, kind, bound_ps, parts}], ...}
std::string json_report(const scenario::Resolved& resolved, const Bounds& bounds);

}  // namespace takt::analysis
