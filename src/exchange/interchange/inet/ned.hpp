// SPDX-License-Identifier: Apache-2.0
// NED files: types of networks, modules and channels as they are written. What a network of them is: ned_network.hpp.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "interchange/import.hpp"

namespace takt::interchange::inet {

/// "*.eth[*].bitrate = default(100Mbps)": a pattern below what it stands in.
struct NedAssignment {
  std::string pattern;
  std::string expression;
  bool is_default = false;  ///< an ini file comes before it
  json::Place place;
};

struct NedSubmodule {
  std::string name;
  std::string size;        ///< of an array, an expression; empty: one
  std::string type;        ///< its last part; of "<...> like ..." empty
  std::string chosen;      ///< the expression between < and >
  bool is_chosen = false;  ///< <...> like INTERFACE
  std::string condition;
  std::vector<NedAssignment> parameters;
  json::Place place;
};

struct NedEnd {
  std::string node;
  std::string index;        ///< of an array of nodes, an expression
  std::string gate;         ///< of the interface, an expression; empty: the next ("++")
  bool is_ethernet = true;  ///< a gate called ethg
};

struct NedConnection {
  NedEnd a, b;
  std::string channel;  ///< its last part; empty: none
  std::vector<NedAssignment> parameters;
  /// Loops and conditions around it, from the outermost: "for NAME = FROM .. TO", or a condition with an empty name.
  struct Bracket {
    std::string name, from, to;
  };
  std::vector<Bracket> brackets;
  json::Place place;
};

struct NedType {
  enum class Kind : std::uint8_t { network, module, channel };
  Kind kind = Kind::network;
  std::string name, package;
  std::string base;  ///< the last part of what it extends; empty: nothing
  std::vector<NedAssignment> parameters;
  std::vector<NedSubmodule> submodules;
  std::vector<NedConnection> connections;
  json::Place place;
};

/// The types of a file, those within other types too. What is no NED is a diagnostic with its line.
std::vector<NedType> read_ned(const InputFile& file, json::Diagnostics& diagnostics);

}  // namespace takt::interchange::inet
