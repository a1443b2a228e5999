// SPDX-License-Identifier: Apache-2.0
#include "explore/model/group_model.hpp"
#include "explore/search/engine.hpp"

namespace takt::explore {

template SearchResult search<GroupModel>(const Query& query, const Watcher& watcher);

}  // namespace takt::explore
