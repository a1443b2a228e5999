#include "explore/engine.hpp"
#include "explore/tree_model.hpp"

namespace takt::explore {

template Answer search<TreeModel>(const Question& question, const Watcher& watcher);

}  // namespace takt::explore
