// SPDX-License-Identifier: Apache-2.0
// Runs a scenario on real nodes on this machine, and compares it with its simulated run.
#pragma once

#include <string>
#include <vector>

#include "emulate/application_comparison.hpp"
#include "emulate/comparison.hpp"
#include "emulate/invariant_check.hpp"
#include "emulate/plan.hpp"
#include "json/type.hpp"

namespace takt::emulate {

/// Which nodes had a role, one after the other; "" is nobody.
struct RoleResult {
  std::string name;
  std::vector<std::string> simulated;
  std::vector<std::string> emulated;
};

struct ProgramResult {
  std::string name;
  Comparison comparison;
  std::vector<RoleResult> roles{};
  bool is_same() const;
};

struct NodeResult {
  std::string name;    ///< participant
  std::string status;  ///< the node's last status as JSON; "" if it was killed
};

struct Result {
  std::vector<ProgramResult> programs;
  std::vector<ApplicationComparison> applications;
  InvariantCheck invariants;  ///< of the real nodes
  std::vector<NodeResult> nodes;
  std::vector<std::string> notes;  ///< what was left out, calls that were not Good
  bool interrupted = false;
  bool is_same() const;
};

struct Settings {
  /// So long nodes are waited for that are not where the simulated run was; a script that is late stays the same
  /// script.
  std::int64_t patience_ns = 10'000'000'000;
  std::string keep;  ///< folder for the nodes' files and logs; "": they are removed
  bool (*stop_requested)(const void* context) = nullptr;
  const void* context = nullptr;
};

/// False, and `problem` says why, if the machine does not permit it or a node failed. Nothing is left on the machine in
/// any case.
bool emulate(const scenario::Resolved& resolved, const Plan& plan, const Settings& settings, Result& result,
             std::string& problem);

/// What `takt emulate` writes.
struct Report {
  std::string scenario;
  const Result& result;
};
const json::Record& describe(json::Type<Report>);

/// For people, and for machines.
std::string to_text(const Result& result, const std::string& scenario);
std::string to_json(const Report& report);

}  // namespace takt::emulate
