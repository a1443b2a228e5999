// Shell scripts as command sets: one command after the other, without anything that a shell would work out.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "interchange/linux/device.hpp"

namespace takt::interchange::linux_tc {

struct Word {
  std::string text;
  json::Place place;
};
using Command = std::vector<Word>;

/// The commands of a script; comments and blank lines left out, lines joined at a backslash. What only a shell could say (variables, pipes, several
/// commands in a line) is a diagnostic.
std::vector<Command> commands_of(std::string_view text, const std::string& file, json::Diagnostics& diagnostics);

/// Reads tc, ethtool --set-mm, bridge and ip commands into what they set.
void read_script(std::string_view text, const std::string& file, Machine& machine, json::Diagnostics& diagnostics);

/// Reads one JSON text of `tc -j qdisc show`, `ip -j link show` or `bridge -j vlan show` into the same.
void read_dump(std::string_view text, const std::string& file, Machine& machine, json::Diagnostics& diagnostics);

}  // namespace takt::interchange::linux_tc
