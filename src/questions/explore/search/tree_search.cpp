// SPDX-License-Identifier: Apache-2.0
#include "explore/model/tree_model.hpp"
#include "explore/search/engine.hpp"

namespace takt::explore {

template SearchResult search<TreeModel>(const Query& query, const Watcher& watcher);

}  // namespace takt::explore
