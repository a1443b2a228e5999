#include "explore/engine.hpp"
#include "explore/group_model.hpp"

namespace takt::explore {

template Answer search<GroupModel>(const Question& question, const Watcher& watcher);

}  // namespace takt::explore
