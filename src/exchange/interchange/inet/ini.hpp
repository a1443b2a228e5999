// SPDX-License-Identifier: Apache-2.0
// Configuration files of OMNeT++: sections, keys with wildcards of which the first that matches counts, values.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "interchange/import.hpp"
#include "json/node.hpp"

namespace takt::interchange::inet {

struct IniLine {
  std::string key, value;
  json::Place place;  ///< of the key
  bool is_used = false;
  bool is_of_ned = false;  ///< set by a NED file, for whoever looks: no mistake if nothing does
};

class Ini {
 public:
  /// Reads [General], or another section and what it extends. Of iterations (${N=1,2,4}) the values of a run count,
  /// which are numbered as OMNeT++ does it.
  void read(const InputFile& file, const std::string& section, std::uint64_t run, std::vector<Remark>& remarks,
            json::Diagnostics& diagnostics);
  /// The first line whose key matches the full path of a parameter ("Net.host.app[0].typename"), or nothing. It counts
  /// as understood.
  const IniLine* find(const std::string& path);
  /// A line of the whole configuration, such as network.
  const IniLine* find_global(const std::string& key);
  std::vector<IniLine>& lines() { return lines_; }

 private:
  std::vector<IniLine> lines_;
};

/// Whether a key with *, **, ?, [1..3] and {a-f} matches a path.
bool matches(std::string_view pattern, std::string_view path);

/// A value of OMNeT++ as a tree: objects, lists, texts; words, numbers with units and expressions are texts of kind
/// number. Null if it is none.
std::optional<json::Node> parse_value(std::string_view text);

}  // namespace takt::interchange::inet
