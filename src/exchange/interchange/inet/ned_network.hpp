// SPDX-License-Identifier: Apache-2.0
// A network of NED types written out: arrays, loops, conditions, inheritance and chosen types are worked out.
#pragma once

#include "interchange/inet/ini.hpp"
#include "interchange/inet/ned.hpp"

namespace takt::interchange::inet {

struct Submodule {
  std::string name, type;  ///< "dev[2]", "TsnDevice": the type of INET that it is
  json::Place place;
};
struct Connection {
  std::string a, b;                    ///< submodules
  std::uint32_t a_eth = 0, b_eth = 0;  ///< index of the interface
  std::string channel;                 ///< the type of INET that it is
  std::optional<std::string> datarate, length, delay;
  json::Place place;
};
struct Network {
  std::string name;
  std::vector<Submodule> submodules;
  std::vector<Connection> connections;
  json::Place place;
};

/// The network of a name, from the types of all files. What the NED files set is put into `ini`: behind its lines where
/// it is a default, before them otherwise.
std::optional<Network> network_of(const std::vector<NedType>& types, const std::string& name, Ini& ini,
                                  json::Diagnostics& diagnostics);

}  // namespace takt::interchange::inet
