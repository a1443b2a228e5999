// SPDX-License-Identifier: Apache-2.0
#include "profile/profile.hpp"

#include <algorithm>

#include "profile/rules.hpp"

namespace takt::profile {

std::string_view name_of(Verdict verdict) {
  constexpr std::string_view names[] = {"met", "missed", "unknown"};
  return names[static_cast<std::size_t>(verdict)];
}

std::span<const Profile> profiles() {
  static const Profile all[] = {
      {"60802", "IEC/IEEE 60802, TSN profile for industrial automation", rules_of_60802()},
      {"uafx", "OPC UA FX, networking (OPC 10000-82)", rules_of_uafx()},
      {"802.1BA", "IEEE 802.1BA, audio video bridging", rules_of_avb()},
  };
  return all;
}

const Profile* find_profile(std::string_view name) {
  const auto found = std::ranges::find(profiles(), name, &Profile::name);
  return found == profiles().end() ? nullptr : &*found;
}

Report judge(const Profile& profile, const scenario::Resolved& resolved) {
  Report report{std::string(profile.name), std::string(profile.title), resolved.scenario.name, Verdict::met, {}};
  for (const Rule& rule : profile.rules) {
    Found found;
    rule.look(resolved, found);
    for (Found::Entry& entry : found.entries) {
      if (entry.verdict == Verdict::missed || report.verdict == Verdict::met)
        report.verdict = entry.verdict == Verdict::met ? report.verdict : entry.verdict;
      report.findings.push_back({std::string(rule.clause), std::string(rule.name), entry.verdict, std::move(entry.what),
                                 std::string(rule.expected), std::move(entry.pointer)});
    }
  }
  return report;
}

}  // namespace takt::profile
