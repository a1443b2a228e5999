#include "explore/search/search.hpp"

#include <algorithm>

namespace takt::explore {

class GroupModel;
class RolesModel;
class TreeModel;

bool Answer::all_hold() const {
  return std::all_of(verdicts.begin(), verdicts.end(), [](Verdict each) { return each == Verdict::holds || each == Verdict::reached || each == Verdict::not_asked; });
}

bool Answer::any_violated() const {
  return std::any_of(verdicts.begin(), verdicts.end(), [](Verdict each) { return each == Verdict::violated; });
}

Answer explore(const Question& question, const Watcher& watcher) {
  if (question.has_roles()) return search<RolesModel>(question, watcher);
  return question.is_tree() ? search<TreeModel>(question, watcher) : search<GroupModel>(question, watcher);
}

}  // namespace takt::explore
