#include "explore/model/roles_model.hpp"
#include "explore/search/engine.hpp"

namespace takt::explore {

template Answer search<RolesModel>(const Question& question, const Watcher& watcher);

}  // namespace takt::explore
