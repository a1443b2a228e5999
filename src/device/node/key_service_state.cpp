// SPDX-License-Identifier: Apache-2.0
#include "node/key_service_state.hpp"

#include <algorithm>

#include "json/record.hpp"

namespace takt::node {

KeyServiceStatus status_of(const KeyServiceState& state, std::int64_t now_ns) {
  KeyServiceStatus status{state.endpoint, state.answered_by, std::nullopt, 0, 0, 0, state.pulls,
                          state.wished,   state.failures,    state.problem};
  if (state.answered_by) status.silent_ns = std::max<std::int64_t>(now_ns - state.answered_ns, 0);
  const std::uint64_t changes = state.schedule.changes_until(now_ns);
  if (changes >= state.keys) return status;
  status.token = state.schedule.token_after(changes);
  status.keys = state.keys - changes;
  status.ends_in_ns =
      state.schedule.first_ns + static_cast<std::int64_t>(state.keys) * state.schedule.lifetime_ns - now_ns;
  return status;
}

const json::Record& describe(json::Type<KeyServiceStatus>) {
  static constexpr json::Output outputs[] = {
      json::output<&KeyServiceStatus::service>("service", "Its endpoint."),
      json::output<&KeyServiceStatus::answered_by>("answered_by",
                                                   "Address and port of who gave keys last; null: nobody yet."),
      json::output<&KeyServiceStatus::silent_ns>("silent_ns", "Since it gave keys last; null: it has not yet.",
                                                 {.unit = "ns"}),
      json::output<&KeyServiceStatus::token>(
          "token", "The SecurityTokenId that is current by what it said; 0: none of its keys is."),
      json::output<&KeyServiceStatus::keys>("keys", "How many keys are in hand: the current one and those behind it."),
      json::output<&KeyServiceStatus::ends_in_ns>("ends_in_ns", "How long they last; 0: they have ended.",
                                                  {.unit = "ns"}),
      json::output<&KeyServiceStatus::pulls>("pulls", "How often it was asked."),
      json::output<&KeyServiceStatus::wished>(
          "wished", "Of these: at once, because a message spoke of keys that were not there."),
      json::output<&KeyServiceStatus::failures>("failures", "Of these: it gave none."),
      json::output<&KeyServiceStatus::problem>("problem",
                                               "Why it gave none when it was asked last; null: it gave some."),
  };
  static constexpr json::Record record{"key_service_status",
                                       "The key service that the keys are pulled from, as this node sees it.", outputs};
  return record;
}

}  // namespace takt::node
