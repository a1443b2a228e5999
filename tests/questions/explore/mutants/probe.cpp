// SPDX-License-Identifier: Apache-2.0
// Asks the handshake that it is linked with a list of short questions until one of them finds something wrong.
//
//   explore_probe    prints "killed PROPERTY QUESTION" or "survived", and returns 0
#include <cstdio>
#include <vector>

#include "explore/report/report.hpp"
#include "explore/search/search.hpp"

namespace takt::explore {
namespace {

struct Case {
  std::uint8_t slaves;
  std::uint32_t commands;
  std::uint32_t faults;  ///< of every class
  Network network = Network::registers;
  handshake::Subscription subscription = handshake::Subscription::star;
  std::uint8_t inner_slaves = 0;
  bool forges = false;  ///< the only fault is a forged word
  std::uint8_t candidates = 0;
  std::uint8_t first_offers = 0xFF;  ///< the roles that the first of them can have
  bool replays = false;              ///< the faults are replays of signed words, and restarts
};

/// From short to long; together a few seconds for a handshake that is right.
const std::vector<Case>& cases() {
  static const std::vector<Case> all{
      {1, 3, 0},
      {2, 2, 0},
      {1, 2, 1},
      {2, 1, 1},
      {2, 1, 0, Network::registers, handshake::Subscription::all_to_all},
      {1, 1, 1, Network::channels},
      {1, 2, 0, Network::registers, handshake::Subscription::star, 1},
      {1, 1, 1, Network::registers, handshake::Subscription::star, 1},
      {1, 1, 1, Network::registers, handshake::Subscription::star, 0, true},
      {1, 1, 0, Network::registers, handshake::Subscription::star, 0, false, 2},
      {2, 1, 0, Network::registers, handshake::Subscription::star, 0, false, 2, 2},
      {1, 1, 1, Network::registers, handshake::Subscription::star, 0, false, 1},
      {1, 1, 2, Network::registers, handshake::Subscription::star, 0, false, 0, 0xFF, true}};
  return all;
}

Query question_of(const Case& each) {
  Query query;
  query.slaves = each.slaves;
  query.commands = each.commands;
  query.fault_budget = each.faults;
  query.network = each.network;
  query.subscription = each.subscription;
  query.inner_slaves = each.inner_slaves;
  query.candidates = each.candidates;
  query.offers[0] = each.first_offers;
  query.states = 20'000'000;
  if (each.faults == 0) return query;
  if (each.replays) {
    query.is_signed = true;
    query.key_changes = 1;
    query.faults.insert(Fault::replay);
    query.faults.insert(Fault::restart);
    return query;
  }
  if (each.forges) query.faults.insert(Fault::forge);
  for (std::size_t f = 0; f < fault_count; ++f) {
    const auto fault = static_cast<Fault>(f);
    if (each.forges || fault == Fault::forge || fault == Fault::replay) continue;
    if ((!query.is_tree() && !query.has_roles()) || (fault != Fault::duplicate && fault != Fault::reorder))
      query.faults.insert(fault);
  }
  return query;
}

int probe() {
  for (const Case& each : cases()) {
    const Query query = question_of(each);
    std::printf("%s\n", query_line(query).c_str());
    std::fflush(stdout);  // a mutant may break a CHECK
    const SearchResult result = explore(query, [](const Progress&) { return true; });
    for (std::size_t p = 0; p < property_count; ++p) {
      if (result.verdicts[p] != PropertyVerdict::violated && result.verdicts[p] != PropertyVerdict::unreached) continue;
      // The page with the chart first, for the last two lines are what the caller looks for.
      if (query.is_tree()) std::printf("%s\n%s\n", text_report(query, result, 0.0).c_str(), query_line(query).c_str());
      std::printf("killed %.*s\n", static_cast<int>(property_names[p].size()), property_names[p].data());
      return 0;
    }
  }
  std::puts("survived");
  return 0;
}

}  // namespace
}  // namespace takt::explore

int main() { return takt::explore::probe(); }
