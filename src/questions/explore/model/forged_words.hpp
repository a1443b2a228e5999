// SPDX-License-Identifier: Apache-2.0
// What a forged word changes in what is judged, in every model that knows them.
#pragma once

#include "explore/model/action.hpp"
#include "explore/model/model.hpp"

namespace takt::explore {

/// Whoever has believed a stranger may break S1 to S5, until all are Halted and know it. From then on the group is as
/// it was: it keeps them, and a Start succeeds. Not inline: where nobody forges, which is mostly, each action would pay
/// for it.
template <class M>
[[gnu::noinline]] void judge_forgery(M& model, const State& state, Action action, Next& next) {
  if (action.kind == ActionKind::forge) next.state.set_misled(true);
  if (next.state.misled()) {
    for (const Property property : {Property::S1, Property::S2, Property::S3, Property::S4, Property::S5})
      next.properties.erase(property);
    if (model.halted_for_all(next.state)) next.state.set_misled(false);
  }
  if (is_network(action.kind)) return;
  const bool is_start = action.kind == ActionKind::call && action.who == 0 &&
                        program::methods[action.what].method == program::Method::Start;
  next.state.set_promised(is_start && model.halted_for_all(state));
}

}  // namespace takt::explore
