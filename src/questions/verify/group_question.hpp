// SPDX-License-Identifier: Apache-2.0
// What an exploration is asked: the group of some options, or each Program of a scenario.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "explore/model/query.hpp"

namespace takt::scenario {
struct Resolved;
}

namespace takt::verify {

/// As on the command line of takt explore; what is not said has its default, or is that of the scenario.
struct GroupQuestion {
  std::optional<unsigned> slaves;
  std::optional<std::string> variant;  ///< "paper" or "robust"
  std::vector<std::string> faults;     ///< of explore::fault_names
  explore::Query query;                ///< fault_budget, depth, states, joining
  std::optional<std::uint32_t> calls;
  std::optional<std::string> subscription;  ///< "star" or "all-to-all"
  std::string network = "registers";
  std::string beginnings = "all";  ///< or "switched-on"
  bool no_symmetry = false;
  bool no_finish = false;
  bool nested = false;
  std::optional<unsigned> inner_slaves;
  std::optional<unsigned> candidates;
  bool starts_again = false;
  bool is_signed = false;
  std::optional<unsigned> key_changes;
  bool any_number = false;        ///< for every number of slaves at once
  bool writes_scenarios = false;  ///< a scenario for each violation is wanted
};

struct Group {
  std::string name;
  explore::Query query;
};

struct Groups {
  std::vector<Group> groups;       ///< none after a mistake
  std::vector<std::string> notes;  ///< what is explored otherwise than it stands in the scenario
  std::string mistake;
};

/// The group of the question, or with a scenario each of its Programs.
Groups groups_of(const GroupQuestion& question, const scenario::Resolved* scenario);

/// Sets "registers", "channels" or "channels=N"; says what is wrong.
std::string set_network(const std::string& text, explore::Query& query);

}  // namespace takt::verify
