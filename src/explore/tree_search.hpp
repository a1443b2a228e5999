// Breadth-first search over a tree of groups (tree_model.hpp), with the same verdicts as search.hpp. No symmetry.
#pragma once

#include "explore/search.hpp"

namespace takt::explore {

/// What explore() does for a Question that is_tree().
Answer explore_tree(const Question& question, const Watcher& watcher);

}  // namespace takt::explore
