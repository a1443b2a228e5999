// SPDX-License-Identifier: Apache-2.0
#include "explore/search/search.hpp"

#include <algorithm>

namespace takt::explore {

class GroupModel;
class PartsModel;
class RolesModel;
class TreeModel;

bool SearchResult::all_hold() const {
  return std::all_of(verdicts.begin(), verdicts.end(), [](PropertyVerdict each) {
    return each == PropertyVerdict::holds || each == PropertyVerdict::reached || each == PropertyVerdict::not_asked;
  });
}

bool SearchResult::any_violated() const {
  return std::any_of(verdicts.begin(), verdicts.end(),
                     [](PropertyVerdict each) { return each == PropertyVerdict::violated; });
}

SearchResult explore(const Query& query, const Watcher& watcher) {
  if (query.has_roles()) return search<RolesModel>(query, watcher);
  if (query.is_tree()) return search<TreeModel>(query, watcher);
  return query.has_parts() ? search<PartsModel>(query, watcher) : search<GroupModel>(query, watcher);
}

}  // namespace takt::explore
