#include "explore/engine.hpp"
#include "explore/roles_model.hpp"

namespace takt::explore {

template Answer search<RolesModel>(const Question& question, const Watcher& watcher);

}  // namespace takt::explore
