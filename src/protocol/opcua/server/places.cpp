// SPDX-License-Identifier: Apache-2.0
#include "opcua/server/places.hpp"

#include <map>
#include <tuple>

namespace takt::opcua {

std::optional<std::size_t> place_to_give(const std::vector<Place>& places, const Newcomer& newcomer) {
  std::map<std::string_view, std::size_t> of_account;
  for (const Place& each : places) ++of_account[each.account];
  const auto own = of_account.find(newcomer.account);
  const std::size_t of_newcomer = own == of_account.end() ? 0 : own->second;
  const auto order = [&](const Place& each) {
    return std::tuple(!each.is_left, each.rank, -static_cast<std::ptrdiff_t>(of_account[each.account]), each.progress,
                      each.since);
  };
  std::optional<std::size_t> given;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Place& each = places[i];
    const bool has_more = each.rank == newcomer.rank && of_account[each.account] >= of_newcomer + 2;
    if (!each.is_left && each.rank >= newcomer.rank && !has_more) continue;
    if (!given || order(each) < order(places[*given])) given = i;
  }
  return given;
}

}  // namespace takt::opcua
