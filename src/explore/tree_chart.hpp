// A run of a tree as a chart.
#pragma once

#include "explore/chart.hpp"

namespace takt::explore {

/// Goes through the run once more with the tree's model.
Chart chart_of_tree(const Question& question, const Beginning& beginning, const Trace& trace);

}  // namespace takt::explore
