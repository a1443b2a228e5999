// SPDX-License-Identifier: Apache-2.0
#include "explore/parts/parts_model.hpp"
#include "explore/search/engine.hpp"

namespace takt::explore {

template SearchResult search<PartsModel>(const Query& query, const Watcher& watcher);

}  // namespace takt::explore
