// SPDX-License-Identifier: Apache-2.0
// From what devices are set to, read port by port, to a scenario: into a given network, or with a host at each port.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "interchange/import.hpp"
#include "scenario/topology/topology.hpp"

namespace takt::scenario {
struct Resolved;
}

namespace takt::interchange {

/// What a port is set to.
struct ImportedPort {
  std::string interface;
  json::Place place;
  scenario::Egress egress;  ///< without "to"
  std::optional<scenario::TrafficClasses> classes = {};
  std::optional<sim::DataRate> rate = {};
};

struct ImportedDevice {
  std::string name;
  json::Place place;
  bool forwards = false;
  std::vector<ImportedPort> ports;
  std::optional<scenario::Ingress> ingress = {};
  std::optional<scenario::GptpNode> gptp = {};
  bool gptp_by_roles = false;  ///< "roles" are said (of interfaces, not neighbours)
  bool gptp_by_data_sets =
      false;  ///< those of IEEE 802.1AS: "roles" are said (of interfaces, not neighbours), servos are not
  std::vector<scenario::GptpDomain> gptp_domains = {};  ///< further domains, each with this device alone
  std::optional<scenario::Gptp> gptp_of_all = {};       ///< intervals and the like, which takt has once for all nodes
  std::optional<scenario::Clock> clock = {};
};

/// Which node or stream an address means, from the table that an export writes ("takt.names.json").
class Names {
 public:
  /// Reads such a table.
  void read(const InputFile& file, json::Diagnostics& diagnostics);
  std::optional<std::string> stream(const std::string& address) const;
  std::optional<std::string> node(const std::string& address) const;
  const InterfaceNames& interfaces() const { return interfaces_; }

 private:
  std::map<std::string, std::string> streams_, nodes_;
  InterfaceNames interfaces_;
};

/// The table of a scenario; `interfaces` are those that are called otherwise than by their numbers.
std::string names_table(const scenario::Resolved& resolved, const InterfaceNames& interfaces = {});
/// The table beside a scenario that an import made: that of interfaces alone.
std::string interfaces_table(const InterfaceNames& interfaces);
/// "plant.json": "plant.names.json".
std::string names_file_of(const std::string& scenario_file);
inline constexpr std::string_view names_file = "takt.names.json";
bool is_names_file(const InputFile& file);

/// The identity of frames to an address ("03:00:5e:00:00:04") in a VLAN (0: any): by a name of the table, else by a
/// mask.
scenario::IdentifiedStream identity_of(const std::string& name, const std::string& address, std::uint16_t vlan,
                                       scenario::TaggedFrames tagged, const Names& names, const json::Place& place,
                                       Imported& imported);

/// The same network without generators: every node and link written out, each with its ports.
scenario::NetworkSection written_out(const scenario::Topology& topology);

/// Puts the devices into the base of the request, or makes a network of them. Nothing if there are mistakes.
void build_scenario(std::vector<ImportedDevice> devices, const ImportRequest& request, const Names& names,
                    Imported& imported, json::Diagnostics& diagnostics);

}  // namespace takt::interchange
