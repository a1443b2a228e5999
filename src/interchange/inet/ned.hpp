// NED files of the subset that describes networks: submodules and connections.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "interchange/import.hpp"

namespace takt::interchange::inet {

struct Submodule {
  std::string name, type;
  json::Place place;
};
struct Connection {
  std::string a, b;                        ///< submodules
  std::uint32_t a_eth = 0, b_eth = 0;      ///< index of the interface
  std::string channel;
  std::optional<std::string> datarate, length, delay;
  json::Place place;
};
struct Network {
  std::string name;
  std::string package;
  std::vector<Submodule> submodules;
  std::vector<Connection> connections;
  json::Place place;
};

/// The networks of a file. What is not of the subset is a diagnostic with its line.
std::vector<Network> read_ned(const InputFile& file, json::Diagnostics& diagnostics);

}  // namespace takt::interchange::inet
