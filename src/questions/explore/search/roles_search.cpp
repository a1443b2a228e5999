// SPDX-License-Identifier: Apache-2.0
#include "explore/model/roles_model.hpp"
#include "explore/search/engine.hpp"

namespace takt::explore {

template SearchResult search<RolesModel>(const Query& query, const Watcher& watcher);

}  // namespace takt::explore
