// SPDX-License-Identifier: Apache-2.0
// Scenarios that must behave as another one does: with other names, in another order, with a switch that nobody uses,
// in other units, or ten times as slow throughout.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "scenario/resolved/resolved.hpp"

namespace takt::property {

struct Twin {
  std::string text;
  std::map<std::string, std::string> name_of;  ///< of streams that are called otherwise: by the old name
  std::int64_t factor = 1;                     ///< of all times
};

/// Each takes the text of a scenario; an empty text: it has something that this cannot change.
Twin with_other_keys(const std::string& text,
                     std::uint64_t seed);          ///< members of all objects in another order, but for nodes
Twin with_other_units(const std::string& text);    ///< "1us" as "1000ns"
Twin with_unused_switch(const std::string& text);  ///< last in the file, at the first switch
Twin with_other_names(const std::string& text);    ///< of nodes and streams
Twin with_other_streams(const std::string& text, std::uint64_t seed);  ///< in another order
Twin with_other_nodes(const std::string& text, std::uint64_t seed);
Twin with_other_links(const std::string& text, std::uint64_t seed);  ///< and their ends
Twin ten_times_slower(const std::string& text);                      ///< all times times ten, all rates a tenth

/// Nodes and links that a stream passes, in words that rest on no order in the file. Of several links between two nodes
/// the first in the file is taken: a twin with other links may use another one, and is another scenario then.
std::vector<std::string> passed_by(const scenario::Resolved& resolved, const scenario::ResolvedStream& stream);

/// Every stream that gives no offset, or a rough one, gets one to the picosecond, so that no two frames meet at one
/// instant: which of them goes first rests on the order of the ports. What is left to chance becomes periodic, since
/// chance rests on names.
std::string without_ties_and_chance(const std::string& text, std::uint64_t seed);

}  // namespace takt::property
