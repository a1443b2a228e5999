// SPDX-License-Identifier: Apache-2.0
// Scripts, traces and batches as command sets: one command after the other, with all that a shell works out done.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "interchange/linux/device.hpp"

namespace takt::interchange::linux_tc {

struct Word {
  std::string text;
  json::Place place;
  std::string unknown = {};  ///< as it is written, if a part of it only a run can say
};
using Command = std::vector<Word>;

/// The commands of a script, in the order in which they are given: variables, functions, loops over lists and
/// arithmetic are worked out. What only a run can say (a condition, the output of a program) is a diagnostic where
/// something depends on it.
std::vector<Command> commands_of(std::string_view text, const std::string& file, std::vector<Remark>& remarks,
                                 json::Diagnostics& diagnostics);

/// Reads tc, ethtool, bridge and ip commands into what they set. What sets nothing that takt has is remarked in the
/// machine.
void read_script(std::string_view text, const std::string& file, Machine& machine, json::Diagnostics& diagnostics);

/// Reads one JSON text of `tc -j qdisc show`, `ip -j link show` or `bridge -j vlan show` into the same.
void read_dump(std::string_view text, const std::string& file, Machine& machine, json::Diagnostics& diagnostics);

}  // namespace takt::interchange::linux_tc
