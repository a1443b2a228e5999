// A run of a tree as a message-sequence chart in text, in the manner of chart.hpp.
#pragma once

#include <string>

#include "explore/search.hpp"

namespace takt::explore {

std::string tree_chart(const Question& question, const Beginning& beginning, const Trace& trace);

}  // namespace takt::explore
