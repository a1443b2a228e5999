#include "explore/model/tree_model.hpp"
#include "explore/search/engine.hpp"

namespace takt::explore {

template Answer search<TreeModel>(const Question& question, const Watcher& watcher);

}  // namespace takt::explore
