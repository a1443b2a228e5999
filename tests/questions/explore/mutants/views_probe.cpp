// SPDX-License-Identifier: Apache-2.0
// Asks the handshake that it is linked with short questions about one to three slaves. What is found there must be
// refuted for every number of slaves, too.
//
//   explore_views_probe    prints "killed PROPERTY" if a run was found and the proof fails, "killed proved" if it does
//   not fail, or "survived"
#include <cstdio>
#include <vector>

#include "explore/parts/views.hpp"
#include "explore/report/report.hpp"
#include "explore/search/search.hpp"

namespace takt::explore {
namespace {

struct Case {
  std::uint8_t slaves;
  std::uint32_t commands;
  std::vector<Fault> faults;
};

Query question_of(const Case& each) {
  Query query;
  query.slaves = each.slaves;
  query.commands = each.commands;
  query.fault_budget = each.faults.empty() ? 0 : 1;
  for (const Fault fault : each.faults) query.faults.insert(fault);
  query.states = 20'000'000;
  return query;
}

int probe() {
  const std::vector<Fault> all{Fault::loss,  Fault::duplicate, Fault::reorder,
                               Fault::crash, Fault::restart,   Fault::timeout};
  const Case cases[] = {{1, 2, {}}, {2, 1, {}}, {1, 1, all}, {2, 1, all}, {3, 1, {Fault::crash}}};
  for (const Case& each : cases) {
    Query query = question_of(each);
    std::printf("%s\n", query_line(query).c_str());
    std::fflush(stdout);  // a mutant may break a CHECK
    const SearchResult result = explore(query, [](const Progress&) { return true; });
    for (std::size_t p = 0; p < property_count; ++p) {
      if (result.verdicts[p] != PropertyVerdict::violated) continue;
      const AnyNumber proof = prove_for_any_number(query, [](const Progress&) { return true; });
      if (proof.is_proved() || proof.verdicts[p] == PropertyVerdict::holds)
        std::puts("killed proved");
      else
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
