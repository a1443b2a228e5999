// SPDX-License-Identifier: Apache-2.0
#include "node/server/served_keys.hpp"

#include <time.h>

#include <algorithm>

namespace takt::node {

opcua::Answer<opcua::SecurityKeys> ServedKeys::keys(const opcua::SecurityKeysRequest& request, std::string_view user) {
  const auto group = std::find_if(groups_.begin(), groups_.end(),
                                  [&](const LoadedGroup& each) { return request.group == each.keys.group; });
  if (group == groups_.end()) return opcua::StatusCode::BadNotFound;
  if (!group->users.empty() && std::find(group->users.begin(), group->users.end(), user) == group->users.end())
    return opcua::StatusCode::BadUserAccessDenied;

  const security::KeySchedule schedule = group->keys.schedule(group->lifetime);
  const std::int64_t now_ns = now_ns_();
  if (now_ns < schedule.first_ns)
    return opcua::StatusCode::BadResourceUnavailable;  // the time of its first key has not come
  const std::uint64_t current = schedule.changes_until(now_ns);
  const std::uint64_t oldest = current > 0 ? current - 1 : 0;
  const std::uint64_t last = current + future_keys_;
  std::uint64_t first = current;
  if (request.starting_token != 0) {
    first = oldest;
    for (std::uint64_t changes = oldest; changes <= last; ++changes)
      if (schedule.token_after(changes) == request.starting_token) first = changes;
  }
  opcua::SecurityKeys made;
  made.policy_uri = opcua::Text(security::uri_of(group->keys.policy));
  made.first_token = schedule.token_after(first);
  made.lifetime_ms = static_cast<double>(schedule.lifetime_ns) / 1e6;
  made.time_to_next_ms =
      static_cast<double>(schedule.lifetime_ns - (now_ns - schedule.first_ns) % schedule.lifetime_ns) / 1e6;
  for (std::uint64_t changes = first; changes <= std::min(last, first + request.count); ++changes) {
    auto key = group->keys.source->key(schedule.token_after(changes));
    if (!key) break;  // the file has no more
    made.keys.push_back(std::move(*key));
  }
  if (made.keys.empty()) return opcua::StatusCode::BadResourceUnavailable;
  return made;
}

std::int64_t key_time_ns(ClockName clock) {
  timespec time = {};
  ::clock_gettime(clock == ClockName::tai ? CLOCK_TAI : CLOCK_REALTIME, &time);
  return static_cast<std::int64_t>(time.tv_sec) * 1'000'000'000 + time.tv_nsec;
}

}  // namespace takt::node
