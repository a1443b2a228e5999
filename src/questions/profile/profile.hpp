// SPDX-License-Identifier: Apache-2.0
// Profiles of standards, and whether a scenario is as they want it.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "json/record.hpp"
#include "scenario/resolved/resolved.hpp"

namespace takt::profile {

enum class Verdict : std::uint8_t {
  met,
  missed,
  unknown,  ///< the scenario does not say it
};
std::string_view name_of(Verdict verdict);

/// One thing that a rule looked at.
struct Finding {
  std::string clause;  ///< "IEEE 802.1AS 10.7.2.3"
  std::string rule;    ///< "Sync interval"
  Verdict verdict = Verdict::met;
  std::string found;
  std::string expected;
  std::string pointer;  ///< in the scenario; "" of what the whole says
};

struct Report {
  std::string profile;  ///< "60802"
  std::string title;
  std::string scenario;
  Verdict verdict = Verdict::met;  ///< missed before unknown before met
  std::vector<Finding> findings;   ///< in the order of the rules
};

/// What a rule reports to.
class Found {
 public:
  void met(std::string what, const json::Place& place = {}) { add(Verdict::met, std::move(what), place); }
  void missed(std::string what, const json::Place& place = {}) { add(Verdict::missed, std::move(what), place); }
  void unknown(std::string what, const json::Place& place = {}) { add(Verdict::unknown, std::move(what), place); }
  /// Missed if `is_met` is false.
  void judge(bool is_met, std::string what, const json::Place& place = {}) {
    add(is_met ? Verdict::met : Verdict::missed, std::move(what), place);
  }

  struct Entry {
    Verdict verdict;
    std::string what;
    std::string pointer;
  };
  std::vector<Entry> entries;

 private:
  void add(Verdict verdict, std::string what, const json::Place& place) {
    entries.push_back({verdict, std::move(what), place.pointer});
  }
};

/// A line of a profile's table.
struct Rule {
  std::string_view clause;
  std::string_view name;
  std::string_view expected;
  void (*look)(const scenario::Resolved& resolved, Found& found);
};

struct Profile {
  std::string_view name;
  std::string_view title;
  std::span<const Rule> rules;
};

/// All of them, by the names of `takt check --profile`.
std::span<const Profile> profiles();
/// Null if there is none of that name.
const Profile* find_profile(std::string_view name);

/// Every rule, with at least one finding each.
Report judge(const Profile& profile, const scenario::Resolved& resolved);

const json::Record& describe(json::Type<Finding>);
const json::Record& describe(json::Type<Report>);
/// A line for each finding, for people.
std::string text_of(const Report& report);

}  // namespace takt::profile
