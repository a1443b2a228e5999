// SPDX-License-Identifier: Apache-2.0
// What names a scenario knows, whether or not what they name was refused: a reference to something that is wrong
// elsewhere is no mistake of its own.
#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "scenario/resolved/resolved.hpp"

namespace takt::scenario {

/// The names of all streams: of those that are laid, and of those that would be but for mistakes.
class StreamNames {
 public:
  StreamNames(const Resolved& resolved, const json::Diagnostics& diagnostics);

  /// Whether a stream has that name, or may have it once what was refused is right.
  bool may_be(std::string_view name) const;
  std::vector<std::string_view> all() const { return {names_.begin(), names_.end()}; }

 private:
  void add_program(const Program& program);

  std::set<std::string, std::less<>> names_;
  std::set<std::string, std::less<>> owners_;  ///< whose streams nobody knows: "motion" of "motion/state/plc"
  bool has_all_streams_ = true;
  bool has_all_owners_ = true;
};

/// Whether a program, its name given, may be one that could not be read.
bool may_be_unread_program(const Scenario& scenario, const json::Diagnostics& diagnostics);

}  // namespace takt::scenario
