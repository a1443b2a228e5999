// A run of a group with roles as a chart.
#pragma once

#include "explore/chart.hpp"

namespace takt::explore {

/// Goes through the run once more with its model.
Chart chart_of_roles(const Question& question, const Beginning& beginning, const Trace& trace);

}  // namespace takt::explore
