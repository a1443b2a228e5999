#include "explore/model/group_model.hpp"
#include "explore/search/engine.hpp"

namespace takt::explore {

template Answer search<GroupModel>(const Question& question, const Watcher& watcher);

}  // namespace takt::explore
